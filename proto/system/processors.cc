// SPDX-License-Identifier: Apache-2.0
#include "proto/system/processors.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "proto/base/format.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

// "" when it cannot be read.
std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

// "200000 100000" or "max 100000", as version 2 writes them.
std::optional<double> share(const std::string& quota_and_period) {
  std::istringstream in(quota_and_period);
  double quota = 0.0, period = 0.0;
  if (!(in >> quota >> period) || quota <= 0.0 || period <= 0.0) return std::nullopt;
  return quota / period;
}

std::optional<double> share_of(const fs::path& group, bool version_2) {
  return share(version_2 ? first_line(group / "cpu.max")
                         : first_line(group / "cpu.cfs_quota_us") + " " +
                               first_line(group / "cpu.cfs_period_us"));
}

}  // namespace

std::optional<double> quota_cores(const std::string& membership, const fs::path& mounted) {
  std::optional<double> least;
  std::istringstream lines(membership);
  for (std::string line; std::getline(lines, line);) {
    // "<number>:<controllers>:<path>", version 2 without controllers.
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const auto controllers =
        fmt::format(",{},", std::string_view(line).substr(first + 1, second - first - 1));
    const bool version_2 = controllers == ",,";
    if (!version_2 && controllers.find(",cpu,") == std::string::npos) continue;
    const fs::path root = version_2 ? mounted : mounted / "cpu";
    for (fs::path group = line.substr(second + 1);; group = group.parent_path()) {
      const auto cores = share_of(root / group.relative_path(), version_2);
      if (cores) least = std::min(*cores, least.value_or(*cores));
      if (!group.has_relative_path()) break;
    }
  }
  return least;
}

int available_cores() {
  cpu_set_t set;
  int cores = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
  std::ifstream in("/proc/self/cgroup");
  std::ostringstream membership;
  membership << in.rdbuf();
  if (const auto quota = quota_cores(membership.str())) {
    cores = std::min(cores, static_cast<int>(std::ceil(*quota)));
  }
  return std::max(cores, 1);
}

ProcessorTime processor_time_of(pid_t pid) {
  const fs::path process = fmt::format("/proc/{}", pid);
  ProcessorTime time;
  std::int64_t had_ns = 0, waited_ns = 0;
  if (std::istringstream(first_line(process / "schedstat")) >> had_ns >> waited_ns) {
    time.had = std::chrono::nanoseconds(had_ns);
    time.waited = std::chrono::nanoseconds(waited_ns);
  }
  // "<pid> (<name>) <state> ...", with any characters in the name.
  const std::string line = first_line(process / "stat");
  const std::size_t state = line.rfind(") ");
  time.runnable = state != std::string::npos && line.substr(state + 2, 1) == "R";
  return time;
}

std::optional<std::string> portable_kernels() {
  const char* const variable = "OPENBLAS_CORETYPE";
  if (std::getenv(variable) != nullptr) return std::nullopt;
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return std::nullopt;
  return fmt::format("{}=Haswell", variable);
}

}  // namespace corridor
