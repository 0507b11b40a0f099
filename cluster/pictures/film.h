// Clips of driven episodes as films. The only user of the program ffmpeg.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "cluster/pictures/clip.h"

namespace corridor::cluster {

inline constexpr int kFramesPerSecond = 10;

// All clips, one after the other, as fast as they were driven (MP4, H.264). `progress` hears the
// share done. Throws Failure when there is no ffmpeg, when it fails, or when the disk is full.
void write_film(const std::vector<Clip>& clips, const std::filesystem::path& file,
                const std::function<void(double share)>& progress);

}  // namespace corridor::cluster
