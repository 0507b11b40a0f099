// SPDX-License-Identifier: Apache-2.0
#include "learner/checkpointer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/run/run_directory.h"
#include "tests/learner/scripted_server.h"
#include "tests/learner/small_run.h"
#include "tests/support/temporary_directory.h"

namespace corridor::learner {
namespace {

class CheckpointerTest : public testing::Test {
 protected:
  static LearnerState state_after(std::uint64_t round) {
    LearnerState state = initial_state(small_config());
    state.next_round = round + 1;
    return state;
  }

  // Completes what is under way. A test that hangs here fails by its time.
  void complete() {
    while (checkpointer_.busy()) checkpointer_.advance();
  }

  std::filesystem::path of(int round) const {
    return directory_.checkpoints() / std::to_string(round);
  }

  testing_support::TemporaryDirectory temporary_;
  const RunDirectory directory_ = RunDirectory::create(temporary_.path() / "run");
  const Checkpoints checkpoints_{directory_.checkpoints()};
  std::atomic<bool> replay_is_saved_ = false;
  ScriptedServer server_{
      [this](const ReplayRequest&) { return Body(encode(ReplayReply(Saved{replay_is_saved_}))); }};
  Client client_{server_.address(), "replay server", {kRunId, Role::kLearner, 0, 1}, {}};
  TimeAccount time_;
  ReplayClient replay_{client_, time_, [] {}};
  const RunConfig config_ = small_config();
  Checkpointer checkpointer_{config_, checkpoints_, replay_};
};

TEST_F(CheckpointerTest, ACheckpointIsThereOnceTheReplaysPartIsToo) {
  checkpointer_.begin(state_after(4));
  for (int look = 0; look < 5; ++look) checkpointer_.advance();
  EXPECT_TRUE(checkpointer_.busy());
  EXPECT_EQ(checkpoints_.newest(), std::nullopt);
  replay_is_saved_ = true;
  complete();
  ASSERT_EQ(checkpoints_.newest(), of(4));
  EXPECT_TRUE(read_checkpoint_file(of(4), kLearnerFile) == to_tensors(state_after(4), config_));
}

TEST_F(CheckpointerTest, TheReplayServerIsToldWhereAndWhatWasBefore) {
  replay_is_saved_ = true;
  for (const std::uint64_t round : {1, 3}) {
    checkpointer_.begin(state_after(round));
    complete();
  }
  const std::vector<ReplayRequest> asked = server_.end();
  ASSERT_EQ(asked.size(), 2u);
  const Save first = std::get<Save>(asked[0]), second = std::get<Save>(asked[1]);
  EXPECT_EQ(first.previous, "");
  EXPECT_EQ(second.previous, of(1).string());
  EXPECT_EQ(std::filesystem::path(second.directory).parent_path(), directory_.checkpoints());
  EXPECT_NE(first.directory, second.directory);
}

TEST_F(CheckpointerTest, OneThatCannotBeWrittenIsAFailureAndLeavesTheOneBefore) {
  replay_is_saved_ = true;
  checkpointer_.begin(state_after(1));
  complete();
  replay_is_saved_ = false;
  checkpointer_.begin(state_after(2));
  // Somebody takes away what is being written.
  const std::filesystem::path partial = directory_.checkpoints() / "2.partial";
  std::error_code still_being_filled;
  while (std::filesystem::exists(partial)) std::filesystem::remove_all(partial, still_being_filled);
  replay_is_saved_ = true;
  EXPECT_THROW(complete(), Failure);
  EXPECT_EQ(checkpoints_.newest(), of(1));
}

TEST_F(CheckpointerTest, OneThatIsGivenUpNeverIsThere) {
  {
    Checkpointer given_up(config_, checkpoints_, replay_);
    given_up.begin(state_after(1));
  }
  EXPECT_EQ(checkpoints_.newest(), std::nullopt);
}

}  // namespace
}  // namespace corridor::learner
