// SPDX-License-Identifier: Apache-2.0
#include "actor/tracer.h"

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "actor/planners.h"
#include "actor/redrive.h"
#include "proto/base/failure.h"
#include "proto/settings/collision_kinds.h"

namespace corridor::actor {
namespace {

// How far ahead a trajectory is shown, and in what steps.
constexpr double kPath_s = 4.0;
constexpr double kPathStep_s = 0.2;

TracedScene traced(const driving::Scene& scene, const EgoSettings& size) {
  const driving::Ego& ego = scene.ego;
  TracedScene traced{{0, ego.s_m, ego.d_m, ego.speed_mps, size.length_m, size.width_m, ego.yaw_rad},
                     {}};
  for (const driving::Vehicle& other : scene.others) {
    traced.others.push_back(
        {other.id, other.s_m, other.d_m, other.speed_mps, other.length_m, other.width_m, 0.0});
  }
  return traced;
}

// Drives an episode and writes down what happens.
class Tracer {
 public:
  // `networks` may be null, and must outlive it.
  Tracer(const RunConfig& config, const PlannerPair& pair, const Networks* networks,
         world::World& world)
      : config_(config), settings_(driving_settings(config)), episode_(config, world) {
    if (networks != nullptr && pair.bp == BpKind::kLearned) bp_.emplace(config, *networks);
    if (networks != nullptr && pair.mop == MopKind::kLearned) mop_.emplace(config, *networks);
    for (const driving::Skill& skill : episode_.skills()) trace_.commands.push_back(skill.name);
    trace_.step_s = config.simulation.step_s;
    trace_.lanes = config.road.lanes;
    trace_.lane_width_m = config.road.lane_width_m;
    trace_.speed_limit_mps = config.road.speed_limit_mps;
  }

  const Episode& episode() const { return episode_; }

  // At most `steps` of the episode; `choose` says what each is driven with.
  EpisodeTrace drive(world::EpisodeStart start, std::int64_t steps,
                     const std::function<driving::StepAction()>& choose) {
    start.watch = [this](const driving::Scene& scene) {
      substeps_.push_back(traced(scene, config_.ego));
    };
    episode_.begin(start);
    add_step();
    bool ended = false;
    for (std::int64_t i = 0; i < steps && !ended; ++i) {
      const bool by_world = start.driver == world::EgoDriver::kWorld;
      ended = (by_world ? episode_.step_by_world() : step(choose())).episode_ended;
      add_step();
    }
    episode_.end();
    const EpisodeSummary& summary = episode_.summary();
    trace_.bp_reward = summary.bp_reward;
    trace_.lane_changes = summary.lane_changes;
    if (summary.collision) {
      trace_.collision = {summary.collision->kind, summary.collision->other};
    }
    return std::move(trace_);
  }

 private:
  StepOutcome step(const driving::StepAction& action) {
    TracedDecision decision = look_at(action);
    const StepOutcome outcome = episode_.step(action.command, action.mop_action);
    decision.bp_reward = outcome.bp_reward;
    decision.mop_reward = outcome.mop_reward;
    trace_.steps.back().command = static_cast<int>(episode_.situation().previous);
    trace_.steps.back().decision = std::move(decision);
    return outcome;
  }

  void add_step() {
    // The last of the substeps is the step itself.
    if (!substeps_.empty()) substeps_.pop_back();
    if (!trace_.steps.empty()) trace_.steps.back().on_the_way = std::exchange(substeps_, {});
    TracedScene scene = traced(episode_.scene(), config_.ego);
    TracedStep step;
    step.ego = scene.ego;
    step.others = std::move(scene.others);
    trace_.steps.push_back(std::move(step));
  }

  TracedDecision look_at(const driving::StepAction& action) {
    const driving::Situation& situation = episode_.situation();
    const driving::Window window = episode_.window(action.command);
    const driving::Target target =
        driving::target_for(driving::mop_action(action.mop_action), situation.scene.ego, settings_);
    TracedDecision decision;
    decision.corridor = target.corridor;
    decision.set_point_mps = target.set_point_mps;
    decision.mop_action = action.mop_action;
    if (bp_) {
      const auto values = bp_->values(situation);
      decision.bp_values.assign(values.begin(), values.end());
    }
    if (mop_) {
      const auto values = mop_->values(situation, window);
      decision.mop_values.assign(values.begin(), values.end());
    }
    decision.window_first = window.first;
    decision.window_open = window.open;
    for (const driving::CorridorGaps& gaps : situation.gaps) {
      decision.front_gaps_m.push_back(gaps.front_gap_m);
      decision.back_gaps_m.push_back(gaps.back_gap_m);
    }
    const driving::Trajectory trajectory(episode_.reference(), target, settings_);
    for (double time_s = 0.0; time_s <= kPath_s; time_s += kPathStep_s) {
      const driving::TrajectoryPoint point = trajectory.at(time_s);
      decision.path_s_m.push_back(point.s_m);
      decision.path_d_m.push_back(point.d_m);
    }
    return decision;
  }

  RunConfig config_;
  DrivingSettings settings_;
  Episode episode_;
  std::optional<QBehaviourPlanner> bp_;
  std::optional<QMotionPlanner> mop_;
  EpisodeTrace trace_;
  std::vector<TracedScene> substeps_;  // of the step under way
};

}  // namespace

EpisodeTrace trace_episode(const RunConfig& config, const Networks* networks,
                           const std::filesystem::path& file, world::World& world) {
  const RecordedEpisode recorded = read_own_episode(config, file);
  Tracer tracer(config, planner_pair(recorded.planner), networks, world);
  std::size_t next = 0;
  EpisodeTrace trace = tracer.drive(start_of(recorded), recorded.summary.steps,
                                    [&] { return driving::unpack(recorded.actions[next++]); });
  check_as_recorded(tracer.episode(), recorded);
  return trace;
}

EpisodeTrace trace_drive(const RunConfig& config, const Networks& networks, const PlannerPair& pair,
                         std::uint64_t episode_seed, std::int64_t steps, world::World& world) {
  const auto bp = make_behaviour_planner(pair, config, networks);
  const auto mop = make_motion_planner(pair, config, networks);
  Tracer tracer(config, pair, &networks, world);
  world::EpisodeStart start{.seed = episode_seed};
  if (pair.world_drives()) start.driver = world::EgoDriver::kWorld;
  if (bp) bp->begin_episode(episode_seed);
  return tracer.drive(start, steps, [&] {
    const Episode& episode = tracer.episode();
    const driving::Command command = bp->decide(episode.situation());
    return driving::StepAction{command, mop->decide(episode.situation(), episode.window(command))};
  });
}

}  // namespace corridor::actor
