// SPDX-License-Identifier: Apache-2.0
#include "proto/settings/choices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/support/failure_of.h"

namespace corridor {
namespace {

template <typename E>
class ChoicesOf : public testing::Test {};
using Enums = testing::Types<WorldKind, Car, Device, Transport, MopCommands>;
TYPED_TEST_SUITE(ChoicesOf, Enums);

TYPED_TEST(ChoicesOf, HaveANameAndAMeaningEachAndAreReadByIt) {
  std::set<std::string> names;
  for (const Choice<TypeParam>& choice : kChoices<TypeParam>) {
    EXPECT_TRUE(names.insert(choice.name).second) << choice.name;
    EXPECT_STRNE(choice.meaning, "");
    EXPECT_STREQ(name_of(choice.value), choice.name);
    EXPECT_EQ(parse_choice<TypeParam>(choice.name), choice.value);
  }
  EXPECT_GE(names.size(), 2u);
}

TEST(Choices, OthersAreRefusedByNamingAll) {
  EXPECT_EQ(failure_of([] { parse_choice<WorldKind>("moon"); }),
            "must be one of kinematic, rigid, slip");
}

TEST(Choices, AnEarlierNameIsRefusedByNamingTodays) {
  EXPECT_EQ(failure_of([] { parse_choice<WorldKind>("webots"); }), "it is called \"rigid\" now");
}

}  // namespace
}  // namespace corridor
