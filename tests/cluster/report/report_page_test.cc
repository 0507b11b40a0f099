// SPDX-License-Identifier: Apache-2.0
#include "cluster/report/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/settings/schedule.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::Not;

EvaluationRecord result(const char* planner, std::uint64_t seed, std::int64_t steps) {
  EvaluationRecord result;
  result.planner = planner;
  result.seed = seed;
  result.steps = steps;
  result.episodes = 1;
  result.mean_speed_kph = 36.0;
  result.distance_km = 0.01 * static_cast<double>(steps);
  result.per_episode = {{steps, 500.0, 800.0, 0, 9, 2, 10.0 * static_cast<double>(steps), {steps}}};
  return result;
}

RunRecord record(std::uint64_t seed) {
  RunRecord run;
  run.root = "runs/a b";
  run.config.run.seed = seed;
  run.made_with = {{"cpu", "<fast>"}, {"sumo", "1.15.0"}};
  run.rounds_done = Schedule(run.config).rounds();
  run.fingerprint = "0123456789abcdef";
  return run;
}

TEST(RepeatingCommands, TrainAndEvaluateAsTheRunWas) {
  RunRecord run = record(1);
  run.evaluations[""] = {result("sumo", 2, 400), result("rules", 1, 400), result("rules", 2, 400),
                         result("hierarchical", 2, 400)};
  run.evaluations["dense"] = {result("sumo", 1, 100)};
  EXPECT_EQ(repeating_commands(run),
            "corridor train 'runs/a b/config.toml' --run 'a b-again'\n"
            "corridor fingerprint 'a b-again'    # 0123456789abcdef\n"
            "corridor evaluate 'a b-again' --planners rules --seeds 1,2 --steps 400\n"
            "corridor evaluate 'a b-again' --planners hierarchical,sumo --seeds 2 --steps 400\n"
            "cp 'runs/a b/scenarios/dense/config.toml' dense.toml\n"
            "corridor evaluate 'a b-again' --scenario dense.toml --planners sumo --seeds 1 --steps "
            "100\n");
  run.rounds_done = 3;
  EXPECT_THAT(repeating_commands(run), Not(HasSubstr("fingerprint")))
      << "of an unfinished training";
}

TEST(ReportPage, HoldsRunsFiguresTablesAndSettings) {
  RunRecord run = record(1), other = record(2);
  run.evaluations[""] = {result("rules", 1, 1000)};
  run.worlds[""] = run.config;
  other.worlds["dense"].traffic.vehicles_max = 77;
  other.evaluations["dense"] = {result("sumo", 1, 1000)};
  other.config.dqn[0].gamma = 0.5;
  const std::string page = report_page(
      {{"paper", {run}}, {"paper (2)", {other}}},
      {{"x", "what <it> shows", "<?xml version=\"1.0\"?>\n<!DOCTYPE svg>\n<svg id=\"x\"/>", ""}},
      {{"y", "how it drives", "<svg id=\"y\"/>", ""}});
  for (const char* part : {"corridor: paper, paper (2)", "0123456789abcdef", "<svg id=\"x\"/>",
                           "what &lt;it&gt; shows", "how it drives", "Sums per 1000 steps",
                           "paper (2), driving in dense", "Table I", "&lt;fast&gt;", "1.15.0",
                           "gamma = 0.97", "mop.gamma = 0.5    # 0.97 in the first", "1,400,832"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  for (const char* foreign : {"http://", "https://", "<script", "src=", "<?xml"}) {
    EXPECT_THAT(page, Not(HasSubstr(foreign))) << "the page needs nothing else";
  }
}

TEST(ReportPage, SaysHowFarATrainingIsThatIsNotComplete) {
  RunRecord run = record(1);
  run.rounds_done = 10;
  run.fingerprint.reset();
  const std::string page = report_page({{"paper", {run}}}, {}, {});
  EXPECT_THAT(page, HasSubstr("5,120 of 1,400,832"));
  EXPECT_THAT(page, HasSubstr("None yet"));
}

}  // namespace
}  // namespace corridor::cluster
