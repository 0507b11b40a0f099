// SPDX-License-Identifier: Apache-2.0
#include "proto/run/episode_name.h"

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(EpisodeName, IsReadAsItIsWritten) {
  EXPECT_EQ((EvaluationName{"rules+mop", 1002}.text()), "rules+mop_1002");
  const EpisodeName name{"rules+mop", 1002, 3};
  EXPECT_EQ(name.text(), "rules+mop_1002_3");
  EXPECT_EQ(parse_episode_name(name.text()), name);
}

TEST(EpisodeName, IsNoOtherText) {
  for (const char* text : {"", "rules", "rules_3", "_1_2", "rules_1_", "rules_1_x", "rules_-1_2",
                           "rules_1_2.json", "rules_1_99999999999999999999"}) {
    EXPECT_FALSE(parse_episode_name(text)) << text;
  }
}

}  // namespace
}  // namespace corridor
