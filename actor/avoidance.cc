// SPDX-License-Identifier: Apache-2.0
#include "actor/avoidance.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "actor/driving/action.h"
#include "actor/escape_search.h"
#include "actor/redrive.h"
#include "actor/what_if.h"
#include "proto/base/failure.h"
#include "proto/run/evaluation_record.h"
#include "proto/settings/collision_kinds.h"
#include "proto/system/program.h"

namespace corridor::actor {
namespace {

using driving::Collision;
using driving::Command;
using driving::Ego;
using driving::Scene;
using driving::Vehicle;
using Actions = std::vector<std::uint8_t>;

// An attempt takes milliseconds.
constexpr std::chrono::milliseconds kAttemptPatience{10'000};

bool in_sight(const Scene& scene, const Collision& collision, const EgoSettings& size) {
  const Vehicle* other = driving::find_vehicle(scene, collision.other);
  if (other == nullptr) return false;
  if (collision.kind == CollisionKind::kSideByEgo) return true;
  if (driving::overlap_across(scene.ego, *other, size)) return true;
  const double to_ego = std::copysign(1.0, scene.ego.d_m - other->d_m);
  return to_ego * other->lateral_speed_mps > kVisible_mps;
}

bool step(Episode& episode, std::uint8_t action) {
  episode.step(Command::kKeep, action);
  return !episode.summary().collision;
}

Attempt drive_on(Episode& episode, std::span<const std::uint8_t> first_actions, int steps,
                 const Collision& collision, const DrivingSettings& settings) {
  Attempt attempt;
  for (int i = 0; i < steps && !attempt.collided; ++i) {
    const auto index = static_cast<std::size_t>(i);
    if (index >= first_actions.size()) {
      attempt.choices.push_back(evasive_actions(episode.scene(), collision, settings));
    }
    attempt.collided =
        !step(episode,
              index < first_actions.size() ? first_actions[index] : attempt.choices.back().front());
  }
  return attempt;
}

// An attempt as bytes: whether it collided, then each list behind its length.
Bytes pack(const Attempt& attempt) {
  Bytes bytes = {static_cast<std::uint8_t>(attempt.collided)};
  for (const Actions& list : attempt.choices) {
    bytes.push_back(static_cast<std::uint8_t>(list.size()));
    bytes.insert(bytes.end(), list.begin(), list.end());
  }
  return bytes;
}

Attempt unpack(const Bytes& bytes) {
  Attempt attempt;
  attempt.collided = bytes.at(0) != 0;
  for (auto at = bytes.begin() + 1; at != bytes.end(); at += 1 + *at) {
    attempt.choices.emplace_back(at + 1, at + 1 + *at);
  }
  return attempt;
}

// The recorded episode, up to some step of it.
class Recording {
 public:
  Recording(const RunConfig& config, const RecordedEpisode& recorded, world::World& world)
      : settings_(driving_settings(config)),
        recorded_(recorded),
        steps_(static_cast<int>(recorded.summary.steps)),
        episode_(config, world) {}

  // Drives it whole and says what it came to; then again up to `actions` before the collision.
  CollisionHindsight drive(int actions) {
    std::vector<Scene> seen;
    drive_as_recorded(episode_, recorded_, start_of(recorded_),
                      [&] { seen.push_back(episode_.scene()); });
    check_as_recorded(episode_, recorded_);
    seen.pop_back();  // where the collision has happened
    if (!episode_.summary().collision) {
      throw Failure("{} ends without a collision", recorded_.name().text());
    }
    collision_ = *episode_.summary().collision;
    episode_.begin(start_of(recorded_));
    drive_up_to(steps_ - actions);
    CollisionHindsight result;
    result.episode = recorded_.episode;
    result.collision_kind = collision_.kind;
    result.step = steps_;
    result.actions_in_sight = actions_in_sight(seen, collision_, settings_.ego);
    return result;
  }

  // By the last `actions`, at most as many as drive() has stopped before the collision.
  EscapeSearch search(int actions, std::int64_t attempts_max) {
    return search_escape(attempts_max, [&](std::span<const std::uint8_t> first_actions) {
      std::optional<Attempt> attempt;
      if (stop_requested()) return attempt;
      attempt = unpack(what_if(
          [&] {
            give_way(actions);
            return pack(
                drive_on(episode_, first_actions, actions + kMarginSteps, collision_, settings_));
          },
          kAttemptPatience));
      return attempt;
    });
  }

  // Once more, from the start and without copies.
  void check_escape(int actions, const Actions& escape) {
    episode_.begin(start_of(recorded_));
    give_way(actions);
    const bool escapes =
        std::ranges::all_of(escape, [&](std::uint8_t action) { return step(episode_, action); });
    if (!escapes) {
      throw Failure("{}: an escape that was found in copies collides in the original",
                    recorded_.name().text());
    }
  }

 private:
  void drive_up_to(int step) {
    while (episode_.summary().steps < step) step_as_recorded(episode_, recorded_);
  }

  // As recorded up to `actions` before the collision; from there on as is tried.
  void give_way(int actions) {
    drive_up_to(steps_ - actions);
    if (recorded_.driven_by_world) episode_.take_over();
  }

  DrivingSettings settings_;
  const RecordedEpisode& recorded_;
  int steps_;
  Episode episode_;
  Collision collision_;
};

// The MoP's, at most so many.
std::vector<int> last_actions(const RecordedEpisode& recorded, int count) {
  const auto kept = std::min(static_cast<std::size_t>(count), recorded.actions.size());
  std::vector<int> actions;
  for (std::size_t i = recorded.actions.size() - kept; i < recorded.actions.size(); ++i) {
    actions.push_back(driving::unpack(recorded.actions[i]).mop_action);
  }
  return actions;
}

}  // namespace

std::vector<std::uint8_t> evasive_actions(const Scene& scene, const Collision& collision,
                                          const DrivingSettings& settings) {
  const Ego& ego = scene.ego;
  const Vehicle* other = driving::find_vehicle(scene, collision.other);
  const int away = other != nullptr && ego.d_m < other->d_m ? -1 : 1;
  const auto speed_changes = static_cast<int>(settings.planner.speed_changes_mps.size());
  const bool from_behind = collision.kind == CollisionKind::kRearEnded;
  Actions actions;
  std::vector<driving::Target> targets;
  for (const int corridor_change : {away, 0, -away}) {
    for (int i = 0; i < speed_changes; ++i) {
      const int speed_change = from_behind ? speed_changes - 1 - i : i;
      const driving::MopAction action{corridor_change, speed_change};
      const driving::Target target = driving::target_for(action, ego, settings);
      // At the road's edge a change of corridor is none.
      const bool straight_on = target == driving::target_for({0, speed_change}, ego, settings);
      if (corridor_change != 0 && straight_on) continue;
      if (std::ranges::find(targets, target) != targets.end()) continue;
      targets.push_back(target);
      actions.push_back(static_cast<std::uint8_t>(driving::index_of(action)));
    }
  }
  return actions;
}

int actions_in_sight(std::span<const Scene> seen, const Collision& collision,
                     const EgoSettings& ego) {
  int count = 0;
  while (static_cast<std::size_t>(count) < seen.size() &&
         in_sight(seen[seen.size() - 1 - static_cast<std::size_t>(count)], collision, ego)) {
    ++count;
  }
  return count;
}

Verdict by_last(int actions, std::span<const Verdict> searched) {
  CORRIDOR_CHECK(actions >= 1 && !searched.empty(), "{} actions", actions);
  return searched[std::min(static_cast<std::size_t>(actions), searched.size()) - 1];
}

Verdict by_reacting(int actions_in_sight, std::span<const Verdict> searched) {
  if (actions_in_sight == 0) return Verdict::kUnavoidable;
  const Verdict verdict = by_last(actions_in_sight, searched);
  const bool all_searched = static_cast<std::size_t>(actions_in_sight) <= searched.size();
  return all_searched || verdict == Verdict::kAvoidable ? verdict : Verdict::kUndecided;
}

CollisionHindsight look_back(const RunConfig& config, const RecordedEpisode& recorded,
                             world::World& world, const HindsightLimits& limits) {
  CORRIDOR_CHECK(limits.actions >= 1, "{} actions", limits.actions);
  const int actions_max = std::min(limits.actions, static_cast<int>(recorded.summary.steps));
  Recording recording(config, recorded, world);
  CollisionHindsight result = recording.drive(actions_max);
  result.recorded = last_actions(recorded, limits.actions);
  std::vector<Verdict> searched;
  for (int actions = 1; actions <= actions_max && result.escape.empty(); ++actions) {
    const EscapeSearch search = recording.search(actions, limits.attempts_max);
    searched.push_back(search.verdict);
    result.attempts.push_back(search.attempts);
    if (search.verdict != Verdict::kAvoidable) continue;
    recording.check_escape(actions, search.escape);
    result.escape = search.escape;
  }
  result.by_reacting = by_reacting(result.actions_in_sight, searched);
  for (int i = 1; i <= limits.actions; ++i) result.by_last_actions.push_back(by_last(i, searched));
  return result;
}

void report_hindsight(const RunConfig& config, const LookBackTask& task,
                      const RunDirectory& directory, world::World& world,
                      const std::function<bool(std::int64_t, std::int64_t)>& progress) {
  task.limits.check();
  const RunDirectory driven = task.evaluated ? RunDirectory::open(*task.evaluated) : directory;
  const EvaluationRecord evaluated = read_evaluation(driven.evaluation({task.planner, task.seed}));
  HindsightRecord record{task.planner, task.seed, evaluated.steps, task.limits, {}};
  for (const EpisodeRecord& episode : evaluated.per_episode) {
    if (episode.collisions == 0) continue;
    const RecordedEpisode recorded =
        read_own_episode(config, driven.episode({task.planner, task.seed, episode.episode}));
    record.collisions.push_back(look_back(config, recorded, world, task.limits));
    if (!progress(static_cast<std::int64_t>(record.collisions.size()), evaluated.collisions))
      return;
  }
  write_hindsight(directory, record);
}

}  // namespace corridor::actor
