// SPDX-License-Identifier: Apache-2.0
// What the end-to-end tests share: the command, tiny budgets, and looking for what was left behind.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/command.h"
#include "tests/support/processes.h"
#include "tests/support/temporary_directory.h"

namespace corridor::e2e {

using testing_support::Command;
using testing_support::CommandResult;
using testing_support::processes_with;
using testing_support::run_command;
using testing_support::TemporaryDirectory;

inline const std::string kCorridor = std::string(CORRIDOR_BIN_DIR) + "/corridor";
inline const std::string kSmoke = std::string(CORRIDOR_SOURCE_DIR) + "/scenarios/smoke.toml";
// Bounds a hang and nothing else: longer than any of these commands takes beside much else.
inline constexpr double kDeadline_s = 900.0;

// smoke.toml, small enough for a test: both phases, a few selections and checkpoints.
inline std::vector<std::string> tiny_settings() {
  std::vector<std::string> arguments;
  for (const char* setting :
       {"mop.steps=4000", "bp.steps=3000", "mop.minimum_size=500", "bp.minimum_size=500",
        "mop.epsilon_steps=2000", "bp.epsilon_steps=1500", "simulation.episode_steps=200",
        "schedule.steps_per_round=64", "schedule.selection_every_steps=2000",
        "schedule.selection_episodes=4", "schedule.checkpoint_every_steps=1500"}) {
    arguments.insert(arguments.end(), {"--set", setting});
  }
  return arguments;
}

inline std::vector<std::string> train_command(const std::filesystem::path& run,
                                              const std::vector<std::string>& further = {},
                                              const std::string& seed = "3",
                                              const std::string& actors = "2") {
  std::vector<std::string> arguments = {kCorridor,  "train", kSmoke,   "--run", run,
                                        "--actors", actors,  "--seed", seed};
  for (const auto& argument : tiny_settings()) arguments.push_back(argument);
  arguments.insert(arguments.end(), further.begin(), further.end());
  return arguments;
}

inline std::string fingerprint(const std::filesystem::path& run) {
  const CommandResult result = run_command({kCorridor, "fingerprint", run}, kDeadline_s);
  EXPECT_EQ(result.status, 0) << result.output;
  return result.output.substr(0, result.output.find('\n'));
}

// Nothing of a run may outlive its command: no process, no socket or temporary file in the run
// directory, no shared memory.
inline void expect_nothing_left(const std::filesystem::path& run) {
  for (const auto& process : processes_with(run.string())) ADD_FAILURE() << process.command_line;
  if (!std::filesystem::exists(run)) return;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(run)) {
    EXPECT_FALSE(entry.is_socket()) << entry.path();
    EXPECT_EQ(entry.path().string().find(".tmp"), std::string::npos) << entry.path();
    EXPECT_FALSE(entry.path().string().ends_with(".partial")) << entry.path();
  }
}

inline std::set<std::string> shared_memory_files() {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm")) {
    files.insert(entry.path());
  }
  return files;
}

// Whether it comes true within `seconds`. Looks again and again: other processes tell nobody.
inline bool eventually(const std::function<bool()>& condition, double seconds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

inline int lines_in(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace corridor::e2e
