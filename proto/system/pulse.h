// SPDX-License-Identifier: Apache-2.0
// Signs of life: a counter in memory that a process shares with the one that started it. A process
// whose counter stands still hangs, whatever it is that it hangs in.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "proto/system/descriptor.h"

namespace corridor {

// The starter's side. Nothing of it is in any file system; it goes with the last process that has
// it.
class Pulse {
 public:
  // Throws Failure when the system has no memory for it.
  Pulse();

  // To be inherited by the process, whose environment says where: "CORRIDOR_PULSE=<descriptor>".
  int descriptor() const { return descriptor_.get(); }
  std::string environment() const;

  std::uint64_t beats() const;

 private:
  struct Unmap {
    void operator()(std::atomic<std::uint64_t>* beats) const;
  };
  Descriptor descriptor_;
  std::unique_ptr<std::atomic<std::uint64_t>, Unmap> beats_;
};

// The process's side. Takes what its environment says; without it, beats go nowhere.
void adopt_pulse();
// Costs an addition. Whatever waits or works for long calls it many times a second:
// stop_requested() and TimeAccount::charge() do.
void beat();

}  // namespace corridor
