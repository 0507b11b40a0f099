// SPDX-License-Identifier: Apache-2.0
// The processors that this process may use, and what another process has had of them.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>

#include "proto/system/clock.h"

namespace corridor {

// Cores that this process may use: by its affinity, and by the quota of its control groups, rounded
// up. At least 1.
int available_cores();

// The least quota of the control groups that `membership` (as /proc/self/cgroup) names, and of
// those around them, in cores; nothing when none is limited. `mounted`: where they lie. Versions 1
// and 2.
std::optional<double> quota_cores(const std::string& membership,
                                  const std::filesystem::path& mounted = "/sys/fs/cgroup");

// Of a process's main thread. All zero when there is no such process, or the system does not say.
struct ProcessorTime {
  TimePoint::duration had{0};
  TimePoint::duration waited{0};  // for a processor that others had; counted when it gets one
  bool runnable = false;          // has one or waits for one
};
ProcessorTime processor_time_of(pid_t pid);

// "OPENBLAS_CORETYPE=Haswell": what has OpenBLAS compute alike on every x86-64 processor with AVX2
// and FMA, where it would take the kernels that suit the processor, which round differently. To be
// in the environment when OpenBLAS is loaded. Nothing where the variable is set already, or this
// processor has none of these.
std::optional<std::string> portable_kernels();

}  // namespace corridor
