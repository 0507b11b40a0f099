#include "actor/world/traffic_distribution.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace corridor::world {
namespace {

bool equal(const TrafficSettings& a, const TrafficSettings& b) {
  return a.vehicles_min == b.vehicles_min && a.vehicles_max == b.vehicles_max &&
         a.slow_share == b.slow_share && a.speed_factor_mean == b.speed_factor_mean &&
         a.blind_rate_per_s == b.blind_rate_per_s && a.objects_per_km == b.objects_per_km;
}

TrafficDistribution wide() {
  return {.vehicles = {6, 18},
          .slow_share = {0.1, 0.4},
          .speed_factor_mean = {0.6, 0.9},
          .blind_rate_per_s = {0.0, 0.02},
          .objects_per_km = {0.0, 6.0}};
}

TEST(TrafficDistribution, OfNothingLeavesTheTrafficAsItIs) {
  EXPECT_TRUE(equal(draw_traffic({}, {}, 5), {}));
}

TEST(TrafficDistribution, DrawsOnlyWhatItSays) {
  TrafficDistribution objects;
  objects.objects_per_km = {2.0, 4.0};
  const TrafficSettings drawn = draw_traffic({}, objects, 5);
  EXPECT_GE(drawn.objects_per_km, 2.0);
  EXPECT_LE(drawn.objects_per_km, 4.0);
  TrafficSettings rest = drawn;
  rest.objects_per_km = 0.0;
  EXPECT_TRUE(equal(rest, {}));
}

TEST(TrafficDistribution, IsAFunctionOfTheEpisodeSeed) {
  EXPECT_TRUE(equal(draw_traffic({}, wide(), 7), draw_traffic({}, wide(), 7)));
  EXPECT_FALSE(equal(draw_traffic({}, wide(), 7), draw_traffic({}, wide(), 8)));
}

TEST(TrafficDistribution, IsUniformBetweenItsEndsAndOneQuantityIndependentOfAnother) {
  constexpr int kEpisodes = 10'000;
  double sum = 0.0, products = 0.0, least = 1.0, most = 0.0;
  for (std::uint64_t seed = 0; seed < kEpisodes; ++seed) {
    const TrafficSettings traffic = draw_traffic({}, wide(), seed);
    EXPECT_EQ(traffic.vehicles_min, 6);
    EXPECT_EQ(traffic.vehicles_max, 18);
    const double blind = traffic.blind_rate_per_s / 0.02;
    const double slow = (traffic.slow_share - 0.1) / 0.3;
    sum += blind;
    products += (blind - 0.5) * (slow - 0.5);
    least = std::min(least, blind);
    most = std::max(most, blind);
  }
  EXPECT_NEAR(sum / kEpisodes, 0.5, 0.015);  // five standard errors
  EXPECT_NEAR(products / kEpisodes, 0.0, 0.005);
  EXPECT_GE(least, 0.0);
  EXPECT_LT(least, 0.01);
  EXPECT_LE(most, 1.0);
  EXPECT_GT(most, 0.99);
}

}  // namespace
}  // namespace corridor::world
