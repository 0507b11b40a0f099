// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/player.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cluster/pictures/palette.h"
#include "proto/base/json.h"
#include "tests/support/driven.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing_support::driven_episode;

std::string between(const std::string& text, const std::string& before, const std::string& after) {
  const std::size_t start = text.find(before) + before.size();
  return text.substr(start, text.find(after, start) - start);
}

class Player : public testing::Test {
 protected:
  Player() {
    Clip clip = clip_of(driven_episode(4), "</script><b>title", 1.0, 3.0);
    clip.speed_changes_mps = {-1.0, 1.0};
    page_ = player_page({clip, clip});
  }
  std::string page_;
};

TEST_F(Player, IsOnePageThatNeedsNothingElse) {
  EXPECT_THAT(page_, testing::StartsWith("<!doctype html>"));
  for (const char* elsewhere : {"http://", "https://", "src=", "href=", "@import"})
    EXPECT_THAT(page_, Not(HasSubstr(elsewhere)));
  EXPECT_THAT(page_, Not(HasSubstr("{{data}}")));
}

TEST_F(Player, HoldsItsClipsAndWhatTheyAreShownWith) {
  const Json data = parse_json(
      between(page_, "<script id=\"data\" type=\"application/json\">", "</script>"), "data");
  ASSERT_EQ(data["clips"].size(), 2u);
  const Json& clip = data["clips"][0];
  EXPECT_EQ(clip["title"], "</script><b>title");
  EXPECT_EQ(clip["start_s"], 1.0);
  EXPECT_EQ(clip["speed_changes_mps"], Json({-1.0, 1.0}));
  EXPECT_EQ(clip["steps"].size(), 3u);
  EXPECT_TRUE(clip["steps"][0].contains("on_the_way"));
  EXPECT_EQ(clip["commands"], Json({"keep", "left", "right"}));
  EXPECT_EQ(data["colours"]["ego"], hexadecimal(kEgo));
}

// The script and the style ask for colours by name: each of them is there.
TEST_F(Player, IsHandedEveryColourThatItUses) {
  const Json colours =
      parse_json(between(page_, "<script id=\"data\" type=\"application/json\">", "</script>"),
                 "data")["colours"];
  std::size_t uses = 0;
  for (const std::string before :
       {"var(--", "= colours.", "? colours.", ": colours.", "colours.ego"}) {
    for (std::size_t at = page_.find(before); at != std::string::npos;
         at = page_.find(before, at + 1)) {
      std::size_t end = at + before.size();
      while (std::isalpha(static_cast<unsigned char>(page_[end]))) ++end;
      const std::string name = page_.substr(at + before.size(), end - at - before.size());
      if (!name.empty()) {
        EXPECT_TRUE(colours.contains(name)) << name;
      }
      ++uses;
    }
  }
  EXPECT_GT(uses, 8u);
}

TEST_F(Player, NoTextOfAClipEndsItsScript) {
  EXPECT_THAT(page_, Not(HasSubstr("</script><b>")));
  EXPECT_THAT(page_, HasSubstr("\\u003c/script>"));
}

}  // namespace
}  // namespace corridor::cluster
