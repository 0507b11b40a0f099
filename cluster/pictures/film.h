// SPDX-License-Identifier: Apache-2.0
// Clips of driven episodes as films. The only user of the program ffmpeg.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "cluster/pictures/canvas.h"
#include "cluster/pictures/chart.h"
#include "cluster/pictures/clip.h"

namespace corridor::cluster {

// What one instant of a clip looks like in a film: the road from above, the values that the
// planners chose by, and the ego's speed, gap and place across the road up to then. Pure.
class Frames {
 public:
  // `clip` outlives it.
  explicit Frames(const Clip& clip);

  // All of one size, which is even in both directions, as H.264 wants it.
  Canvas at(double time_s) const;

 private:
  void draw_history(Canvas& canvas, double time_s, double left, double top) const;

  const Clip& clip_;
  CurveValues speed_mps_, leader_mps_, gap_m_, d_m_;  // every tenth of a second
};

// The program that makes films. Throws Failure when there is none.
std::filesystem::path find_ffmpeg();

// All clips, one after the other, as fast as they were driven (MP4, H.264). `progress` hears the
// share done. Throws Failure when there is no ffmpeg, when it fails, or when the disk is full, and
// Stopped when a signal asks this process to end; there is no film then.
void write_film(const std::vector<Clip>& clips, const std::filesystem::path& file,
                const std::function<void(double share)>& progress);

}  // namespace corridor::cluster
