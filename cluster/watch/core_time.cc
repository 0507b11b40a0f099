#include "cluster/watch/core_time.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "proto/base/failure.h"
#include "proto/system/time_account.h"

namespace corridor::cluster {

CoreTime cores_by_part(const MetricsValues& values) {
  const double wall_s = value_of(values, kWallTimeMetric);
  if (wall_s <= 0.0) return {};
  CoreTime parts;
  double busy = 0.0;
  for (std::size_t i = 0; i < kTimeParts; ++i) {
    const auto part = static_cast<TimePart>(i);
    const auto found = values.find(time_metric(part));
    if (is_wait(part) || found == values.end()) continue;
    parts[time_part_name(part)] = found->second;
    busy += found->second;
  }
  const double cores = value_of(values, kCpuTimeMetric) / wall_s;
  for (auto& [part, share] : parts) share *= busy > 0.0 ? cores / busy : 0.0;
  parts["io"] = value_of(values, kIoCpuTimeMetric) / wall_s;
  return parts;
}

double sum(const CoreTime& parts) {
  double total = 0.0;
  for (const auto& [part, value] : parts) total += value;
  return total;
}

std::string largest_parts(const CoreTime& parts, int count) {
  std::vector<std::pair<double, std::string>> sorted;
  for (const auto& [part, value] : parts) sorted.emplace_back(-value, part);
  std::sort(sorted.begin(), sorted.end());
  const double total = sum(parts);
  std::string text;
  for (const auto& [negative, part] : sorted) {
    if (count-- == 0 || total <= 0.0) break;
    text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", part, -100.0 * negative / total);
  }
  return text;
}

}  // namespace corridor::cluster
