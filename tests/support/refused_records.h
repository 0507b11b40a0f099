// SPDX-License-Identifier: Apache-2.0
// Records <-> JSON, as all of them are tested.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/json.h"
#include "tests/support/failure_of.h"

namespace corridor::testing_support {

// `read` refuses the JSON without any one of its members, naming the member.
template <typename Read>
void expect_every_member_is_needed(const Json& json, const Read& read) {
  for (const auto& [name, value] : json.items()) {
    Json without = json;
    without.erase(name);
    EXPECT_THAT(failure_of([&] { read(without); }), testing::HasSubstr(name));
  }
}

// `read` refuses the JSON with another value in this place, saying `why`.
template <typename Read>
void expect_refused(Json json, const char* pointer, const Json& value, const char* why,
                    const Read& read) {
  json[Json::json_pointer(pointer)] = value;
  EXPECT_THAT(failure_of([&] { read(json); }), testing::HasSubstr(why)) << pointer;
}

}  // namespace corridor::testing_support
