// SPDX-License-Identifier: Apache-2.0
#include "actor/escape_search.h"

#include <utility>

namespace corridor::actor {
namespace {

struct Step {
  std::vector<std::uint8_t> choices;
  std::size_t taken = 0;
};

std::vector<std::uint8_t> actions(const std::vector<Step>& path) {
  std::vector<std::uint8_t> taken;
  for (const Step& step : path) taken.push_back(step.choices[step.taken]);
  return taken;
}

}  // namespace

EscapeSearch search_escape(
    std::int64_t attempts_max,
    const std::function<std::optional<Attempt>(std::span<const std::uint8_t>)>& attempt) {
  std::vector<Step> path;
  EscapeSearch search;
  while (search.attempts < attempts_max) {
    std::optional<Attempt> result = attempt(actions(path));
    if (!result) return search;
    ++search.attempts;
    for (auto& choices : result->choices) path.push_back({std::move(choices)});
    if (!result->collided) {
      search.verdict = Verdict::kAvoidable;
      search.escape = actions(path);
      return search;
    }
    // Back to the last step that has another choice.
    while (!path.empty() && ++path.back().taken == path.back().choices.size()) path.pop_back();
    if (path.empty()) {
      search.verdict = Verdict::kUnavoidable;
      return search;
    }
  }
  return search;
}

}  // namespace corridor::actor
