#include "actor/episode_trace.h"

#include "actor/recorded_episode.h"

namespace corridor::actor {
namespace {

TracedStep traced(const driving::Scene& scene, const EgoSettings& size) {
  const driving::Ego& ego = scene.ego;
  TracedStep step;
  step.ego = {0, ego.s_m, ego.d_m, ego.speed_mps, size.length_m, size.width_m};
  for (const driving::Vehicle& other : scene.others) {
    step.others.push_back(
        {other.id, other.s_m, other.d_m, other.speed_mps, other.length_m, other.width_m});
  }
  return step;
}

}  // namespace

EpisodeTrace trace_episode(const RunConfig& config, const std::filesystem::path& file,
                           world::World& world) {
  const RecordedEpisode recorded = read_recorded_episode(config, file);
  EpisodeTrace trace;
  trace.step_s = config.simulation.step_s;
  trace.lanes = config.road.lanes;
  trace.lane_width_m = config.road.lane_width_m;
  trace.speed_limit_mps = config.road.speed_limit_mps;

  Episode episode(config, world);
  drive_as_recorded(episode, recorded, [&] {
    if (!trace.steps.empty() && !recorded.driven_by_world())
      trace.steps.back().command = static_cast<int>(episode.situation().previous);
    trace.steps.push_back(traced(episode.situation().scene, config.ego));
  });
  episode.end();
  check_as_recorded(episode, recorded);
  const EpisodeSummary& summary = episode.summary();
  trace.bp_reward = summary.bp_reward;
  trace.lane_changes = summary.lane_changes;
  if (summary.collision) {
    trace.collision = {driving::collision_kind_name(summary.collision->kind),
                       summary.collision->other};
  }
  return trace;
}

}  // namespace corridor::actor
