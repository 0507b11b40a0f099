// Runs and their figures -> the page of a report. Pure.
#pragma once

#include <string>
#include <vector>

#include "cluster/figures.h"
#include "cluster/run_record.h"

namespace corridor::cluster {

struct DrawnFigure {
  Figure figure;
  std::string svg;
};

// Runs with versions and fingerprints; figures; the tables of each training in each world; the
// commands that repeat them, for a shell; the settings.
std::string report_page(const std::vector<RunGroup>& groups,
                        const std::vector<DrawnFigure>& figures);

// The commands that train and evaluate such a run again, one a line.
std::string repeating_commands(const RunRecord& run);

}  // namespace corridor::cluster
