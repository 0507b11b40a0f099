// SPDX-License-Identifier: Apache-2.0
// The whole system on two cores: two actors in real SUMO traffic, the replay server, the learner.
#include "proto/base/json.h"
#include "proto/run/run_directory.h"
#include "proto/system/test_delay.h"
#include "tests/e2e/run_support.h"
#include "tests/support/golden.h"

namespace corridor::e2e {
namespace {

TEST(Training, TrainsBothPlannersEvaluatesThemAndDrivesTheirEpisodesAgain) {
  TemporaryDirectory temporary;
  const auto run = temporary.path() / "run";
  const auto shared_memory = shared_memory_files();
  const CommandResult trained = run_command(train_command(run), kDeadline_s);
  ASSERT_EQ(trained.status, 0) << trained.output;
  expect_nothing_left(run);

  const auto table = temporary.path() / "table.json";
  const auto fcd = temporary.path() / "fcd";
  const CommandResult evaluated = run_command({kCorridor, "evaluate", run, "--steps", "300",
                                               "--seeds", "5,6", "--json", table, "--fcd", fcd},
                                              kDeadline_s);
  ASSERT_EQ(evaluated.status, 0) << evaluated.output;
  expect_nothing_left(run);
  EXPECT_EQ(shared_memory_files(), shared_memory);

  const Json rows = Json::parse(std::ifstream(table));
  ASSERT_EQ(rows.size(), 10u);
  for (const Json& row : rows) {
    EXPECT_EQ(row.at("steps"), 300) << row;
    const double distance_km = row.at("distance_km").get<double>();
    EXPECT_NEAR(row.at("mean_speed_kph").get<double>(), distance_km / (300.0 / 3600.0), 1e-6)
        << row;
    // What a few thousand steps of training teach is a matter of luck, so only the others' is
    // asked.
    const bool learned = row.at("planner") != "rules" && row.at("planner") != "sumo";
    EXPECT_GT(distance_km, learned ? 0.0 : 2.0) << row;
    for (const char* key : {"planner", "seed", "episodes", "bp_reward_per_1000", "collisions",
                            "collisions_by_kind", "lane_changes"}) {
      EXPECT_TRUE(row.contains(key)) << key;
    }
    EXPECT_NE(evaluated.output.find(row.at("planner").get<std::string>()), std::string::npos);
  }

  const CommandResult redriven =
      run_command({kCorridor, "redrive", run, "hierarchical_5_0"}, kDeadline_s);
  EXPECT_EQ(redriven.status, 0) << redriven.output;
  EXPECT_NE(redriven.output.find("as recorded"), std::string::npos) << redriven.output;
  EXPECT_TRUE(std::filesystem::exists(fcd / "rules_6_0.fcd.xml"));

  EXPECT_GT(std::filesystem::file_size(run / "tensorboard" / "events.out.tfevents.000001"), 1000u);
  const CommandResult reported = run_command({kCorridor, "report", run}, kDeadline_s);
  EXPECT_EQ(reported.status, 0) << reported.output;
  for (const char* file :
       {"report.html", "mop_training.svg", "bp_training.png", "episodes_hierarchical.png"}) {
    EXPECT_TRUE(std::filesystem::exists(run / "report" / file)) << file;
  }

  const std::vector<std::string> look_back = {
      kCorridor, "hindsight", run, "--seeds", "5,6", "--planners", "hierarchical,rules"};
  const auto in_hindsight = [&] {
    const CommandResult result = run_command(look_back, kDeadline_s);
    EXPECT_EQ(result.status, 0) << result.output;
    EXPECT_NE(result.output.find("floor"), std::string::npos) << result.output;
    expect_nothing_left(run);
    std::string all;
    for (const char* name : {"hierarchical_5", "hierarchical_6", "rules_5", "rules_6"}) {
      std::ostringstream text;
      text << std::ifstream(run / "evaluation" / "hindsight" / (std::string(name) + ".json"))
                  .rdbuf();
      EXPECT_FALSE(text.str().empty()) << name;
      all += text.str();
    }
    return all;
  };
  const std::string first_time = in_hindsight();
  std::filesystem::remove_all(run / "evaluation" / "hindsight");
  EXPECT_EQ(in_hindsight(), first_time);

  // Nothing is left to do.
  const CommandResult again = run_command({kCorridor, "resume", run}, kDeadline_s);
  EXPECT_EQ(again.status, 0) << again.output;
}

// A test's last statement: skips it where none is on record.
void expect_golden_fingerprint(const std::filesystem::path& run) {
  const auto libraries = testing_support::libraries_of(run);
  const auto golden = testing_support::golden_fingerprint(libraries);
  if (!golden) GTEST_SKIP() << testing_support::no_record(libraries, fingerprint(run));
  EXPECT_EQ(fingerprint(run), *golden);
}

TEST(Training, GivesTheSameBitsOnEveryMachine) {
  TemporaryDirectory temporary;
  const auto run = temporary.path() / "run";
  const CommandResult result = run_command(train_command(run), kDeadline_s);
  ASSERT_EQ(result.status, 0) << result.output;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {  // learner/blas.h
    EXPECT_EQ(testing_support::libraries_of(run).kernels, "Haswell");
  }
  expect_golden_fingerprint(run);
}

TEST(Training, GoesOnWithTheSameBitsWhereTheCalendarsClockRunsBackwards) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer wants to be the first library";
#endif
  TemporaryDirectory temporary;
  const auto run = temporary.path() / "run";
  // Slowed, so that there is something to kill.
  Command training(train_command(run),
                   {{"LD_PRELOAD", CORRIDOR_BACKWARD_CLOCK}, {kTestDelayVariable, "100"}});
  ASSERT_TRUE(training.wait_for("MoP", 60.0));
  for (const auto& [program, consequence] :
       {std::pair{kActorProgram, "; started again"}, {kLearnerProgram, "; all go on from"}}) {
    for (const auto& process : processes_with(run)) {
      if (process.command_line.find(program) == std::string::npos) continue;
      kill(process.pid, SIGKILL);
      break;
    }
    EXPECT_TRUE(training.wait_for(consequence, 60.0)) << program;
  }
  const CommandResult result = training.finish(kDeadline_s);
  ASSERT_EQ(result.status, 0) << result.output;
  expect_golden_fingerprint(run);
}

TEST(Training, TwiceTheSameSeedGivesTheSameBitsAlsoWhenProcessesAreSlowedAtRandom) {
  TemporaryDirectory temporary;
  const auto first = temporary.path() / "first";
  const auto slowed = temporary.path() / "slowed";
  const auto other = temporary.path() / "other";
  const CommandResult first_result = run_command(train_command(first), kDeadline_s);
  ASSERT_EQ(first_result.status, 0) << first_result.output;
  const CommandResult slowed_result =
      run_command(train_command(slowed), kDeadline_s, {{kTestDelayVariable, "60"}});
  ASSERT_EQ(slowed_result.status, 0) << slowed_result.output;
  EXPECT_EQ(fingerprint(first), fingerprint(slowed));

  ASSERT_EQ(run_command(train_command(other, {}, "4"), kDeadline_s).status, 0);
  EXPECT_NE(fingerprint(first), fingerprint(other));
}

TEST(Training, InterruptedAndResumedItEndsWithTheSameBits) {
  TemporaryDirectory temporary;
  const auto whole = temporary.path() / "whole";
  const auto parts = temporary.path() / "parts";
  ASSERT_EQ(run_command(train_command(whole), kDeadline_s).status, 0);

  // Slowed, so that there is something to interrupt. Twice: in the first phase and in the second.
  int interruptions = 0;
  for (const char* phase : {"\"MoP\"", "\"BP\""}) {
    Command command(phase == std::string("\"MoP\"")
                        ? train_command(parts)
                        : std::vector<std::string>{kCorridor, "resume", parts},
                    {{kTestDelayVariable, "100"}});
    const auto metrics = parts / "metrics" / "learner.jsonl";
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    std::string text;
    while (text.find(phase) == std::string::npos && std::chrono::steady_clock::now() < deadline) {
      command.wait_for("never printed", 0.05);
      std::ifstream in(metrics);
      text.assign((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    }
    command.signal(SIGINT);
    const CommandResult result = command.finish(kDeadline_s);
    EXPECT_EQ(result.status, 130) << result.output;
    interruptions += result.status == 130;
    expect_nothing_left(parts);
  }
  ASSERT_EQ(interruptions, 2);
  // Events that cannot be written are said once, and hinder nothing.
  std::filesystem::rename(parts / "tensorboard", parts / "earlier");
  std::ofstream(parts / "tensorboard") << "in the way";
  const CommandResult resumed = run_command({kCorridor, "resume", parts}, kDeadline_s);
  ASSERT_EQ(resumed.status, 0) << resumed.output;
  const std::size_t warning = resumed.output.find("goes on without events");
  EXPECT_NE(warning, std::string::npos) << resumed.output;
  EXPECT_EQ(warning, resumed.output.rfind("goes on without events")) << resumed.output;
  EXPECT_EQ(fingerprint(parts), fingerprint(whole));
}

TEST(Training, WithOneActorAndWithThreeItTrainsToo) {
  TemporaryDirectory temporary;
  for (const char* actors : {"1", "3"}) {
    const auto run = temporary.path() / actors;
    const CommandResult result = run_command(train_command(run, {}, "3", actors), kDeadline_s);
    EXPECT_EQ(result.status, 0) << result.output;
    expect_nothing_left(run);
  }
}

}  // namespace
}  // namespace corridor::e2e
