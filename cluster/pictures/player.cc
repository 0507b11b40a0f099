// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/player.h"

#include "cluster/pictures/palette.h"
#include "cluster/pictures/player_page.h"
#include "proto/base/json.h"
#include "proto/base/text.h"

namespace corridor::cluster {
namespace {

Json described(const Clip& clip) {
  Json json = json_of(clip.trace);
  json["title"] = clip.title;
  json["start_s"] = clip.start_s;
  json["speed_changes_mps"] = clip.speed_changes_mps;
  return json;
}

Json colours() {
  const std::pair<const char*, Colour> named[] = {
      {"ink", kInk},   {"faint", kFaint},   {"paper", kPaper}, {"asphalt", kAsphalt},
      {"line", kLine}, {"ego", kEgo},       {"other", kOther}, {"hit", kHit},
      {"open", kOpen}, {"chosen", kChosen}, {"path", kPath}};
  Json json = Json::object();
  for (const auto& [name, colour] : named) json[name] = hexadecimal(colour);
  return json;
}

}  // namespace

std::string player_page(const std::vector<Clip>& clips) {
  Json data = {{"clips", Json::array()}, {"colours", colours()}, {"changes", kCorridorChanges}};
  for (const Clip& clip : clips) data["clips"].push_back(described(clip));
  constexpr std::string_view kPlace = "{{data}}";
  // No text of it may end the script.
  return std::string(kPlayerPage)
      .replace(kPlayerPage.find(kPlace), kPlace.size(), replaced(data.dump(), '<', "\\u003c"));
}

}  // namespace corridor::cluster
