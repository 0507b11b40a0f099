// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/contact_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/base/failure.h"
#include "tests/support/driven.h"

namespace corridor::cluster {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;
using testing::ThrowsMessage;
using testing_support::areas;
using testing_support::drawn;
using testing_support::driven_episode;
using testing_support::texts;

TEST(ContactSheet, ShowsAClipEveryIntervalToItsEnd) {
  const Clip clip = clip_of(driven_episode(8), "clip", 2.0, 7.0);
  const Canvas sheet = contact_sheet({clip}, 2.0);
  EXPECT_THAT(texts(sheet), IsSupersetOf({"clip", "t0 = 3.0 s, BP: left", "t0 + 2 s, BP: left",
                                          "t0 + 4 s, BP: left"}));
  EXPECT_EQ(drawn<Inset>(sheet.shapes).size(), 3u);
  EXPECT_EQ(areas(sheet, kHit).size(), 1u) << "the last row is the collision";
}

TEST(ContactSheet, ShowsTheEndOfEachOfSeveralClips) {
  const Clip one = clip_of(driven_episode(4), "one", 0.0, 2.0);
  Clip two = clip_of(driven_episode(4), "two", 0.0, 3.0);
  two.trace.steps.back().command.reset();
  const Canvas sheet = contact_sheet({one, two}, 1.0);
  EXPECT_THAT(texts(sheet), IsSupersetOf({"one, BP: left", "two"}));
  EXPECT_THAT(texts(sheet), Not(Contains(HasSubstr("t0"))));
  EXPECT_EQ(drawn<Inset>(sheet.shapes).size(), 2u);
}

TEST(ContactSheet, HasRoomForAllItsRows) {
  const Clip clip = clip_of(driven_episode(8), "clip", 0.0, 7.0);
  const Canvas sheet = contact_sheet({clip}, 1.0);
  for (const Inset& road : drawn<Inset>(sheet.shapes)) {
    EXPECT_LE(road.at.y + road.height, sheet.height);
    EXPECT_LE(road.at.x + road.width, sheet.width);
  }
}

TEST(ContactSheet, OfTooManyInstantsIsRefused) {
  const Clip clip = clip_of(driven_episode(8), "clip", 0.0, 7.0);
  for (const double interval_s : {0.01, 1e-300}) {
    EXPECT_THAT([&] { contact_sheet({clip}, interval_s); },
                ThrowsMessage<Failure>(HasSubstr("too many")));
  }
}

}  // namespace
}  // namespace corridor::cluster
