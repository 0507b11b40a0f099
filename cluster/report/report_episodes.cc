// SPDX-License-Identifier: Apache-2.0
#include "cluster/report/report_episodes.h"

#include <algorithm>
#include <chrono>
#include <tuple>

#include "cluster/launch/traced_episode.h"
#include "proto/base/failure.h"
#include "proto/base/format.h"
#include "proto/run/run_directory.h"
#include "proto/settings/planner_pairs.h"

namespace corridor::cluster {
namespace {

// Of these evaluations, which lie there.
ReportedEpisodes driven_again(const RunDirectory& directory,
                              const std::vector<EvaluationRecord>& results) {
  ReportedEpisodes reported;
  const auto driven = [&](const std::optional<EpisodeName>& chosen) {
    std::optional<DrivenEpisode> episode;
    if (!chosen) return episode;
    try {
      episode = {chosen->text(), traced_by_actor(directory, TraceTask{directory.episode(*chosen)},
                                                 std::chrono::minutes(1))};
    } catch (const Failure& failure) {
      reported.notes.push_back(fmt::format("no picture of {}: {}", chosen->text(), failure.what()));
    }
    return episode;
  };
  for (const PlannerPair& pair : kPlannerPairs) {
    std::vector<EvaluationRecord> of_planner;
    for (const EvaluationRecord& result : results) {
      if (result.planner == pair.name) of_planner.push_back(result);
    }
    if (of_planner.empty()) continue;
    EpisodeFigure figure{pair.name, driven(typical_episode(of_planner)),
                         driven(failed_episode(of_planner))};
    if (figure.typical || figure.failed) reported.figures.push_back(std::move(figure));
  }
  return reported;
}

}  // namespace

std::optional<EpisodeName> typical_episode(const std::vector<EvaluationRecord>& of_planner) {
  std::int64_t longest = 0;
  for (const EvaluationRecord& result : of_planner) {
    for (const EpisodeRecord& episode : result.per_episode)
      longest = std::max(longest, episode.steps);
  }
  std::vector<std::tuple<double, std::uint64_t, std::uint64_t>> whole;
  for (const EvaluationRecord& result : of_planner) {
    for (const EpisodeRecord& episode : result.per_episode) {
      if (episode.collisions == 0 && episode.steps == longest)
        whole.emplace_back(episode.bp_reward, result.seed, episode.episode);
    }
  }
  if (whole.empty()) return std::nullopt;
  std::ranges::sort(whole);
  const auto& [reward, seed, index] = whole[whole.size() / 2];
  return EpisodeName{of_planner.front().planner, seed, index};
}

std::optional<EpisodeName> failed_episode(const std::vector<EvaluationRecord>& of_planner) {
  for (const EvaluationRecord& result : of_planner) {
    for (const EpisodeRecord& episode : result.per_episode) {
      if (episode.collisions > 0 && episode.steps >= static_cast<std::int64_t>(kShownInstants))
        return EpisodeName{result.planner, result.seed, episode.episode};
    }
  }
  return std::nullopt;
}

ReportedEpisodes report_episodes(const std::vector<RunGroup>& groups) {
  for (const RunGroup& group : groups) {
    for (const RunRecord& run : group.runs) {
      for (const auto& [world, results] : run.evaluations) {
        if (run.worlds_of_training.contains(world))
          return driven_again(RunDirectory::open(run.driven_in(world)), results);
      }
    }
  }
  return {};
}

}  // namespace corridor::cluster
