#include "cluster/watch/core_time.h"

#include <gmock/gmock.h>

#include "proto/run/metrics.h"
#include "proto/system/time_account.h"

namespace corridor::cluster {
namespace {

using testing::DoubleNear;
using testing::Pair;
using testing::UnorderedElementsAre;

const MetricsValues kLine = {{metric::kStepsPerS, 900.0},
                             {time_metric(TimePart::kSimulate), 0.6},
                             {time_metric(TimePart::kWorld), 0.2},
                             {time_metric(TimePart::kWaitForLearner), 0.2},
                             {kWallTimeMetric, 10.0},
                             {kCpuTimeMetric, 4.0},
                             {kIoCpuTimeMetric, 1.0}};

TEST(CoreTime, IsProcessorTimeInProportionToThePartsThatDoNotWait) {
  const CoreTime parts = cores_by_part(kLine);
  EXPECT_THAT(parts, UnorderedElementsAre(Pair("simulate", DoubleNear(0.3, 1e-12)),
                                          Pair("world", DoubleNear(0.1, 1e-12)),
                                          Pair("io", DoubleNear(0.1, 1e-12))));
  EXPECT_NEAR(sum(parts), 0.5, 1e-12);
}

TEST(CoreTime, IsEmptyWithoutTimes) {
  EXPECT_TRUE(cores_by_part({}).empty());
  EXPECT_TRUE(cores_by_part({{time_metric(TimePart::kSimulate), 1.0}}).empty());
}

TEST(CoreTime, NamesTheLargestPartsFirst) {
  EXPECT_EQ(largest_parts(cores_by_part(kLine), 1), "simulate 60 %");
  EXPECT_EQ(largest_parts(cores_by_part(kLine), 5), "simulate 60 %, io 20 %, world 20 %");
  EXPECT_EQ(largest_parts({}, 3), "");
}

}  // namespace
}  // namespace corridor::cluster
