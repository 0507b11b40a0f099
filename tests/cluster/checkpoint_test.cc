#include "cluster/checkpoint.h"

#include <gtest/gtest.h>

#include "proto/failure.h"
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

TEST(NewestCheckpoint, IsNothingInANewRunAndTheLastCommittedOneLater) {
  const testing_support::TemporaryDirectory temporary;
  const RunDirectory directory = RunDirectory::create(temporary.path() / "run");
  EXPECT_FALSE(newest_checkpoint(directory));
  for (const std::uint64_t round : {3, 7}) {
    const auto partial = directory.begin_checkpoint(round);
    write_tensors(partial / "learner.safetensors", learner());
    write_tensors(partial / "replay.safetensors", replay());
    directory.commit_checkpoint(round, 2);
  }
  const auto checkpoint = newest_checkpoint(directory);
  ASSERT_TRUE(checkpoint);
  EXPECT_EQ(checkpoint->rounds_done, 8u);
  EXPECT_EQ(fingerprint(*checkpoint), fingerprint(learner(), replay()));

  std::filesystem::resize_file(checkpoint->directory / "replay.safetensors", 20);
  EXPECT_THROW(newest_checkpoint(directory), Failure);
}

}  // namespace
}  // namespace corridor::cluster
