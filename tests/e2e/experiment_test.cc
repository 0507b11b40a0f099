// SPDX-License-Identifier: Apache-2.0
// `corridor experiment`: stopped, killed, gone on with; refused where it would mix two experiments.
#include <gmock/gmock.h>

#include "proto/base/json.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/e2e/run_support.h"

namespace corridor::e2e {
namespace {

using testing::HasSubstr;

class Experiment : public testing::Test {
 protected:
  Experiment() {
    std::string settings;
    const std::vector<std::string> tiny = tiny_settings();
    for (std::size_t i = 1; i < tiny.size(); i += 2) {
      settings += (settings.empty() ? "\"" : ", \"") + tiny[i] + "\"";
    }
    write_file(file_,
               "planners = [\"hierarchical\", \"rules\"]\n"
               "training_seeds = [1, 2]\n"
               "evaluation_seeds = [5, 6]\n"
               "evaluation_steps = 200\n"
               "[[training]]\n"
               "name = \"tiny\"\n"
               "scenario = \"" +
                   kSmoke +
                   "\"\n"
                   "settings = [" +
                   settings +
                   "]\n"
                   "evaluate_in = [\"" +
                   kSmoke + "\"]\n");
  }
  std::vector<std::string> command(const std::filesystem::path& directory) const {
    return {kCorridor, "experiment", file_, "--run", directory};
  }

  TemporaryDirectory temporary_;
  std::filesystem::path file_ = temporary_.path() / "experiment.toml";
};

TEST_F(Experiment, KilledAndStoppedItGoesOnAndGivesTheSameResults) {
  const auto whole = temporary_.path() / "whole", broken = temporary_.path() / "broken";
  const CommandResult undisturbed = run_command(command(whole), kDeadline_s);
  ASSERT_EQ(undisturbed.status, 0) << undisturbed.output;
  EXPECT_THAT(undisturbed.output, HasSubstr("tiny, evaluated in smoke"));
  expect_nothing_left(whole);

  for (const int signal : {SIGKILL, SIGTERM}) {
    Command started(command(broken));
    const auto seen = broken / "runs" / (signal == SIGKILL ? "tiny-1" : "tiny-2") / "checkpoints";
    ASSERT_TRUE(eventually([&] { return std::filesystem::exists(seen); }, 60.0)) << seen;
    started.signal(signal);
    const CommandResult stopped = started.finish(kDeadline_s);
    EXPECT_EQ(stopped.status, 128 + signal) << stopped.output;
    EXPECT_EQ(stopped.output.find("go on with the same command") != std::string::npos,
              signal == SIGTERM);
    EXPECT_TRUE(eventually([&] { return processes_with(broken.string()).empty(); }, 20.0));
  }
  const CommandResult done = run_command(command(broken), kDeadline_s);
  ASSERT_EQ(done.status, 0) << done.output;
  expect_nothing_left(broken);
  for (const char* file : {"results.md", "results.json"}) {
    EXPECT_EQ(read_file(broken / file), read_file(whole / file));
  }
  // Rules learn nothing: driven beside the first training seed only.
  EXPECT_EQ(Json::parse(read_file(whole / "results.json")).size(), 2u * 2 + 2);

  const CommandResult again = run_command(command(broken), kDeadline_s);
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_LT(again.seconds, undisturbed.seconds / 2) << "everything was there";

  write_file(file_, read_file(file_) + "# changed\n");
  const CommandResult other = run_command(command(broken), kDeadline_s);
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.output, HasSubstr("holds another experiment"));
  EXPECT_EQ(lines_in(other.output), 1) << other.output;
}

}  // namespace
}  // namespace corridor::e2e
