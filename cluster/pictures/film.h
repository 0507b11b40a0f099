// Clips of driven episodes as pictures and films. The only user of cairo and of the program ffmpeg.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "cluster/pictures/clip.h"

namespace corridor::cluster {

inline constexpr int kFramesPerSecond = 10;  // as fast as the driving itself

// One picture (PNG): the road from above, what the planners see and choose, speeds and values.
void write_frame(const Clip& clip, double time_s, const std::filesystem::path& file);

// The road at several instants, one below the other (PNG): of a single clip every `interval_s` to
// its end, of several clips the end of each.
void write_contact_sheet(const std::vector<Clip>& clips, double interval_s,
                         const std::filesystem::path& file);

// All clips, one after the other (MP4). `progress` hears the share done. Throws Failure when there
// is no ffmpeg, or when it fails.
void write_film(const std::vector<Clip>& clips, const std::filesystem::path& file,
                const std::function<void(double share)>& progress);

}  // namespace corridor::cluster
