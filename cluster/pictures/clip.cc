// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/clip.h"

#include <algorithm>
#include <cmath>

#include "proto/base/failure.h"

namespace corridor::cluster {
namespace {

TracedVehicle between(const TracedVehicle& a, const TracedVehicle& b, double share) {
  TracedVehicle vehicle = a;
  vehicle.s_m = std::lerp(a.s_m, b.s_m, share);
  vehicle.d_m = std::lerp(a.d_m, b.d_m, share);
  vehicle.speed_mps = std::lerp(a.speed_mps, b.speed_mps, share);
  vehicle.yaw_rad = std::lerp(a.yaw_rad, b.yaw_rad, share);
  return vehicle;
}

TracedScene scene_of(const TracedStep& step) { return {step.ego, step.others}; }

}  // namespace

double Clip::duration_s() const {
  return trace.step_s * static_cast<double>(trace.steps.size() - 1);
}

const TracedStep& Clip::step_at(double time_s) const {
  const auto last = static_cast<double>(trace.steps.size() - 1);
  return trace.steps[static_cast<std::size_t>(std::clamp(time_s / trace.step_s, 0.0, last))];
}

TracedScene Clip::scene_at(double time_s) const {
  const auto last = static_cast<double>(trace.steps.size() - 1);
  const double at = std::clamp(time_s / trace.step_s, 0.0, last);
  const auto index = static_cast<std::size_t>(at);
  const TracedStep& step = trace.steps[index];
  if (index + 1 == trace.steps.size()) return scene_of(step);

  const std::size_t parts = step.on_the_way.size() + 1;
  const double at_part = (at - static_cast<double>(index)) * static_cast<double>(parts);
  const std::size_t part = std::min(static_cast<std::size_t>(at_part), parts - 1);
  const TracedScene before = part == 0 ? scene_of(step) : step.on_the_way[part - 1];
  const TracedScene after =
      part + 1 == parts ? scene_of(trace.steps[index + 1]) : step.on_the_way[part];
  const double share = at_part - static_cast<double>(part);
  TracedScene scene{between(before.ego, after.ego, share), {}};
  for (const TracedVehicle& vehicle : before.others) {
    const auto later = std::ranges::find(after.others, vehicle.id, &TracedVehicle::id);
    if (later != after.others.end()) scene.others.push_back(between(vehicle, *later, share));
  }
  return scene;
}

Clip clip_of(const EpisodeTrace& trace, const std::string& title, double from_s, double to_s) {
  CORRIDOR_CHECK(!trace.steps.empty() && from_s <= to_s, "{} to {} s", from_s, to_s);
  const std::size_t last = trace.steps.size() - 1;
  const auto index = [&](double time_s) {
    return std::min(last, static_cast<std::size_t>(std::max(0.0, time_s / trace.step_s + 1e-9)));
  };
  Clip clip;
  clip.title = title;
  clip.trace = trace;
  const std::size_t first = std::min(index(from_s), last == 0 ? 0 : last - 1);
  const std::size_t end = std::max(index(to_s), first);
  clip.trace.steps.assign(trace.steps.begin() + static_cast<std::ptrdiff_t>(first),
                          trace.steps.begin() + static_cast<std::ptrdiff_t>(end) + 1);
  if (end < last) clip.trace.collision.reset();
  clip.start_s = static_cast<double>(first) * trace.step_s;
  return clip;
}

}  // namespace corridor::cluster
