// SPDX-License-Identifier: Apache-2.0
#include "replay/admission.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "proto/base/failure.h"

namespace corridor::replay {
namespace {

using Parking = Admission::Parking;
using testing::ElementsAre;
using testing::IsEmpty;

Insert bare_chunk(std::uint64_t round, std::uint32_t actor) {
  Insert result;
  result.round = round;
  result.rows = {static_cast<float>(round), static_cast<float>(actor)};
  result.open = {10 * round + actor, {static_cast<std::uint8_t>(round), 7}};
  return result;
}

TEST(AdmissionTest, EveryOrderOfArrivalIsAdmittedInTheOrderOfTheActors) {
  std::vector<std::uint32_t> order{0, 1, 2, 3};
  do {
    Admission admission(4);
    for (const std::uint32_t actor : order) {
      EXPECT_FALSE(admission.missing().empty());
      ASSERT_EQ(admission.park(actor, bare_chunk(0, actor)), Parking::kParked);
    }
    const std::vector<Insert> chunks = admission.admit();
    ASSERT_EQ(chunks.size(), 4U);
    for (std::uint32_t actor = 0; actor < 4; ++actor)
      EXPECT_EQ(chunks[actor], bare_chunk(0, actor));
    EXPECT_EQ(admission.next_round(), 1U);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(AdmissionTest, KnowsWhichActorsAreMissing) {
  Admission admission(3);
  EXPECT_THAT(admission.missing(), ElementsAre(0, 1, 2));
  admission.park(1, bare_chunk(0, 1));
  admission.park(1, bare_chunk(1, 1));
  EXPECT_THAT(admission.missing(), ElementsAre(0, 2));
  admission.park(2, bare_chunk(0, 2));
  admission.park(0, bare_chunk(0, 0));
  EXPECT_THAT(admission.missing(), IsEmpty());
  admission.admit();
  EXPECT_THAT(admission.missing(), ElementsAre(0, 2));
}

TEST(AdmissionTest, ParksTwoRoundsAheadAndNoMore) {
  Admission admission(2);
  EXPECT_EQ(admission.park(0, bare_chunk(0, 0)), Parking::kParked);
  EXPECT_EQ(admission.park(0, bare_chunk(1, 0)), Parking::kParked);
  EXPECT_EQ(admission.park(0, bare_chunk(2, 0)), Parking::kTooEarly);
  admission.park(1, bare_chunk(0, 1));
  admission.admit();
  EXPECT_EQ(admission.park(0, bare_chunk(2, 0)), Parking::kParked);
}

TEST(AdmissionTest, TakesEachRoundOnceAndNoneOutOfTurn) {
  Admission admission(1);
  EXPECT_EQ(admission.park(0, bare_chunk(1, 0)), Parking::kOutOfTurn);
  EXPECT_EQ(admission.park(0, bare_chunk(0, 0)), Parking::kParked);
  EXPECT_EQ(admission.park(0, bare_chunk(0, 0)), Parking::kOutOfTurn);
  admission.admit();
  EXPECT_EQ(admission.park(0, bare_chunk(0, 0)), Parking::kOutOfTurn);
}

TEST(AdmissionTest, ACheckpointHoldsTheAdmittedEpisodesAndForgetsTheParkedOnes) {
  Admission admission(2);
  admission.park(0, bare_chunk(0, 0));
  admission.park(1, bare_chunk(0, 1));
  admission.admit();
  TensorFile file;
  admission.save(file);
  admission.park(1, bare_chunk(1, 1));
  EXPECT_EQ(admission.open_episode(1), bare_chunk(1, 1).open);
  EXPECT_EQ(admission.next_round(1), 2U);
  TensorFile with_parked;
  admission.save(with_parked);
  EXPECT_EQ(with_parked, file);

  Admission restored(2);
  restored.load(file, "x");
  EXPECT_EQ(restored.next_round(), 1U);
  EXPECT_EQ(restored.next_round(1), 1U);
  EXPECT_EQ(restored.open_episode(0), bare_chunk(0, 0).open);
  EXPECT_EQ(restored.open_episode(1), bare_chunk(0, 1).open);
}

TEST(AdmissionTest, ADamagedCheckpointIsAFailure) {
  Admission admission(2);
  TensorFile good;
  admission.save(good);
  EXPECT_THROW(Admission(3).load(good, "x"), Failure);
  TensorFile lengths = good;
  lengths.put("open_steps", std::vector<std::uint64_t>{UINT64_MAX, 1});
  EXPECT_THROW(admission.load(lengths, "x"), Failure);
  TensorFile rounds = good;
  rounds.put("next_round", std::vector<std::uint64_t>{});
  EXPECT_THROW(admission.load(rounds, "x"), Failure);
  TensorFile missing = good;
  missing.tensors.erase("open_actions");
  EXPECT_THROW(admission.load(missing, "x"), Failure);
}

}  // namespace
}  // namespace corridor::replay
