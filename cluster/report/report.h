// SPDX-License-Identifier: Apache-2.0
// `corridor report`.
#pragma once

#include <filesystem>
#include <vector>

namespace corridor::cluster {

struct ReportOptions {
  std::vector<std::filesystem::path> runs = {};  // run directories; at least one
  std::filesystem::path out = {};                // empty: report/ in the first of them
};

// Writes report.html, a page that needs nothing else, and each of its figures as SVG and PNG, and
// says where. Equal runs give equal files. Returns the exit status. Throws Failure, before anything
// is written, when a run cannot be read or a figure cannot be drawn.
int report(const ReportOptions& options);

}  // namespace corridor::cluster
