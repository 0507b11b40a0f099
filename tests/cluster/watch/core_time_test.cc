#include "cluster/watch/core_time.h"

#include <gmock/gmock.h>

#include "proto/run/metrics.h"

namespace corridor::cluster {
namespace {

using testing::DoubleNear;
using testing::Pair;
using testing::UnorderedElementsAre;

const MetricsValues kLine = {{"charts/SPS", 900.0},    {"time/simulate", 0.6},
                             {"time/world", 0.2},      {"time/wait_for_learner", 0.2},
                             {"time/wall_s", 10.0},    {"time/cpu_s", 4.0},
                             {"time/cpu_of_io_s", 1.0}};

TEST(CoreTime, IsProcessorTimeInProportionToThePartsThatDoNotWait) {
  const CoreTime parts = cores_by_part(kLine);
  EXPECT_THAT(parts, UnorderedElementsAre(Pair("simulate", DoubleNear(0.3, 1e-12)),
                                          Pair("world", DoubleNear(0.1, 1e-12)),
                                          Pair("io", DoubleNear(0.1, 1e-12))));
  EXPECT_NEAR(sum(parts), 0.5, 1e-12);
}

TEST(CoreTime, IsEmptyWithoutTimes) {
  EXPECT_TRUE(cores_by_part({}).empty());
  EXPECT_TRUE(cores_by_part({{"time/simulate", 1.0}}).empty());
}

TEST(CoreTime, NamesTheLargestPartsFirst) {
  EXPECT_EQ(largest_parts(cores_by_part(kLine), 1), "simulate 60 %");
  EXPECT_EQ(largest_parts(cores_by_part(kLine), 5), "simulate 60 %, io 20 %, world 20 %");
  EXPECT_EQ(largest_parts({}, 3), "");
}

}  // namespace
}  // namespace corridor::cluster
