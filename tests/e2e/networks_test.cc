// Networks that go from one run to another: `export`, `evaluate` of what it wrote, `train --from`.
#include <gmock/gmock.h>

#include "proto/base/json.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/e2e/run_support.h"

namespace corridor::e2e {
namespace {

using testing::HasSubstr;

TEST(Networks, OfATrainedRunDriveElsewhereAndAreTrainedOnReproducibly) {
  TemporaryDirectory temporary;
  const auto run = temporary.path() / "run", exported = temporary.path() / "exported";
  ASSERT_EQ(run_command(train_command(run), kDeadline_s).status, 0);
  const CommandResult copied = run_command({kCorridor, "export", run, exported}, kDeadline_s);
  ASSERT_EQ(copied.status, 0) << copied.output;
  EXPECT_EQ(Json::parse(read_file(exported / "manifest.json"))["fingerprint"].get<std::string>(),
            fingerprint(run));
  // As a version control system would bring it.
  for (const char* empty : {"sumo", "log", "metrics", "checkpoints", "evaluation"}) {
    std::filesystem::remove_all(exported / empty);
  }
  const std::vector<std::string> how = {"--planners", "hierarchical", "--seeds",
                                        "5",          "--steps",      "300"};
  for (const auto& directory : {run, exported}) {
    std::vector<std::string> command = {kCorridor, "evaluate", directory};
    command.insert(command.end(), how.begin(), how.end());
    const CommandResult evaluated = run_command(command, kDeadline_s);
    ASSERT_EQ(evaluated.status, 0) << evaluated.output;
  }
  EXPECT_EQ(read_file(run / "evaluation" / "hierarchical_5.json"),
            read_file(exported / "evaluation" / "hierarchical_5.json"));
  const CommandResult resumed = run_command({kCorridor, "resume", exported}, kDeadline_s);
  EXPECT_EQ(resumed.status, 1);
  EXPECT_THAT(resumed.output, HasSubstr("is an exported run"));

  // Trained on, the MoP under the learned BP; once in one go, once interrupted.
  const auto on = temporary.path() / "on", broken = temporary.path() / "broken";
  const std::vector<std::string> from = {"--from", exported, "--set",
                                         "schedule.mop_commands=learned"};
  ASSERT_EQ(run_command(train_command(on, from), kDeadline_s).status, 0);
  {
    Command started(train_command(broken, from));
    while (!std::filesystem::exists(broken / "checkpoints") ||
           std::filesystem::is_empty(broken / "checkpoints")) {
      ASSERT_TRUE(started.read_for(0.05));
    }
    started.signal(SIGKILL);
    started.finish(kDeadline_s);
  }
  ASSERT_EQ(run_command({kCorridor, "resume", broken}, kDeadline_s).status, 0);
  EXPECT_EQ(fingerprint(on), fingerprint(broken));
  EXPECT_NE(fingerprint(on), fingerprint(run));
}

TEST(Networks, WrongOnesAreRefusedBeforeTrainingBegins) {
  TemporaryDirectory temporary;
  const auto run = temporary.path() / "run";
  const auto refusal = [&](const std::vector<std::string>& further) {
    const CommandResult result = run_command(train_command(run, further), kDeadline_s);
    EXPECT_EQ(result.status, 1) << result.output;
    EXPECT_EQ(lines_in(result.output), 1) << result.output;
    EXPECT_FALSE(std::filesystem::exists(run));
    return result.output;
  };
  EXPECT_THAT(refusal({"--set", "schedule.mop_commands=learned"}), HasSubstr("--from"));
  EXPECT_THAT(refusal({"--from", temporary.path() / "none"}), HasSubstr("is no run directory"));
}

}  // namespace
}  // namespace corridor::e2e
