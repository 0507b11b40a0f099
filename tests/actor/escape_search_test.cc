// SPDX-License-Identifier: Apache-2.0
#include "actor/escape_search.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace corridor::actor {
namespace {

using Actions = std::vector<std::uint8_t>;

// A game of `depth` steps with the actions 0 .. choices - 1, which `survives` decides step by step.
struct Game {
  int depth;
  std::uint8_t choices;
  std::function<bool(const Actions& so_far)> survives;
  std::set<std::string> tried = {};  // an action is a character

  std::optional<Attempt> play(std::span<const std::uint8_t> first_actions) {
    Attempt attempt;
    Actions so_far;
    for (int i = 0; i < depth && !attempt.collided; ++i) {
      if (so_far.size() < first_actions.size()) {
        so_far.push_back(first_actions[so_far.size()]);
      } else {
        attempt.choices.emplace_back();
        for (std::uint8_t a = 0; a < choices; ++a) attempt.choices.back().push_back(a);
        so_far.push_back(0);
      }
      attempt.collided = !survives(so_far);
    }
    EXPECT_TRUE(tried.emplace(so_far.begin(), so_far.end()).second) << "tried twice";
    return attempt;
  }

  EscapeSearch search(std::int64_t attempts_max = 1000) {
    return search_escape(attempts_max, [this](auto first) { return play(first); });
  }
};

TEST(EscapeSearch, TakesTheFirstChoicesWhenTheyEscape) {
  Game game{3, 2, [](const Actions&) { return true; }};
  const EscapeSearch search = game.search();
  EXPECT_EQ(search.verdict, Verdict::kAvoidable);
  EXPECT_EQ(search.escape, (Actions{0, 0, 0}));
  EXPECT_EQ(search.attempts, 1);
}

TEST(EscapeSearch, FindsTheOnlyEscapeWhereverItIs) {
  for (std::uint8_t code = 0; code < 27; ++code) {
    const Actions only = {static_cast<std::uint8_t>(code / 9),
                          static_cast<std::uint8_t>(code / 3 % 3),
                          static_cast<std::uint8_t>(code % 3)};
    Game game{3, 3, [&](const Actions& so_far) { return so_far.size() < 3 || so_far == only; }};
    const EscapeSearch search = game.search();
    EXPECT_EQ(search.verdict, Verdict::kAvoidable) << int{code};
    EXPECT_EQ(search.escape, only);
    EXPECT_EQ(search.attempts, code + 1);
  }
}

TEST(EscapeSearch, UnavoidableMeansThatEverySequenceWasTried) {
  Game game{3, 3, [](const Actions& so_far) { return so_far.size() < 3; }};
  const EscapeSearch search = game.search();
  EXPECT_EQ(search.verdict, Verdict::kUnavoidable);
  EXPECT_EQ(search.attempts, 27);
  EXPECT_EQ(game.tried.size(), 27u);
  EXPECT_TRUE(search.escape.empty());
}

TEST(EscapeSearch, DoesNotTryWhatBeginsWithACollision) {
  Game game{3, 3, [](const Actions& so_far) { return so_far.size() < 3 && so_far[0] == 2; }};
  const EscapeSearch search = game.search();
  EXPECT_EQ(search.verdict, Verdict::kUnavoidable);
  EXPECT_EQ(search.attempts, 2 + 9);
}

TEST(EscapeSearch, GivesUpUndecidedAfterTheAttemptsOrWhenTold) {
  Game game{3, 3, [](const Actions& so_far) { return so_far.size() < 3; }};
  EscapeSearch search = game.search(26);
  EXPECT_EQ(search.verdict, Verdict::kUndecided);
  EXPECT_EQ(search.attempts, 26);
  search = search_escape(10, [](auto) { return std::optional<Attempt>(); });
  EXPECT_EQ(search.verdict, Verdict::kUndecided);
  EXPECT_EQ(search.attempts, 0);
}

}  // namespace
}  // namespace corridor::actor
