// Signs of life: a counter in memory that a process shares with the one that started it. A process
// whose counter stands still hangs, whatever it is that it hangs in.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

namespace corridor {

// The starter's side. Nothing of it is in any file system; it goes with the last process that has
// it.
class Pulse {
 public:
  // Throws Failure when the system has no memory for it.
  Pulse();
  ~Pulse();
  Pulse(Pulse&& other) noexcept;
  Pulse(const Pulse&) = delete;
  Pulse& operator=(const Pulse&) = delete;

  // To be inherited by the process, whose environment says where: "CORRIDOR_PULSE=<descriptor>".
  int descriptor() const { return descriptor_; }
  std::string environment() const;

  std::uint64_t beats() const;

 private:
  int descriptor_ = -1;
  std::atomic<std::uint64_t>* beats_ = nullptr;
};

// The process's side. Takes what its environment says; without it, beats go nowhere.
void adopt_pulse();
// Costs an addition. Whatever waits or works for long calls it many times a second:
// stop_requested() and TimeAccount::charge() do.
void beat();

}  // namespace corridor
