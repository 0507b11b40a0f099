// What the planners choose among, by name. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "proto/base/format.h"

namespace corridor::cluster {

// Of the BP, by the number in a trace.
inline constexpr std::array kCommandNames = {"keep", "left", "right"};
inline std::string command_name(int command) {
  const auto at = static_cast<std::size_t>(command);
  return at < kCommandNames.size() ? kCommandNames[at] : fmt::format("command {}", command);
}

// Of the MoP: an action is a speed change and, beneath it, a change of corridor.
inline constexpr std::array kCorridorChanges = {"right", "straight", "left"};

}  // namespace corridor::cluster
