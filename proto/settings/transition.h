// SPDX-License-Identifier: Apache-2.0
// What actor, replay and learner must agree on about the numbers themselves: the sizes of the
// planners' observations and actions, the layout of a transition, the layout of a network's
// parameters. Plain values; no I/O.
#pragma once

#include <cstddef>
#include <vector>

namespace corridor {

// How many numbers a planner sees, and among how many actions it chooses.
struct PlannerShape {
  int observations = 0;
  int actions = 0;
  bool operator==(const PlannerShape&) const = default;
};

// The motion planner: index tables in actor/driving/observation.h and actor/driving/action.h.
// Five numbers on each corridor of one lane: whether the ego is in it, front and back gap, and
// their rates of change; speed, set-point and the BP's target speed; and for each step of
// planner.clearance_steps the clearance after six moves.
inline constexpr int kMopScalars = 3;
inline constexpr int kMopPerCorridor = 5;
inline constexpr int kMopMoves = 6;
inline PlannerShape mop_shape(int corridors_per_lane, int speed_changes, int clearance_steps) {
  return {kMopScalars + kMopPerCorridor * corridors_per_lane + kMopMoves * clearance_steps,
          3 * speed_changes};
}

// The behaviour planner, which chooses among the skills (actor/driving/skills.h): ego speed,
// set-point and lateral offset, ego lane (one-hot), the previous command (one-hot), and five
// numbers on each of the lanes right, own and left.
inline constexpr int kSkillCount = 3;
inline constexpr int kBpScalars = 3;
inline constexpr int kBpPerLane = 5;
inline PlannerShape bp_shape(int lanes, int skills = kSkillCount) {
  return {kBpScalars + lanes + skills + 3 * kBpPerLane, skills};
}

// One n-step transition as `stride()` consecutive floats:
//   [0, n)          observation
//   [n, 2n)         observation n steps later (zeros where discount is 0)
//   action()        index of the action taken, exact in a float
//   n_step_return() scaled and discounted sum of the rewards in between
//   discount()      gamma^steps to bootstrap with; 0 where the episode ended for learning
//   risk_return()   the same sum of costs: 1 for the step of a collision, else 0; not scaled
//   risk_discount() risk_gamma^steps; 0 where discount() is
struct RowLayout {
  int observations = 0;
  std::size_t next_observation() const { return static_cast<std::size_t>(observations); }
  std::size_t action() const { return 2 * next_observation(); }
  std::size_t n_step_return() const { return action() + 1; }
  std::size_t discount() const { return action() + 2; }
  std::size_t risk_return() const { return action() + 3; }
  std::size_t risk_discount() const { return action() + 4; }
  std::size_t stride() const { return action() + 5; }
  bool operator==(const RowLayout&) const = default;
};

// A multi-layer perceptron with ReLU between layers, its parameters in one flat vector of floats:
// for each layer the weights [out, in] row by row, then the biases [out]. `dueling` (Wang et al.
// 2016) replaces the last layer by two that both read the last hidden layer: first the value
// [1, hidden], then the advantages [actions, hidden]; Q = value + advantage - mean(advantages).
struct NetworkShape {
  int observations = 0;
  std::vector<int> hidden;
  int actions = 0;
  bool dueling = false;

  struct Layer {
    int inputs = 0;
    int outputs = 0;
    std::size_t weights = 0;  // offset of the weights in the flat vector
    std::size_t biases = 0;   // offset of the biases
  };

  // In the order of the flat vector; a dueling network's last two are value and advantage.
  std::vector<Layer> layers() const {
    std::vector<Layer> result;
    std::size_t offset = 0;
    const auto add = [&](int inputs, int outputs) {
      const std::size_t biases = offset + static_cast<std::size_t>(inputs) * outputs;
      result.push_back({inputs, outputs, offset, biases});
      offset = biases + static_cast<std::size_t>(outputs);
    };
    int inputs = observations;
    for (const int width : hidden) {
      add(inputs, width);
      inputs = width;
    }
    if (dueling) add(inputs, 1);
    add(inputs, actions);
    return result;
  }

  std::size_t parameters() const {
    const Layer last = layers().back();
    return last.biases + static_cast<std::size_t>(last.outputs);
  }

  bool operator==(const NetworkShape&) const = default;
};

}  // namespace corridor
