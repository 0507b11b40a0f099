#include "cluster/pictures/film.h"

#include <algorithm>
#include <chrono>
#include <fstream>

#include "cluster/pictures/frame.h"
#include "proto/base/failure.h"
#include "proto/system/files.h"
#include "proto/system/subprocess.h"

namespace corridor::cluster {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::minutes kPatience{10};

// The frames as pictures (PNG) one after the other, in a file beside the film; gone with it.
class FrameFile {
 public:
  explicit FrameFile(const fs::path& film) : path_(film.string() + ".frames"), out_(path_) {}
  ~FrameFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  FrameFile(const FrameFile&) = delete;
  FrameFile& operator=(const FrameFile&) = delete;

  void add(const std::string& png) {
    out_ << png << std::flush;
    if (!out_) throw Failure("cannot write {}: is the disk full?", path_.string());
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  std::ofstream out_;
};

void encode(const fs::path& ffmpeg, const fs::path& frames, const fs::path& film) {
  const auto done =
      run_subprocess(ffmpeg, {"-y",         "-loglevel",     "error",
                              "-f",         "image2pipe",    "-c:v",
                              "png",        "-framerate",    std::to_string(kFramesPerSecond),
                              "-i",         frames.string(), "-c:v",
                              "libx264",    "-crf",          "20",
                              "-pix_fmt",   "yuv420p",       "-movflags",
                              "+faststart", film.string()},
                     "", kPatience);
  if (!done) {
    throw Failure("ffmpeg did not write {} within {} min", film.string(), kPatience.count());
  }
  if (done->status != 0) {
    throw Failure("ffmpeg cannot write {}: {}", film.string(),
                  done->errors.substr(0, done->errors.find('\n')));
  }
}

}  // namespace

void write_film(const std::vector<Clip>& clips, const fs::path& file,
                const std::function<void(double)>& progress) {
  const auto ffmpeg = find_program("ffmpeg");
  if (!ffmpeg) throw Failure("no ffmpeg: films need it (cluster/setup installs it)");
  double all_s = 0.0;
  for (const Clip& clip : clips) all_s += clip.duration_s();
  FrameFile pictures(file);
  int drawn = 0;
  for (const Clip& clip : clips) {
    const Frames frames(clip);
    const int count = static_cast<int>(clip.duration_s() * kFramesPerSecond + 1e-9);
    for (int i = 0; i <= count; ++i) {
      pictures.add(frames.at(static_cast<double>(i) / kFramesPerSecond).png());
      progress(std::min(1.0, ++drawn / (all_s * kFramesPerSecond + 1.0)));
    }
  }
  encode(*ffmpeg, pictures.path(), file);
}

}  // namespace corridor::cluster
