#include "proto/system/time_account.h"

#include <gmock/gmock.h>

#include <map>
#include <set>

namespace corridor {
namespace {

std::map<std::string, double> take(TimeAccount& account) {
  const auto values = account.take();
  return {values.begin(), values.end()};
}

// Passes some time, at work.
void work() {
  const auto start = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(5)) {
  }
}

TEST(TimeAccount, EveryMomentBelongsToTheNextCharge) {
  TimeAccount account;
  work();
  account.charge(TimePart::kSimulate);
  work();
  account.charge(TimePart::kInfer);
  work();
  account.charge(TimePart::kSimulate);
  const auto values = take(account);
  EXPECT_GE(values.at(kWallTimeMetric), 0.015);
  EXPECT_GE(values.at(time_metric(TimePart::kSimulate)) * values.at(kWallTimeMetric),
            0.010 * 0.999);
  EXPECT_GE(values.at(time_metric(TimePart::kInfer)) * values.at(kWallTimeMetric), 0.005 * 0.999);
  EXPECT_NEAR(
      values.at(time_metric(TimePart::kSimulate)) + values.at(time_metric(TimePart::kInfer)), 1.0,
      0.05);
  EXPECT_GT(values.at(kCpuTimeMetric), 0.0);
  EXPECT_GE(values.at(kIoCpuTimeMetric), 0.0);
}

TEST(TimeAccount, TakingBeginsAnewAndKeepsTheNames) {
  TimeAccount account;
  work();
  account.charge(TimePart::kUpdate);
  take(account);
  work();
  account.charge(TimePart::kPublish);
  const auto values = take(account);
  EXPECT_EQ(values.at(time_metric(TimePart::kUpdate)), 0.0);
  EXPECT_GT(values.at(time_metric(TimePart::kPublish)), 0.5);
  EXPECT_FALSE(values.contains(time_metric(TimePart::kSample)));
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
