#include "proto/settings/planner_pairs.h"

#include <string>

#include "proto/base/failure.h"

namespace corridor {

const PlannerPair& planner_pair(std::string_view name) {
  std::string known;
  for (const PlannerPair& pair : kPlannerPairs) {
    if (pair.name == name) return pair;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", pair.name);
  }
  throw Failure("there is no planner '{}'; choose among {}", name, known);
}

}  // namespace corridor
