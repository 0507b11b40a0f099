// SPDX-License-Identifier: Apache-2.0
// What evaluations and their episodes are called, by people and in file names.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace corridor {

// One planner pair on the traffic of one evaluation seed.
struct EvaluationName {
  std::string planner;
  std::uint64_t seed = 0;

  std::string text() const;  // "hierarchical_1002"
  bool operator==(const EvaluationName&) const = default;
};

// An episode of it.
struct EpisodeName {
  std::string planner;
  std::uint64_t seed = 0;
  std::uint64_t index = 0;  // from 0

  std::string text() const;  // "hierarchical_1002_3"
  bool operator==(const EpisodeName&) const = default;
};

// The inverse of text(); nothing when the text is no such name.
std::optional<EpisodeName> parse_episode_name(std::string_view text);

}  // namespace corridor
