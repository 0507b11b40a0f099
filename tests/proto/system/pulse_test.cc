// SPDX-License-Identifier: Apache-2.0
#include "proto/system/pulse.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

namespace corridor {
namespace {

// As a started process does, which has a copy of the descriptor.
void adopt(const std::string& variable, const std::string& value) {
  setenv(variable.c_str(), value.c_str(), 1);
  adopt_pulse();
  EXPECT_EQ(std::getenv(variable.c_str()), nullptr) << "its own children would beat for it";
}

TEST(Pulse, IsHeardByTheStarterOnceTheProcessHasAdoptedIt) {
  const Pulse pulse;
  const std::string text = pulse.environment();
  const std::string variable = text.substr(0, text.find('='));
  EXPECT_EQ(text, variable + "=" + std::to_string(pulse.descriptor()));
  beat();
  EXPECT_EQ(pulse.beats(), 0u);
  adopt(variable, std::to_string(dup(pulse.descriptor())));
  for (int i = 0; i < 3; ++i) beat();
  EXPECT_EQ(pulse.beats(), 3u);
  // What says nothing changes nothing.
  for (const char* value : {"", "rubbish", "-1", "1000000"}) adopt(variable, value);
  beat();
  EXPECT_EQ(pulse.beats(), 4u);
}

}  // namespace
}  // namespace corridor
