// SPDX-License-Identifier: Apache-2.0
// What is said of each key of a scenario beside its value and range.
#pragma once

#include <cstddef>
#include <optional>

namespace corridor {

// Who goes by a key. A table's keys are alike unless one of them says otherwise.
enum class Heeds {
  kTraining,    // the trained planners, which drive as it says in every world
  kWorld,       // the world: an evaluation in another one takes that one's
  kEvaluation,  // the evaluation alone, and it takes that of the world it drives in
  kRun,         // nobody but the processes among each other
};

// Whether a training's result depends on it: it may not change in the middle of a run.
constexpr bool decides_result(Heeds heeds) {
  return heeds == Heeds::kTraining || heeds == Heeds::kWorld;
}
// Whether an evaluation in another world takes that world's value.
constexpr bool set_by_world(Heeds heeds) {
  return heeds == Heeds::kWorld || heeds == Heeds::kEvaluation;
}

struct ConfigKey {
  const char* name;
  const char* comment = "";
  std::optional<Heeds> heeds = {};  // its table's, unless given
};

// How many values a list has, ends included.
struct ListSize {
  std::size_t low = 0;
  std::size_t high = 0;
};

}  // namespace corridor
