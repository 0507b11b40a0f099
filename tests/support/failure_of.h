// SPDX-License-Identifier: Apache-2.0
// The text of the Failure that an action throws.
#pragma once

#include <string>

#include "proto/base/failure.h"

namespace corridor {

template <typename Action>
std::string failure_of(const Action& action) {
  try {
    action();
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "no failure";
}

}  // namespace corridor
