// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/contact_sheet.h"

#include <cmath>

#include "cluster/pictures/road_view.h"
#include "proto/base/failure.h"

namespace corridor::cluster {
namespace {

constexpr double kMargin = 24.0, kTitleHeight = 44.0, kLabelHeight = 22.0, kGap = 8.0;
constexpr RoadView kSheetRoad;
constexpr int kMostRows = 200;

struct Row {
  const Clip* clip;
  double time_s;
  std::string label;
};

std::vector<Row> rows_of(const std::vector<Clip>& clips, double interval_s) {
  std::vector<Row> rows;
  if (clips.size() > 1) {
    if (clips.size() > kMostRows)
      throw Failure("{} pictures are too many for a contact sheet", clips.size());
    for (const Clip& clip : clips) rows.push_back({&clip, clip.duration_s(), clip.title});
    return rows;
  }
  const Clip& clip = clips.front();
  const double steps = std::floor(clip.duration_s() / interval_s + 1e-9);
  if (steps >= kMostRows)
    throw Failure("{:g} instants are too many for a contact sheet", steps + 1);
  const int intervals = static_cast<int>(steps);
  const double first_s = clip.duration_s() - intervals * interval_s;
  for (int i = 0; i <= intervals; ++i) {
    const double after_s = i * interval_s;
    rows.push_back({&clip, first_s + after_s,
                    i == 0 ? fmt::format("t0 = {:.1f} s", clip.start_s + first_s)
                           : fmt::format("t0 + {:g} s", after_s)});
  }
  return rows;
}

}  // namespace

Canvas contact_sheet(const std::vector<Clip>& clips, double interval_s) {
  CORRIDOR_CHECK(!clips.empty() && interval_s > 0.0, "{} clips", clips.size());
  const bool one = clips.size() == 1;
  Canvas canvas{kSheetRoad.width + 2 * kMargin, one ? kTitleHeight + kGap : 2 * kGap};
  if (one) canvas.add(Text{{kMargin, 28}, 17, clips.front().title});
  for (const auto& [clip, time_s, label] : rows_of(clips, interval_s)) {
    const double top = canvas.height - kGap;
    std::string text = label;
    if (const auto command = clip->step_at(time_s).command)
      text += ", BP: " + clip->trace.command_name(*command);
    canvas.add(Text{{kMargin, top + 16}, 14, text});
    const Canvas road = road_from_above(*clip, time_s, kSheetRoad);
    canvas.inset({kMargin, top + kLabelHeight}, road);
    canvas.height = top + kLabelHeight + road.height + 2 * kGap;
  }
  return canvas;
}

}  // namespace corridor::cluster
