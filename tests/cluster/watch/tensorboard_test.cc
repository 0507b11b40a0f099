// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/tensorboard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "cluster/watch/tensorboard_event.pb.h"
#include "proto/base/failure.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using tensorboard::Event;
using testing::HasSubstr;
using testing::ThrowsMessage;

// Bit by bit, from the polynomial.
std::uint32_t crc32c(std::string_view data) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const char byte : data) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0x82F63B78u : crc >> 1;
  }
  return ~crc;
}

std::uint64_t number(std::string_view bytes) {
  std::uint64_t result = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) {
    result = result << 8 | static_cast<unsigned char>(bytes[i]);
  }
  return result;
}

// As TensorBoard reads a file: every length and payload is checked.
std::vector<Event> read_events(const std::filesystem::path& file) {
  const std::string content = read_file(file);
  std::string_view rest = content;
  std::vector<Event> events;
  const auto take = [&](std::size_t bytes) {
    EXPECT_GE(rest.size(), bytes);
    const std::string_view taken = rest.substr(0, bytes);
    rest.remove_prefix(taken.size());
    return taken;
  };
  const auto check = [&](std::string_view data) {
    const auto masked = static_cast<std::uint32_t>(number(take(4)));
    const std::uint32_t rotated = masked - 0xa282ead8u;
    EXPECT_EQ(rotated >> 17 | rotated << 15, crc32c(data));
  };
  while (!rest.empty() && !testing::Test::HasFailure()) {
    const std::string_view length = take(8);
    check(length);
    const std::string_view payload = take(number(length));
    check(payload);
    EXPECT_TRUE(events.emplace_back().ParseFromString(std::string(payload)));
  }
  return events;
}

class EventFiles : public testing::Test {
 protected:
  testing_support::TemporaryDirectory temporary_;
  std::filesystem::path folder_ = temporary_.path() / "run" / "tensorboard";
  std::filesystem::path first_ = folder_ / "events.out.tfevents.000001";
  std::filesystem::path second_ = folder_ / "events.out.tfevents.000002";
};

TEST(Crc32c, OfTheTestsIsThatOfTheStandard) { EXPECT_EQ(crc32c("123456789"), 0xE3069283u); }

TEST_F(EventFiles, HoldWhatWasWrittenInOrder) {
  EventWriter writer(folder_, 1.5);
  writer.start(512, 2.5);
  writer.write(1024, {{"train/mop/loss", 0.25}, {"train/mop/q", -3.0}}, 3.5);
  const std::vector<Event> events = read_events(first_);
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].file_version(), "brain.Event:2");
  EXPECT_EQ(events[0].wall_time(), 1.5);
  EXPECT_EQ(events[1].step(), 512);
  EXPECT_EQ(events[1].session_log().status(), tensorboard::SessionLog::START);
  EXPECT_EQ(events[2].step(), 1024);
  EXPECT_EQ(events[2].wall_time(), 3.5);
  ASSERT_EQ(events[2].summary().value_size(), 2);
  EXPECT_EQ(events[2].summary().value(0).tag(), "train/mop/loss");
  EXPECT_EQ(events[2].summary().value(0).simple_value(), 0.25f);
  EXPECT_EQ(events[2].summary().value(1).tag(), "train/mop/q");
  EXPECT_EQ(events[2].summary().value(1).simple_value(), -3.0f);
}

TEST_F(EventFiles, HaveTheBytesThatTensorBoardExpects) {
  { EventWriter writer(folder_, 0.0); }
  // A length of 15; field 3, 13 bytes of text.
  const std::string content = read_file(first_);
  EXPECT_EQ(content.substr(0, 8), std::string("\x0f\0\0\0\0\0\0\0", 8));
  EXPECT_EQ(content.substr(12, 15),
            "\x1a\x0d"
            "brain.Event:2");
  EXPECT_EQ(content.size(), 8u + 4 + 15 + 4);
}

TEST_F(EventFiles, AreLeftAloneByTheNextWriterWhoseFileComesBehind) {
  { EventWriter(folder_, 1.0).write(1, {{"a", 1.0}}, 1.0); }
  const std::string before = read_file(first_);
  { EventWriter(folder_, 0.5).write(2, {{"a", 2.0}}, 1.0); }
  EXPECT_EQ(read_file(first_), before);
  EXPECT_EQ(read_events(second_).size(), 2u);
}

TEST_F(EventFiles, ThatCannotBeWrittenAreNamed) {
  std::filesystem::create_directories(folder_.parent_path());
  write_file(folder_, "in the way");
  EXPECT_THAT([&] { EventWriter(folder_, 0.0); }, ThrowsMessage<Failure>(HasSubstr("tensorboard")));
}

// Writes fail past a size, as on a full disk.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST_F(EventFiles, FailWhenTheDiskIsFull) {
  EventWriter writer(folder_, 0.0);
  const SizeLimit limit(64);
  EXPECT_THAT(
      [&] {
        writer.write(1, {{std::string(100, 'a'), 1.0}}, 0.0);
      },
      ThrowsMessage<Failure>(HasSubstr("000001: is the disk full?")));
}

}  // namespace
}  // namespace corridor::cluster
