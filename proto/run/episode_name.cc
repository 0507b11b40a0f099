// SPDX-License-Identifier: Apache-2.0
#include "proto/run/episode_name.h"

#include "proto/base/format.h"
#include "proto/base/text.h"

namespace corridor {
namespace {

// Cuts "_<number>" off the text's end.
std::optional<std::uint64_t> cut_number(std::string_view& text) {
  const std::size_t at = text.rfind('_');
  if (at == std::string_view::npos) return std::nullopt;
  const auto number = parse_number<std::uint64_t>(text.substr(at + 1));
  if (number) text = text.substr(0, at);
  return number;
}

}  // namespace

std::string EvaluationName::text() const { return fmt::format("{}_{}", planner, seed); }

std::string EpisodeName::text() const {
  return fmt::format("{}_{}", EvaluationName{planner, seed}.text(), index);
}

std::optional<EpisodeName> parse_episode_name(std::string_view text) {
  const auto index = cut_number(text);
  const auto seed = cut_number(text);
  if (!index || !seed || text.empty()) return std::nullopt;
  return EpisodeName{std::string(text), *seed, *index};
}

}  // namespace corridor
