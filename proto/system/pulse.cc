// SPDX-License-Identifier: Apache-2.0
#include "proto/system/pulse.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "proto/base/failure.h"
#include "proto/base/text.h"

namespace corridor {
namespace {

using Beats = std::atomic<std::uint64_t>;
static_assert(Beats::is_always_lock_free, "shared between processes");

constexpr const char* kVariable = "CORRIDOR_PULSE";

Beats unheard{0};
Beats* beats_of_this_process = &unheard;

Beats* map(int descriptor) {
  void* const memory =
      mmap(nullptr, sizeof(Beats), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  return memory == MAP_FAILED ? nullptr : static_cast<Beats*>(memory);
}

}  // namespace

Pulse::Pulse() : descriptor_(memfd_create("corridor-pulse", MFD_CLOEXEC)) {
  if (descriptor_.valid() && ftruncate(descriptor_.get(), sizeof(Beats)) == 0) {
    beats_.reset(map(descriptor_.get()));
  }
  if (!beats_) throw Failure("cannot share memory with another process: {}", std::strerror(errno));
}

void Pulse::Unmap::operator()(Beats* beats) const { munmap(beats, sizeof(Beats)); }

std::string Pulse::environment() const { return fmt::format("{}={}", kVariable, descriptor()); }

std::uint64_t Pulse::beats() const { return beats_->load(std::memory_order_relaxed); }

void adopt_pulse() {
  const char* const text = std::getenv(kVariable);
  if (text == nullptr) return;
  const Descriptor descriptor(parse_number<int>(text).value_or(-1));
  if (Beats* const beats = map(descriptor.get())) beats_of_this_process = beats;
  unsetenv(kVariable);
}

void beat() { beats_of_this_process->fetch_add(1, std::memory_order_relaxed); }

}  // namespace corridor
