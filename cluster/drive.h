// SPDX-License-Identifier: Apache-2.0
// `corridor drive`: an episode for people to look at.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "cluster/evaluation_world.h"

namespace corridor::cluster {

struct DriveOptions {
  std::filesystem::path run = {};
  EvaluationWorld world = {};  // with neither: the run's own
  std::string planner = "hierarchical";
  std::optional<std::uint64_t> seed = {};  // of the traffic; else the first of [evaluation] seeds
  std::uint64_t number = 0;                // which episode of the seed
  std::string episode = {};                // a recorded one instead: a file, or a name
  bool collisions = false;                 // the planner's in its evaluations, instead
  int most = 12;                           // of them
  double from_s = 0.0;                     // after the episode's start
  double seconds = 60.0;
  double interval_s = 2.0;         // between the contact sheet's instants
  std::filesystem::path out = {};  // folder; empty: drives/ where the world's results are
  bool film = true;
};

// Drives an episode, a recorded one, or the last seconds before each collision of an evaluation,
// and writes NAME.mp4, NAME.png (a contact sheet) and NAME.html (a player). Returns the exit
// status. Throws Failure when there is no such episode or collision, and when a program fails.
int drive(const DriveOptions& options);

}  // namespace corridor::cluster
