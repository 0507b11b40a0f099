// SPDX-License-Identifier: Apache-2.0
// What corridor-actor can be asked, and how far it says it is: tasks <-> its command line, which is
//
//   corridor-actor COMMAND RUN OPTIONS...
//
// A task names its command and each of its options once, for both directions. Those that may be
// left out are std::optional.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "proto/run/hindsight_record.h"
#include "proto/run/run_directory.h"

namespace corridor {

// Be an actor of a training.
struct TrainTask {
  static constexpr const char* kCommand = "train";
  int index = 0;

  template <typename Self, typename Option>
  static void options(Self& self, Option option) {
    option("--index", self.index, "as which actor, from 0");
  }
  bool operator==(const TrainTask&) const = default;
};

// Drive a planner pair greedily on the test episodes of a seed.
struct EvaluateTask {
  static constexpr const char* kCommand = "evaluate";
  std::string planner;
  std::uint64_t seed = 0;  // of the traffic; says nothing about training
  std::int64_t steps = 0;  // the last episode is cut off there
  std::optional<std::filesystem::path> networks = {};
  std::optional<std::filesystem::path> fcd = {};

  template <typename Self, typename Option>
  static void options(Self& self, Option option) {
    option("--planner", self.planner, "planner pair");
    option("--seed", self.seed, "of the traffic");
    option("--steps", self.steps, "to drive");
    option("--networks", self.networks, "run directory whose networks drive, if not RUN");
    option("--fcd", self.fcd, "directory that SUMO writes its trajectories to");
  }
  bool operator==(const EvaluateTask&) const = default;
};

// Drive a recorded episode again and say whether it is as recorded.
struct RedriveTask {
  static constexpr const char* kCommand = "redrive";
  std::filesystem::path episode;
  std::optional<std::filesystem::path> fcd = {};

  template <typename Self, typename Option>
  static void options(Self& self, Option option) {
    option("--episode", self.episode, "its file");
    option("--fcd", self.fcd, "file that SUMO writes its trajectories to");
  }
  bool operator==(const RedriveTask&) const = default;
};

// Drive a recorded episode again and print every step (proto/run/episode_trace.h).
struct TraceTask {
  static constexpr const char* kCommand = "trace";
  std::filesystem::path episode;
  std::optional<std::filesystem::path> networks = {};

  template <typename Self, typename Option>
  static void options(Self& self, Option option) {
    option("--episode", self.episode, "its file");
    option("--networks", self.networks,
           "run directory of the networks that drove, for their values");
  }
  bool operator==(const TraceTask&) const = default;
};

// Drive a planner pair in an episode of a seed and print every step.
struct DriveTask {
  static constexpr const char* kCommand = "drive";
  std::string planner;
  std::uint64_t seed = 0;
  std::uint64_t index = 0;
  std::int64_t steps = 0;
  std::optional<std::filesystem::path> networks = {};

  template <typename Self, typename Option>
  static void options(Self& self, Option option) {
    option("--planner", self.planner, "planner pair");
    option("--seed", self.seed, "of the traffic");
    option("--index", self.index, "which episode of the seed, from 0");
    option("--steps", self.steps, "to drive, at most");
    option("--networks", self.networks, "run directory whose networks drive, if not RUN");
  }
  bool operator==(const DriveTask&) const = default;
};

// Search how the collisions of an evaluation could have been avoided.
struct LookBackTask {
  static constexpr const char* kCommand = "look-back";
  std::string planner;
  std::uint64_t seed = 0;
  HindsightLimits limits;
  std::optional<std::filesystem::path> evaluated = {};

  template <typename Self, typename Option>
  static void options(Self& self, Option option) {
    option("--planner", self.planner, "planner pair");
    option("--seed", self.seed, "of the evaluation");
    option("--actions", self.limits.actions, "by the last so many actions");
    option("--attempts", self.limits.attempts_max, "at most, for each number of actions");
    option("--evaluated", self.evaluated, "run directory whose evaluation it is, if not RUN");
  }
  bool operator==(const LookBackTask&) const = default;
};

using ActorTask =
    std::variant<TrainTask, EvaluateTask, RedriveTask, TraceTask, DriveTask, LookBackTask>;

// What follows the program's name.
std::vector<std::string> argv_of(const ActorTask& task, const RunDirectory& run);

struct ActorCommand {
  std::filesystem::path run;
  ActorTask task;
};
// The inverse, argv[0] being the program; or the exit status where that is all there is to do
// (--help). Throws Failure for no task, for more than one, and for what is missing or wrong.
std::variant<ActorCommand, int> parse_actor_command(int argc, const char* const* argv);

// What an actor prints, a line each time, while it evaluates or looks back: "300/1000".
std::string step_count(std::int64_t done, std::int64_t total);
// How many are done; nothing when the text is no such line.
std::optional<std::int64_t> parse_step_count(std::string_view text);

}  // namespace corridor
