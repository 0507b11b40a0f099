// `corridor check`.
#pragma once

#include <filesystem>
#include <string>

#include "proto/settings/settings.h"

namespace corridor::cluster {

// What a scenario comes to, in a few lines: road, traffic, training, memory.
std::string summary(const RunConfig& config);

// Whether the scenario is right, netconvert's opinion of its road included: prints "<file>: ok" and
// the summary and returns 0. Throws Failure saying what is wrong.
int check(const std::filesystem::path& scenario);

}  // namespace corridor::cluster
