// SPDX-License-Identifier: Apache-2.0
// The episodes that a report shows: chosen among those of an evaluation, and driven again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cluster/pictures/episode_figure.h"
#include "cluster/report/run_record.h"

namespace corridor::cluster {

// The median in BP reward among a planner's episodes without collision, the cut off ones at the end
// of a seed excepted. The first in which the planner collided, not at once. Pure.
std::optional<EpisodeName> typical_episode(const std::vector<EvaluationRecord>& of_planner);
std::optional<EpisodeName> failed_episode(const std::vector<EvaluationRecord>& of_planner);

struct ReportedEpisodes {
  std::vector<EpisodeFigure> figures;  // one for each evaluated planner, in the order of a table
  std::vector<std::string> notes;      // why an episode is missing, a line each
};

// Of the first run that was evaluated in traffic as in its training; drives the episodes again by
// corridor-actor, each within a minute.
ReportedEpisodes report_episodes(const std::vector<RunGroup>& groups);

}  // namespace corridor::cluster
