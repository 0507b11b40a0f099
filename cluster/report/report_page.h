// SPDX-License-Identifier: Apache-2.0
// Runs and their figures -> the page of a report. Pure.
#pragma once

#include <string>
#include <vector>

#include "cluster/report/run_record.h"

namespace corridor::cluster {

struct DrawnFigure {
  std::string name;  // of its files
  std::string caption;
  std::string svg, png;
};

// By which a page is known for one of ours.
inline constexpr const char* kGenerator = "<meta name=\"generator\" content=\"corridor\">";

// Runs with versions and fingerprints; the figures of their training; the tables of each training
// in each world; single episodes; the commands that repeat it all, for a shell; the settings.
std::string report_page(const std::vector<RunGroup>& groups,
                        const std::vector<DrawnFigure>& training,
                        const std::vector<DrawnFigure>& episodes);

// The commands that train and evaluate such a run again, one a line.
std::string repeating_commands(const RunRecord& run);

}  // namespace corridor::cluster
