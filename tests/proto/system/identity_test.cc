// SPDX-License-Identifier: Apache-2.0
#include "proto/system/identity.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "proto/base/failure.h"

namespace corridor {
namespace {

TEST(Incarnation, OfALaterStartIsGreaterWhateverIsDrawn) {
  EXPECT_LT(incarnation_of(0, ~std::uint64_t{0}), incarnation_of(1, 0));
  EXPECT_LT(incarnation_of(1, ~std::uint64_t{0}), incarnation_of(2, 0));
  EXPECT_LT(incarnation_of(0xFFFF'FFFE, ~std::uint64_t{0}), incarnation_of(0xFFFF'FFFF, 0));
}

TEST(Incarnation, OfTwoProcessesThatNobodyCountsDiffers) {
  EXPECT_NE(incarnation_of(0, 1ull << 40), incarnation_of(0, 2ull << 40));
  EXPECT_NE(draw_incarnation(), draw_incarnation());
}

TEST(Incarnation, IsOfTheStartThatTheEnvironmentSays) {
  const std::string environment = start_environment(7);
  const std::size_t equals = environment.find('=');
  const std::string name = environment.substr(0, equals);
  setenv(name.c_str(), environment.substr(equals + 1).c_str(), 1);
  EXPECT_EQ(draw_incarnation() >> 32, 7u);
  setenv(name.c_str(), "nonsense", 1);
  EXPECT_EQ(draw_incarnation() >> 32, 0u);
  unsetenv(name.c_str());
  EXPECT_EQ(draw_incarnation() >> 32, 0u);
}

TEST(FolderIdentity, IsTheFoldersOwnByWhateverPath) {
  EXPECT_EQ(folder_identity("/usr"), folder_identity("/usr/bin/.."));
  EXPECT_NE(folder_identity("/usr"), folder_identity("/"));
  EXPECT_THROW(folder_identity("/nowhere"), Failure);
}

TEST(HostName, IsNeverEmpty) { EXPECT_FALSE(host_name().empty()); }

}  // namespace
}  // namespace corridor
