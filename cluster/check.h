// SPDX-License-Identifier: Apache-2.0
// `corridor check`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace corridor::cluster {

// Whether the scenario is right, netconvert's opinion of its road included: prints "<file>: ok" and
// what it comes to with `settings` (table.key=value), in a few lines: road, traffic, training,
// memory, and warnings of what makes no sense together. Returns 0. Throws Failure saying what is
// wrong.
int check(const std::filesystem::path& scenario, const std::vector<std::string>& settings);

}  // namespace corridor::cluster
