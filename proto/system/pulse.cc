#include "proto/system/pulse.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

#include "proto/base/failure.h"

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
  if (descriptor_ >= 0 && ftruncate(descriptor_, sizeof(Beats)) == 0) beats_ = map(descriptor_);
  if (beats_ == nullptr) {
    const int error = errno;
    if (descriptor_ >= 0) close(descriptor_);
    throw Failure("cannot share memory with another process: {}", std::strerror(error));
  }
}

Pulse::Pulse(Pulse&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      beats_(std::exchange(other.beats_, nullptr)) {}

Pulse::~Pulse() {
  if (beats_ != nullptr) munmap(beats_, sizeof(Beats));
  if (descriptor_ >= 0) close(descriptor_);
}

std::string Pulse::environment() const { return fmt::format("{}={}", kVariable, descriptor_); }

std::uint64_t Pulse::beats() const { return beats_->load(std::memory_order_relaxed); }

void adopt_pulse() {
  const char* const text = std::getenv(kVariable);
  if (text == nullptr) return;
  const std::string_view number = text;
  int descriptor = -1;
  std::from_chars(number.data(), number.data() + number.size(), descriptor);
  if (Beats* const beats = map(descriptor)) beats_of_this_process = beats;
  close(descriptor);
  unsetenv(kVariable);
}

void beat() { beats_of_this_process->fetch_add(1, std::memory_order_relaxed); }

}  // namespace corridor
