// SPDX-License-Identifier: Apache-2.0
#include "proto/run/networks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "proto/run/checkpoints.h"
#include "proto/run/tensor_file.h"
#include "proto/system/files.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class NetworksTest : public testing::Test {
 protected:
  Networks networks_of(float value) const {
    Networks networks;
    for (const NamedNetwork& network : kNetworks) {
      networks[network.id].assign(config_.parameters(network.id), value);
      value = -value;
    }
    return networks;
  }

  RunConfig config_;
  testing_support::TemporaryDirectory temporary_;
  RunDirectory directory_ = RunDirectory::create(temporary_.path() / "run");
};

TEST_F(NetworksTest, ARunHasNoneAtFirstThenThoseGivenThenThoseOfItsCheckpoint) {
  EXPECT_EQ(given_networks(directory_, config_), std::nullopt);
  EXPECT_EQ(newest_networks(directory_, config_), std::nullopt);

  write_networks(directory_, networks_of(0.5f));
  EXPECT_EQ(given_networks(directory_, config_), networks_of(0.5f));
  EXPECT_EQ(newest_networks(directory_, config_), networks_of(0.5f));

  const Checkpoints checkpoints(directory_.checkpoints());
  TensorFile learner;
  learner.put("mop", networks_of(0.25f)[NetworkId::kMop]);
  learner.put("bp", networks_of(0.25f)[NetworkId::kBp]);
  write_tensors(checkpoints.begin(7) / kLearnerFile, learner);
  checkpoints.commit(7, 2);
  EXPECT_EQ(newest_networks(directory_, config_), networks_of(0.25f));
  EXPECT_EQ(given_networks(directory_, config_), networks_of(0.5f));
}

TEST_F(NetworksTest, OfAnotherSizeTheyAreRefusedByFileAndPlanner) {
  Networks networks = networks_of(1.0f);
  networks[NetworkId::kBp].pop_back();
  write_networks(directory_, networks);
  EXPECT_THAT([&] { newest_networks(directory_, config_); },
              ThrowsMessage<Failure>(
                  AllOf(HasSubstr(directory_.networks().string()), HasSubstr("the BP has"))));
}

TEST_F(NetworksTest, ADamagedFileIsNamed) {
  write_file(directory_.networks(), "no tensors");
  EXPECT_THAT([&] { given_networks(directory_, config_); },
              ThrowsMessage<Failure>(HasSubstr(directory_.networks().string())));
}

}  // namespace
}  // namespace corridor
