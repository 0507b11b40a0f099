// SPDX-License-Identifier: Apache-2.0
#include "proto/system/time_account.h"

#include <gmock/gmock.h>

#include <map>
#include <set>

namespace corridor {
namespace {

using std::chrono::seconds;

std::map<std::string, double> take(TimeAccount& account, TimePoint now) {
  const auto values = account.take(now);
  return {values.begin(), values.end()};
}

constexpr TimePoint at(int second) { return TimePoint(seconds(second)); }

TEST(TimeAccount, EveryMomentBelongsToTheNextCharge) {
  TimeAccount account(at(10));
  account.charge(TimePart::kSimulate, at(11));
  account.charge(TimePart::kInfer, at(14));
  account.charge(TimePart::kSimulate, at(16));
  EXPECT_EQ(account.wall_s(at(16)), 6.0);
  const auto values = take(account, at(20));
  EXPECT_EQ(values.at(kWallTimeMetric), 10.0);
  EXPECT_EQ(values.at(time_metric(TimePart::kSimulate)), 0.3);
  EXPECT_EQ(values.at(time_metric(TimePart::kInfer)), 0.3);
  EXPECT_GT(values.at(kCpuTimeMetric), 0.0);
  EXPECT_GE(values.at(kIoCpuTimeMetric), 0.0);
}

TEST(TimeAccount, TakingBeginsAnewAndKeepsTheNames) {
  TimeAccount account(at(0));
  account.charge(TimePart::kUpdate, at(5));
  take(account, at(5));
  account.charge(TimePart::kPublish, at(7));
  const auto values = take(account, at(9));
  EXPECT_EQ(values.at(kWallTimeMetric), 4.0);
  EXPECT_EQ(values.at(time_metric(TimePart::kUpdate)), 0.0);
  EXPECT_EQ(values.at(time_metric(TimePart::kPublish)), 0.5);
  EXPECT_FALSE(values.contains(time_metric(TimePart::kSample)));
}

TEST(TimeAccount, GoesByTheMachinesClockUnlessTold) {
  TimeAccount account;
  account.charge(TimePart::kUpdate);
  const TimePoint later = steady_now() + seconds(100);
  EXPECT_GE(account.wall_s(later), 100.0);
  EXPECT_LT(account.wall_s(), 100.0);
}

TEST(TimeAccount, PartsHaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < kTimeParts; ++i) {
    const auto part = static_cast<TimePart>(i);
    names.insert(time_part_name(part));
    EXPECT_EQ(is_wait(part), std::string(time_part_name(part)).starts_with("wait_")) << i;
  }
  EXPECT_EQ(names.size(), kTimeParts);
}

}  // namespace
}  // namespace corridor
