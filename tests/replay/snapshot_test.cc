// SPDX-License-Identifier: Apache-2.0
#include "replay/snapshot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "tests/support/temporary_directory.h"

namespace corridor::replay {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;
using testing_support::names_in;

class SnapshotTest : public testing::Test {
 protected:
  SnapshotTest() {
    fs::create_directory(first_);
    fs::create_directory(second_);
  }
  // Rows of two numbers each: their key, and a half more.
  static Snapshot of_rows(std::uint64_t first_key, std::uint64_t end_key) {
    Snapshot snapshot;
    snapshot.head.put(kNextKeyTensor, std::vector<std::uint64_t>{end_key});
    snapshot.first_new_key = first_key;
    snapshot.stride = 2;
    for (std::uint64_t key = first_key; key < end_key; ++key) {
      snapshot.rows.push_back(static_cast<float>(key));
      snapshot.rows.push_back(static_cast<float>(key) + 0.5f);
    }
    return snapshot;
  }

  testing_support::TemporaryDirectory temporary_;
  const fs::path first_ = temporary_.path() / "1", second_ = temporary_.path() / "2";
};

TEST_F(SnapshotTest, WritesNewRowsUnderTheirKeysBesideTheHead) {
  const Snapshot snapshot = of_rows(5, 8);
  write(snapshot, first_, {});
  EXPECT_THAT(rows_files(first_), ElementsAre(RowsFile{5, 8}));
  const TensorFile rows = read_tensors(first_ / RowsFile{5, 8}.name());
  EXPECT_EQ(rows.tensors.at(kRowsTensor), (Tensor{{3, 2}, snapshot.rows}));
  EXPECT_EQ(read_tensors(first_ / kReplayFile), snapshot.head);
}

TEST_F(SnapshotTest, LinksToTheRowsOfTheOneBeforeWhichMayThenGo) {
  write(of_rows(0, 4), first_, {});
  Snapshot next = of_rows(4, 6);
  next.files = {{0, 4}};
  write(next, second_, first_);
  const std::string shared = RowsFile{0, 4}.name();
  EXPECT_TRUE(fs::equivalent(first_ / shared, second_ / shared));
  fs::remove_all(first_);
  EXPECT_THAT(rows_files(second_), ElementsAre(RowsFile{0, 4}, RowsFile{4, 6}));
  EXPECT_EQ(read_tensors(second_ / shared).tensors.at(kRowsTensor).shape,
            (std::vector<std::size_t>{4, 2}));
}

TEST_F(SnapshotTest, WithoutNewRowsHasNoFileOfThem) {
  write(of_rows(0, 4), first_, {});
  Snapshot same = of_rows(4, 4);
  same.files = {{0, 4}};
  write(same, second_, first_);
  EXPECT_THAT(names_in(second_), testing::UnorderedElementsAre(RowsFile{0, 4}.name(), kReplayFile));
}

TEST_F(SnapshotTest, NamesTheFileThatTheOneBeforeDoesNotHave) {
  Snapshot snapshot = of_rows(4, 6);
  snapshot.files = {{0, 4}};
  EXPECT_THAT([&] { write(snapshot, second_, first_); },
              ThrowsMessage<Failure>(HasSubstr(RowsFile{0, 4}.name())));
  EXPECT_FALSE(fs::exists(second_ / kReplayFile)) << "a checkpoint that looks whole";
}

}  // namespace
}  // namespace corridor::replay
