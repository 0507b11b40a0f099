// SPDX-License-Identifier: Apache-2.0
// `corridor check`.
#pragma once

#include <filesystem>

namespace corridor::cluster {

// Whether the scenario is right, netconvert's opinion of its road included: prints "<file>: ok" and
// what it comes to, in a few lines: road, traffic, training, memory. Returns 0. Throws Failure
// saying what is wrong.
int check(const std::filesystem::path& scenario);

}  // namespace corridor::cluster
