// SPDX-License-Identifier: Apache-2.0
#include "proto/run/fingerprint.h"

#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/run/checkpoints.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

TensorFile learner() {
  TensorFile file;
  file.metadata = {{"phase", "BP"}};
  file.put("mop", std::vector<float>{1.0F, 2.0F});
  file.put("updates", std::vector<std::uint64_t>{7});
  return file;
}

TensorFile replay() {
  TensorFile file;
  file.put("priorities", std::vector<double>{0.5, 0.25});
  file.put(kLeavesTensor, std::vector<float>{0.5F, 0.25F, 1.0F});
  file.put(kNextKeyTensor, std::vector<std::uint64_t>{7});
  return file;
}

TEST(Fingerprint, IsTheSameForTheSameContent) {
  EXPECT_EQ(fingerprint(learner(), replay()), fingerprint(learner(), replay()));
  EXPECT_EQ(fingerprint(learner(), replay()).find_first_not_of("0123456789abcdef"),
            std::string::npos);
}

TEST(Fingerprint, ChangesWithEveryPartOfTheContent) {
  const std::string original = fingerprint(learner(), replay());
  TensorFile value = learner(), name = learner(), shape = learner(), type = learner(),
             metadata = learner(), priorities = replay();
  std::get<std::vector<float>>(value.tensors.at("mop").data)[1] = 2.0000002F;
  name.tensors["mop2"] = name.tensors.extract("mop").mapped();
  shape.tensors.at("mop").shape = {1, 2};
  type.put("updates", std::vector<double>{7.0});
  metadata.metadata["phase"] = "MoP";
  std::get<std::vector<double>>(priorities.tensors.at("priorities").data)[0] = 0.75;
  for (const TensorFile& changed : {value, name, shape, type, metadata}) {
    EXPECT_NE(fingerprint(changed, replay()), original);
  }
  EXPECT_NE(fingerprint(learner(), priorities), original);
  EXPECT_NE(fingerprint(replay(), learner()), original);
}

TEST(Fingerprint, OfACheckpointIsThatOfItsRowsHoweverTheyAreDivided) {
  const testing_support::TemporaryDirectory temporary;
  const RunDirectory directory = RunDirectory::create(temporary.path() / "run");
  const Checkpoints checkpoints(directory.checkpoints());
  EXPECT_EQ(rounds_done(directory), 0u);
  // The rows with the keys 4, 5 and 6, divided in this way or that; key 3 has given way.
  std::vector<std::string> fingerprints;
  for (const std::uint64_t cut : {5, 6}) {
    const auto partial = checkpoints.begin(cut);
    write_tensors(partial / kLearnerFile, learner());
    write_tensors(partial / kReplayFile, replay());
    for (const RowsFile& file : {RowsFile{3, cut}, RowsFile{cut, 7}}) {
      std::vector<float> rows;
      for (auto key = file.first_key; key < file.end_key; ++key) {
        rows.insert(rows.end(), {static_cast<float>(key), 0.5F});
      }
      TensorFile part;
      part.tensors.emplace(kRowsTensor, Tensor{{rows.size() / 2, 2}, rows});
      write_tensors(partial / file.name(), part);
    }
    checkpoints.commit(cut, 2);
    EXPECT_EQ(rounds_done(directory), cut + 1);
    fingerprints.push_back(fingerprint(checkpoints.newest().value()));
  }
  EXPECT_EQ(fingerprints[0], fingerprints[1]);
  TensorFile whole = replay();
  whole.tensors.emplace(kRowsTensor,
                        Tensor{{3, 2}, std::vector<float>{4.0F, 0.5F, 5.0F, 0.5F, 6.0F, 0.5F}});
  EXPECT_EQ(fingerprints[0], fingerprint(learner(), whole));

  const auto checkpoint = checkpoints.newest().value();
  std::filesystem::resize_file(checkpoint / kReplayFile, 20);
  EXPECT_THROW(fingerprint(checkpoint), Failure);
}

}  // namespace
}  // namespace corridor::cluster
