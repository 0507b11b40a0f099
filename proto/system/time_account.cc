// SPDX-License-Identifier: Apache-2.0
#include "proto/system/time_account.h"

#include <algorithm>

namespace corridor {
namespace {

double cpu_s(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

const char* time_part_name(TimePart part) {
  constexpr std::array<const char*, kTimeParts> kNames = {
      "simulate",        "traffic",         "world",           "load",    "plan",       "infer",
      "insert",          "sample",          "update",          "publish", "checkpoint", "transport",
      "wait_for_actors", "wait_for_replay", "wait_for_learner"};
  return kNames[static_cast<std::size_t>(part)];
}

std::string time_metric(TimePart part) { return std::string("time/") + time_part_name(part); }

std::vector<std::pair<std::string, double>> TimeAccount::take(TimePoint now) {
  const double wall_s = this->wall_s(now);
  std::vector<std::pair<std::string, double>> values;
  for (std::size_t i = 0; i < kTimeParts; ++i) {
    const double spent_s = in_seconds(spent_[i]);
    known_[i] = known_[i] || spent_s > 0.0;
    if (!known_[i]) continue;
    values.emplace_back(time_metric(static_cast<TimePart>(i)),
                        wall_s > 0.0 ? spent_s / wall_s : 0.0);
  }
  const double thread_s = cpu_s(CLOCK_THREAD_CPUTIME_ID);
  const double process_s = cpu_s(CLOCK_PROCESS_CPUTIME_ID);
  const double own_s = thread_s - std::exchange(thread_cpu_s_, thread_s);
  const double all_s = process_s - std::exchange(process_cpu_s_, process_s);
  values.emplace_back(kWallTimeMetric, wall_s);
  values.emplace_back(kCpuTimeMetric, own_s);
  values.emplace_back(kIoCpuTimeMetric, std::max(0.0, all_s - own_s));
  spent_ = {};
  taken_ = now;
  return values;
}

}  // namespace corridor
