#include "actor/look_back.h"

#include <algorithm>

#include "actor/avoidance.h"
#include "actor/driving/action.h"
#include "actor/redrive.h"
#include "proto/run/evaluation_record.h"
#include "proto/run/hindsight_record.h"

namespace corridor::actor {
namespace {

// The MoP's, at most so many.
std::vector<int> last_actions(const RecordedEpisode& recorded, int count) {
  const auto kept = std::min(static_cast<std::size_t>(count), recorded.actions.size());
  std::vector<int> actions;
  for (std::size_t i = recorded.actions.size() - kept; i < recorded.actions.size(); ++i) {
    actions.push_back(driving::unpack(recorded.actions[i]).mop_action);
  }
  return actions;
}

CollisionHindsight record_of(const Hindsight& hindsight, const RecordedEpisode& recorded,
                             int actions) {
  CollisionHindsight record;
  record.episode = recorded.episode;
  record.collision_kind = hindsight.collision.kind;
  record.step = hindsight.step;
  record.actions_in_sight = hindsight.actions_in_sight;
  record.by_reacting = hindsight.by_reacting();
  for (int i = 1; i <= actions; ++i) record.by_last_actions.push_back(hindsight.by_last(i));
  for (const EscapeSearch& search : hindsight.searches) record.attempts.push_back(search.attempts);
  record.recorded = last_actions(recorded, actions);
  record.escape = hindsight.searches.back().escape;
  return record;
}

}  // namespace

void report_hindsight(const RunConfig& config, const LookBackTask& task,
                      const RunDirectory& directory, world::World& world,
                      const std::function<bool(std::int64_t, std::int64_t)>& progress) {
  task.limits.check();
  const EvaluationRecord evaluated =
      read_evaluation(directory.evaluation({task.planner, task.seed}));
  HindsightRecord record{task.planner, task.seed, evaluated.steps, task.limits, {}};
  for (const EpisodeRecord& episode : evaluated.per_episode) {
    if (episode.collisions == 0) continue;
    const RecordedEpisode recorded =
        read_own_episode(config, directory.episode({task.planner, task.seed, episode.episode}));
    record.collisions.push_back(
        record_of(look_back(config, recorded, world, task.limits), recorded, task.limits.actions));
    if (!progress(static_cast<std::int64_t>(record.collisions.size()), evaluated.collisions))
      return;
  }
  write_hindsight(directory, record);
}

}  // namespace corridor::actor
