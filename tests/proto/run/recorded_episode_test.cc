// SPDX-License-Identifier: Apache-2.0
#include "proto/run/recorded_episode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/run/json_record.h"
#include "proto/system/files.h"
#include "tests/support/refused_records.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

class Recorded : public testing::Test {
 protected:
  void read(const Json& json) const {
    write_file(temporary_.path() / "file.json", json.dump());
    read_recorded_episode(temporary_.path() / "file.json");
  }

  testing_support::TemporaryDirectory temporary_;
  RunDirectory run_ = RunDirectory::create(temporary_.path() / "run");
  RecordedEpisode episode_{"rules+mop",
                           7,
                           3,
                           ~std::uint64_t{0},
                           false,
                           {0, 53},
                           "0123456789abcdef",
                           {2, 1.5, 2.5, 1, 0, 0, 20.0, {2}, 0, CollisionKind::kOffRoad, 3}};
};

TEST_F(Recorded, IsReadAsItWasWritten) {
  write_recorded_episode(run_, episode_);
  EXPECT_EQ(read_recorded_episode(run_.episodes() / "rules+mop_7_3.json"), episode_);
}

TEST_F(Recorded, IsRefusedWhenAMemberIsMissingOrWrong) {
  const Json json = json_of(episode_);
  const auto reader = [&](const Json& changed) { read(changed); };
  testing_support::expect_every_member_is_needed(json, reader);
  testing_support::expect_refused(json, "/actions", Json{1}, "1 actions for 2 steps", reader);
  testing_support::expect_refused(json, "/actions/0", 256, "actions", reader);
  testing_support::expect_refused(json, "/driven_by_world", 0, "driven_by_world", reader);
  EXPECT_THROW(read(Json::array()), Failure);
}

TEST_F(Recorded, NeedsNoActionsWhereTheWorldDrove) {
  episode_.driven_by_world = true;
  episode_.actions.clear();
  EXPECT_NO_THROW(read(json_of(episode_)));
}

}  // namespace
}  // namespace corridor
