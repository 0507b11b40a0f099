// SPDX-License-Identifier: Apache-2.0
// The closed sets that a scenario chooses from: an enum each, and its choices' names and meanings.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "proto/base/failure.h"
#include "proto/base/text.h"

namespace corridor {

template <typename E>
struct Choice {
  E value;
  const char* name;
  const char* meaning;
  const char* formerly = nullptr;  // an earlier name, which is refused by naming the one of today
};

// Every choice of an enum, in its order.
template <typename E>
inline constexpr std::array<Choice<E>, 0> kChoices{};

// What moves the ego along its trajectories (dynamics.world).
enum class WorldKind { kKinematic, kRigid, kSlip };
template <>
inline constexpr auto kChoices<WorldKind> = std::to_array<Choice<WorldKind>>({
    {WorldKind::kKinematic, "kinematic", "the ego is where its trajectory says"},
    {WorldKind::kRigid, "rigid",
     "a car that ODE simulates, on tyres that do not slip, those of Webots' highway world",
     "webots"},
    {WorldKind::kSlip, "slip", "that car on tyres that slip, of dynamics.friction"},
});

// The car that ODE simulates (dynamics.car).
enum class Car { kBmwX5, kToyotaPrius };
template <>
inline constexpr auto kChoices<Car> = std::to_array<Choice<Car>>({
    {Car::kBmwX5, "bmw_x5", "a BMW X5 of 2.1 t"},
    {Car::kToyotaPrius, "toyota_prius", "a Toyota Prius of 1.8 t"},
});

// Where the learner computes (run.device).
enum class Device { kCpu, kCuda };
template <>
inline constexpr auto kChoices<Device> = std::to_array<Choice<Device>>({
    {Device::kCpu, "cpu", "BLAS on the processor"},
    {Device::kCuda, "cuda", "LibTorch on a GPU"},
});

// How a run's processes find each other (run.transport).
enum class Transport { kIpc, kTcp };
template <>
inline constexpr auto kChoices<Transport> = std::to_array<Choice<Transport>>({
    {Transport::kIpc, "ipc", "abstract Unix sockets: one machine, no files, no ports"},
    {Transport::kTcp, "tcp", "run.host and its ports"},
});

// Which BP asks while the MoP is trained (schedule.mop_commands).
enum class MopCommands { kRandom, kLearned };
template <>
inline constexpr auto kChoices<MopCommands> = std::to_array<Choice<MopCommands>>({
    {MopCommands::kRandom, "random", "the one of [random_bp]"},
    {MopCommands::kLearned, "learned", "that of the run that train --from names"},
});

template <typename E>
const char* name_of(E value) {
  const auto found = std::ranges::find(kChoices<E>, value, &Choice<E>::value);
  CORRIDOR_CHECK(found != kChoices<E>.end(), "no choice {}", static_cast<int>(value));
  return found->name;
}

// Throws Failure that says what would be right, "must be one of cpu, cuda"; the caller says where.
template <typename E>
E parse_choice(std::string_view name) {
  for (const Choice<E>& choice : kChoices<E>) {
    if (name == choice.name) return choice.value;
    if (choice.formerly && name == choice.formerly) {
      throw Failure("it is called \"{}\" now", choice.name);
    }
  }
  throw Failure("must be one of {}", listed(kChoices<E>, ", ", &Choice<E>::name));
}

}  // namespace corridor
