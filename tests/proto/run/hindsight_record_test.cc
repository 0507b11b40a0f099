// SPDX-License-Identifier: Apache-2.0
#include "proto/run/hindsight_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/run/json_record.h"
#include "proto/system/files.h"
#include "tests/support/refused_records.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

class HindsightFile : public testing::Test {
 protected:
  void read(const Json& json) const {
    write_file(temporary_.path() / "file.json", json.dump());
    read_hindsight(temporary_.path() / "file.json");
  }

  testing_support::TemporaryDirectory temporary_;
  RunDirectory run_ = RunDirectory::create(temporary_.path() / "run");
  HindsightRecord record_{"rules",
                          7,
                          2000,
                          {2, 500},
                          {{4,
                            CollisionKind::kRearEnding,
                            31,
                            1,
                            Verdict::kUnavoidable,
                            {Verdict::kUnavoidable, Verdict::kAvoidable},
                            {500, 3},
                            {16, 16},
                            {1, 0, 2, 2, 2, 2}}}};
};

TEST_F(HindsightFile, IsReadAsItWasWritten) {
  write_hindsight(run_, record_);
  EXPECT_EQ(read_hindsight(run_.root() / "evaluation/hindsight/rules_7.json"), record_);
}

// The file's form is what people's scripts read.
TEST_F(HindsightFile, HasTheDocumentedMembers) {
  EXPECT_EQ(json_of(record_), Json::parse(R"({"planner": "rules", "seed": 7, "steps": 2000,
      "actions": 2, "attempts_max": 500, "collisions": [{"episode": 4,
      "collision_kind": "rear_ending", "step": 31, "actions_in_sight": 1,
      "by_reacting": "unavoidable", "by_last_actions": ["unavoidable", "avoidable"],
      "attempts": [500, 3], "recorded": [16, 16], "escape": [1, 0, 2, 2, 2, 2]}]})"));
}

TEST_F(HindsightFile, IsRefusedWhenAMemberIsMissingOrWrong) {
  const Json json = json_of(record_);
  const auto reader = [&](const Json& changed) { read(changed); };
  const auto refused = [&](const char* pointer, const Json& value, const char* why) {
    testing_support::expect_refused(json, pointer, value, why, reader);
  };
  testing_support::expect_every_member_is_needed(json, reader);
  refused("/planner", 3, "file.json is no hindsight: planner");
  refused("/steps", 0, "0 steps");
  refused("/steps", 1e87, "steps");
  refused("/actions", 0, "0 actions");
  refused("/actions", 1'000'000, "1000000 actions");
  refused("/actions", 3, "2 verdicts by the last 3 actions");
  refused("/attempts_max", 0, "0 attempts");
  refused("/collisions/0/by_reacting", "perhaps", "must be one of avoidable");
  refused("/collisions/0/by_last_actions", "avoidable", "where a list belongs");
  refused("/collisions/0/by_last_actions/1", nullptr, "by_last_actions");
  EXPECT_THROW(read(Json::array()), Failure);
}

}  // namespace
}  // namespace corridor
