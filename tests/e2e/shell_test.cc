// SPDX-License-Identifier: Apache-2.0
// What a shell's user takes for granted: paths of any name, pipes and links, signals, job control,
// several commands at a time, output that is lost.
#include <gmock/gmock.h>

#include <csignal>

#include "proto/base/json.h"
#include "proto/run/checkpoints.h"
#include "proto/run/manifest.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "proto/system/test_delay.h"
#include "tests/e2e/run_support.h"

namespace corridor::e2e {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

const fs::path kTrained = fs::path(CORRIDOR_SOURCE_DIR) / "scenarios/trained/paper";
const std::string kSparse = std::string(CORRIDOR_SOURCE_DIR) + "/scenarios/sparse.toml";

class Shell : public testing::Test {
 protected:
  // Where results of exported runs go.
  Shell() { fs::current_path(temporary_.path()); }
  ~Shell() override {
    expect_nothing_left(temporary_.path());
    fs::current_path("/");
  }

  // $corridor is the command, $trained the networks of the repository; neither is split at spaces.
  CommandResult shell(const std::string& script) const {
    return run_command(
        {"/bin/bash", "-c", "IFS=; " + script}, kDeadline_s,
        {{"corridor", kCorridor}, {"trained", kTrained}, {"smoke", kSmoke}, {"sparse", kSparse}});
  }
  // One that goes on until it is ended.
  Command start_long_training(const std::vector<std::string>& further = {}) const {
    std::vector<std::string> settings = {"--set", "mop.steps=100000000"};
    settings.insert(settings.end(), further.begin(), further.end());
    return Command(train_command(run_, settings));
  }
  bool all_stopped(bool stopped) const {
    const auto processes = processes_with(run_.string());
    return processes.size() == 5 && std::ranges::all_of(processes, [&](const auto& process) {
             return testing_support::is_stopped(process.pid) == stopped;
           });
  }
  // One line that says what is wrong, and the status of a failure.
  static void expect_failure(const CommandResult& result, const std::string& hint) {
    EXPECT_EQ(result.status, 1) << result.output;
    EXPECT_THAT(result.output, HasSubstr(hint));
    EXPECT_EQ(lines_in(result.output.substr(result.output.rfind("error: "))), 1) << result.output;
  }

  TemporaryDirectory temporary_;
  fs::path run_ = temporary_.path() / "run";
};

TEST_F(Shell, PathsOfAnyNameWork) {
  const fs::path folder = temporary_.path() / "lr=0.1,seed=2 2025-01-02_12:30:00 ${HOME}x 50%d ü'";
  fs::create_directories(folder);
  const fs::path run = folder / "-run,:%03d", scenario = folder / "a:b,c.toml";
  fs::copy(kSmoke, scenario);
  fs::copy(fs::path(kSmoke).parent_path() / "paper.toml", folder / "paper.toml");
  std::vector<std::string> train = train_command(run);
  train[2] = scenario;
  const CommandResult trained = run_command(train, kDeadline_s);
  ASSERT_EQ(trained.status, 0) << trained.output;
  EXPECT_THAT(trained.output, HasSubstr("evaluate '")) << "what comes next can be pasted";
  for (const auto& command : std::vector<std::vector<std::string>>{
           {"evaluate", run, "--steps", "50", "--fcd", folder / "fcd,out", "--json",
            folder / "a,b:c.json"},
           {"evaluate", run, "--scenario", scenario, "--steps", "50", "--planners", "rules"},
           {"drive", run, "--seconds", "3", "--out", folder / "drives,%d"},
           {"hindsight", run, "--planners", "rules"},
           {"redrive", run, "rules_1002_0"},
           {"report", run},
           {"export", run, folder / "exported:1"},
           {"resume", run}}) {
    std::vector<std::string> whole = {kCorridor};
    whole.insert(whole.end(), command.begin(), command.end());
    const CommandResult result = run_command(whole, kDeadline_s);
    EXPECT_EQ(result.status, 0) << command.front() << ": " << result.output;
  }
  EXPECT_TRUE(fs::exists(folder / "fcd,out" / "rules_1002_0.fcd.xml"));
  EXPECT_GT(fs::file_size(folder / "drives,%d" / "hierarchical_1002_0.mp4"), 10'000u);
  // Renamed, it is the run that it was.
  fs::rename(run, folder / "other, name");
  EXPECT_EQ(run_command({kCorridor, "resume", folder / "other, name"}, kDeadline_s).status, 0);
}

TEST_F(Shell, SixEvaluationsAtATimeAllSucceedAndLoseNothing) {
  const CommandResult result = shell(
      "for i in 1 2 3 4 5 6; do\n"
      "$corridor evaluate $trained --planners rules --seeds $i --steps 60 --jobs 1 "
      "--scenario $sparse > $i.txt 2>&1 &\n"
      "ids+=($!)\n"
      "done\n"
      "for id in ${ids[@]}; do wait $id || { echo $? of $id; cat *.txt; }; done");
  EXPECT_EQ(result.output, "");
  for (int seed = 1; seed <= 6; ++seed) {
    EXPECT_TRUE(fs::exists(temporary_.path() / "evaluated/paper/scenarios/sparse/evaluation" /
                           ("rules_" + std::to_string(seed) + ".json")));
  }
}

TEST_F(Shell, NothingIsWrittenBesideExportedNetworks) {
  const auto files = [] {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(kTrained)) names.insert(entry.path());
    return names;
  };
  const auto before = files();
  for (const std::string& command : std::vector<std::string>{
           "$corridor evaluate $trained --planners rules,hierarchical --steps 60",
           "$corridor evaluate $trained --planners rules --steps 60 --scenario $sparse",
           "$corridor hindsight $trained --planners rules",
           "$corridor drive $trained --seconds 3 --no-film",
           "$corridor redrive evaluated/paper rules_1002_0", "$corridor report $trained",
           "$corridor evaluate $trained --planners rules --steps 60 --out elsewhere",
           "$corridor hindsight elsewhere --planners rules --out third"}) {
    const CommandResult result = shell(command);
    EXPECT_EQ(result.status, 0) << command << ": " << result.output;
  }
  EXPECT_EQ(files(), before);
  EXPECT_EQ(read_file("elsewhere/evaluation/rules_1002.json"),
            read_file("evaluated/paper/evaluation/rules_1002.json"));
  EXPECT_TRUE(fs::exists("third/evaluation/hindsight/rules_1002.json"));
  EXPECT_FALSE(fs::exists("elsewhere/evaluation/hindsight"));
}

TEST_F(Shell, PipesLinksAndStandardOutputTakeJson) {
  const std::string evaluate = "$corridor evaluate $trained --planners rules --steps 60 --json ";
  const auto rows = [](const std::string& text) {
    const Json json = Json::parse(text, nullptr, false);
    return json.is_array() ? json.size() : 0;
  };
  const CommandResult out = shell(evaluate + "- 2> table.txt");
  EXPECT_EQ(rows(out.output), 1u) << out.output;
  EXPECT_THAT(read_file("table.txt"), HasSubstr("rules"));
  EXPECT_EQ(rows(shell(evaluate + ">(cat > out.json) > table.txt; wait; cat out.json").output), 1u);
  EXPECT_EQ(rows(shell("mkfifo pipe; cat pipe > out.json & " + evaluate +
                       "pipe > table.txt; wait; cat out.json")
                     .output),
            1u);
  EXPECT_TRUE(fs::is_fifo("pipe"));
  EXPECT_EQ(rows(shell("ln -s target.json link; " + evaluate + "link > table.txt; cat target.json")
                     .output),
            1u);
  EXPECT_TRUE(fs::is_symlink("link"));
}

TEST_F(Shell, OutputThatIsLostIsAFailure) {
  for (const char* command : {"check $smoke", "--help", "train --help", "--version"}) {
    expect_failure(shell(std::string("$corridor ") + command + " > /dev/full"),
                   "cannot write all of standard output: No space left on device");
  }
  // SUMO's file, which may have 40 blocks and no more.
  expect_failure(shell("trap '' XFSZ; ulimit -f 40; $corridor evaluate $trained --planners rules "
                       "--steps 200 --fcd fcd"),
                 "SUMO could not write all of fcd/rules_1002_");
}

TEST_F(Shell, ClosedStreamsAreNoFilesOfTheRun) {
  std::string script = "exec";
  for (const std::string& word : train_command(run_)) script += " '" + word + "'";
  const CommandResult result = shell(script + " <&- >&- 2>&-");
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(lines_in(read_file(run_ / "lock")), 1);
  EXPECT_EQ(run_command({kCorridor, "report", run_}, kDeadline_s).status, 0);
}

TEST_F(Shell, AnEmptyFolderIsTakenForARunAndAFullOneIsNot) {
  fs::create_directories(run_);
  EXPECT_EQ(run_command(train_command(run_), kDeadline_s).status, 0);
  expect_failure(run_command(train_command(run_), kDeadline_s), "exists already");
}

TEST_F(Shell, CtrlCEndsADriveAndAReportWithoutATrace) {
  for (const auto& command : std::vector<std::vector<std::string>>{
           {"drive", kTrained, "--seconds", "1000", "--out", "out"}, {"report", run_}}) {
    if (command[0] == "report") {
      ASSERT_EQ(run_command(train_command(run_), kDeadline_s).status, 0);
      ASSERT_EQ(run_command({kCorridor, "evaluate", run_, "--steps", "400"}, kDeadline_s).status,
                0);
    }
    std::vector<std::string> script = {"/bin/bash", "-c", R"(echo begins; exec "$0" "$@")",
                                       kCorridor};
    script.insert(script.end(), command.begin(), command.end());
    Command started(script);
    ASSERT_TRUE(started.wait_for("begins", 60.0));
    // The drive is at its film then, the report wherever it is.
    if (command[0] == "drive") {
      EXPECT_TRUE(started.wait_for("film", kDeadline_s));
    }
    started.signal(SIGINT);
    const CommandResult result = started.finish(kDeadline_s);
    EXPECT_EQ(result.status, 130) << result.output;
    EXPECT_EQ(result.output.find("error"), std::string::npos) << result.output;
  }
  EXPECT_FALSE(fs::exists("out/hierarchical_1002_0.mp4"));
  EXPECT_FALSE(fs::exists(run_ / "report" / "report.html"));
}

TEST_F(Shell, NohupHoldsAndSigusr1TakesACheckpointAndEnds) {
  std::signal(SIGHUP, SIG_IGN);
  Command training = start_long_training();
  std::signal(SIGHUP, SIG_DFL);
  ASSERT_TRUE(training.wait_for("MoP", kDeadline_s));
  ASSERT_TRUE(eventually([&] { return all_stopped(false); }, kDeadline_s));
  training.signal(SIGHUP);
  EXPECT_TRUE(training.read_for(1.0)) << "it goes on";
  training.signal(SIGUSR1);
  const CommandResult result = training.finish(kDeadline_s);
  EXPECT_EQ(result.status, 128 + SIGUSR1) << result.output;
  EXPECT_THAT(result.output, HasSubstr("stopping: the learner ends its block"));
  EXPECT_THAT(result.output, HasSubstr("steps after it will be repeated"));
}

TEST_F(Shell, CtrlZStopsAllAndFgGoesOnWithAll) {
  Command training = start_long_training();
  ASSERT_TRUE(training.wait_for("MoP", kDeadline_s));
  ASSERT_TRUE(eventually([&] { return all_stopped(false); }, kDeadline_s));
  training.signal(SIGTSTP);
  EXPECT_TRUE(eventually([&] { return all_stopped(true); }, kDeadline_s));
  training.signal(SIGCONT);
  EXPECT_TRUE(eventually([&] { return all_stopped(false); }, kDeadline_s));
  training.signal(SIGINT);
  const CommandResult result = training.finish(kDeadline_s);
  EXPECT_EQ(result.status, 130) << result.output;
  EXPECT_THAT(result.output, Not(HasSubstr("started again")));
}

TEST_F(Shell, TheCheckpointThatIsPromisedIsTakenHoweverLongABlockLasts) {
  // Networks that a learner needs many seconds a block for.
  Command training = start_long_training(
      {"--set", "mop.hidden=[512,512]", "--set", "mop.samples_per_insert=200", "--set",
       "schedule.checkpoint_every_steps=1000000", "--set", "schedule.steps_per_round=256"});
  ASSERT_TRUE(eventually(
      [&] {
        return fs::exists(run_ / "log" / "learner.log") &&
               fs::exists(run_ / "metrics" / "replay.jsonl") && all_stopped(false);
      },
      kDeadline_s));
  EXPECT_TRUE(training.read_for(3.0));
  training.signal(SIGINT);
  const CommandResult result = training.finish(kDeadline_s);
  EXPECT_EQ(result.status, 130) << result.output;
  EXPECT_THAT(result.output, HasSubstr("stopped at the checkpoint of"));
  EXPECT_THAT(result.output, HasSubstr("; 0 steps after it will be repeated"));
}

TEST_F(Shell, ARunAndItsCopyGoOnAtTheSameTime) {
  {
    Command training(train_command(run_), {{kTestDelayVariable, "60"}});
    ASSERT_TRUE(eventually([&] { return Checkpoints(run_ / "checkpoints").newest().has_value(); },
                           kDeadline_s));
    training.signal(SIGKILL);
    training.finish(kDeadline_s);
  }
  ASSERT_TRUE(eventually([&] { return processes_with(run_).empty(); }, kDeadline_s));
  ASSERT_EQ(shell("cp -a run copy").status, 0);
  Command one({kCorridor, "resume", run_}), other({kCorridor, "resume", "copy"});
  const CommandResult of_copy = other.finish(kDeadline_s), of_run = one.finish(kDeadline_s);
  EXPECT_EQ(of_run.status, 0) << of_run.output;
  EXPECT_EQ(of_copy.status, 0) << of_copy.output;
  EXPECT_EQ(fingerprint(run_), fingerprint("copy"));
}

TEST_F(Shell, OtherBitsAreRefusedByNameUnlessTheyAreAskedFor) {
  const auto manifest = [&] { return read_manifest(RunDirectory::open(run_)); };
  {
    Command training(train_command(run_), {{kTestDelayVariable, "60"}});
    ASSERT_TRUE(training.wait_for("MoP", kDeadline_s));
    ASSERT_TRUE(eventually([&] { return manifest().versions.blas_core.has_value(); }, kDeadline_s));
    training.signal(SIGINT);
    EXPECT_EQ(training.finish(kDeadline_s).status, 130);
  }
  EXPECT_EQ(manifest().versions.blas_core, "Haswell");
  const std::map<std::string, std::string> other = {{"OPENBLAS_CORETYPE", "Prescott"}};
  const CommandResult refused = run_command({kCorridor, "resume", run_}, kDeadline_s, other);
  expect_failure(refused, "blas_core Haswell, and here is Prescott");
  const CommandResult allowed =
      run_command({kCorridor, "resume", run_, "--allow-other-bits"}, kDeadline_s, other);
  EXPECT_EQ(allowed.status, 0) << allowed.output;
  EXPECT_EQ(manifest().versions_now().blas_core, "Prescott");
  EXPECT_EQ(manifest().continuations.value().front().changes.front(),
            "blas_core Prescott, where it was Haswell");
}

TEST_F(Shell, ATrainingThatIsCompleteGoesOnForLongerWithTheSameBitsHoweverItIsInterrupted) {
  ASSERT_EQ(run_command(train_command(run_), kDeadline_s).status, 0);
  const std::string before = fingerprint(run_);
  ASSERT_EQ(shell("cp -a run copy").status, 0);
  const auto longer = [](const fs::path& run) {
    return std::vector<std::string>{kCorridor, "resume", run, "--set", "bp.steps=6000"};
  };
  const CommandResult result = run_command(longer(run_), kDeadline_s);
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("bp.steps = 6000, where it was 3000"));
  EXPECT_NE(fingerprint(run_), before);
  {
    Command killed(longer("copy"), {{kTestDelayVariable, "60"}});
    ASSERT_TRUE(killed.wait_for("BP", kDeadline_s));
    killed.signal(SIGKILL);
    killed.finish(kDeadline_s);
  }
  const CommandResult resumed = run_command({kCorridor, "resume", "copy"}, kDeadline_s);
  ASSERT_EQ(resumed.status, 0) << resumed.output;
  EXPECT_EQ(fingerprint("copy"), fingerprint(run_));
}

}  // namespace
}  // namespace corridor::e2e
