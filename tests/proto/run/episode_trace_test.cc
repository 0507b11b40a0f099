// SPDX-License-Identifier: Apache-2.0
#include "proto/run/episode_trace.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"

namespace corridor {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

EpisodeTrace trace() {
  EpisodeTrace trace;
  trace.commands = {"keep", "left"};
  trace.step_s = 0.5;
  trace.lanes = 3;
  trace.lane_width_m = 3.2;
  trace.speed_limit_mps = 13.89;
  trace.bp_reward = 4.5;
  trace.lane_changes = 1;
  trace.collision = {CollisionKind::kRearEnding, 8};
  trace.steps = {{{0, 100.0, 4.8, 10.0, 5.0, 1.8}, 1, {{8, 120.0, 4.7, 9.0, 10.0, 2.4}}},
                 {{0, 105.0, 4.8, 10.5, 5.0, 1.8}, std::nullopt, {}}};
  return trace;
}

EpisodeTrace parse_trace(const Json& json, const std::string& name) {
  return parse_record<EpisodeTrace>(json, name, "episode's trace");
}

TEST(EpisodeTrace, IsTheSameAfterWritingAndReading) {
  EpisodeTrace whole = trace();
  const Json object = json_of(whole);
  EXPECT_EQ(json_of(parse_trace(object, "file")), object);
  const EpisodeTrace read = parse_trace(object, "file");
  EXPECT_EQ(read.commands, whole.commands);
  EXPECT_EQ(read.steps[0].command, 1);
  EXPECT_EQ(read.steps[0].others[0].s_m, 120.0);
  EXPECT_EQ(read.steps[1].command, std::nullopt);
  EXPECT_EQ(read.collision->other, 8);

  whole.collision.reset();
  EXPECT_FALSE(parse_trace(json_of(whole), "file").collision);
}

TEST(EpisodeTrace, OfAnythingElseIsRefusedByTheFilesName) {
  const Json good = json_of(trace());
  const auto refused = [](const Json& object) {
    EXPECT_THAT([&] { parse_trace(object, "some.json"); },
                ThrowsMessage<Failure>(HasSubstr("some.json is no episode's trace")))
        << object;
  };
  refused(Json::value_t::discarded);
  refused(Json::array());
  for (const auto& [key, value] : good.items()) {
    Json object = good;
    if (key != "collision") {
      object.erase(key);
      refused(object);
    }
    object[key] = "text";
    refused(object);
  }
  Json object = good;
  object["steps"] = Json::array();
  refused(object);
  object = good;
  object["steps"][0]["command"] = 2;
  refused(object);
  object = good;
  object["steps"][0]["ego"].push_back(1);
  refused(object);
  object = good;
  object["steps"][0]["others"][0][0] = 1e40;
  refused(object);
}

}  // namespace
}  // namespace corridor
