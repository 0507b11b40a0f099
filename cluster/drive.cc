// SPDX-License-Identifier: Apache-2.0
#include "cluster/drive.h"

#include <chrono>
#include <cmath>

#include "cluster/launch/traced_episode.h"
#include "cluster/pictures/clip.h"
#include "cluster/pictures/contact_sheet.h"
#include "cluster/pictures/film.h"
#include "cluster/pictures/player.h"
#include "cluster/watch/display.h"
#include "proto/base/failure.h"
#include "proto/base/format.h"
#include "proto/run/evaluation_record.h"
#include "proto/run/run_directory.h"
#include "proto/system/clock.h"
#include "proto/system/files.h"

namespace corridor::cluster {
namespace {

namespace fs = std::filesystem;

// What is shown before a collision.
constexpr double kBeforeCollision_s = 8.0;

constexpr std::chrono::minutes kPatience{10};
constexpr double kLongest_s = 1e6;

EpisodeTrace recorded(const EvaluationPlace& place, const fs::path& file) {
  return traced_by_actor(place.directory, TraceTask{file, place.trained.root()}, kPatience);
}

std::string in_world(const EvaluationPlace& place) {
  const WorldKind world = place.config.dynamics.world;
  return world == WorldKind::kKinematic ? std::string() : fmt::format(", {}", name_of(world));
}

std::vector<Clip> collisions(const EvaluationPlace& place, const DriveOptions& options) {
  std::vector<Clip> clips;
  for (const EvaluationRecord& result : read_evaluations(place.directory.evaluation())) {
    if (result.planner != options.planner || result.seed != options.seed.value_or(result.seed))
      continue;
    for (std::size_t i = 0; i < result.per_episode.size(); ++i) {
      if (result.per_episode[i].collisions == 0) continue;
      if (static_cast<int>(clips.size()) == options.most) return clips;
      const std::string name =
          EpisodeName{result.planner, result.seed, result.per_episode[i].episode}.text();
      const EpisodeTrace trace = recorded(place, find_episode(place.directory, name));
      const double end_s = trace.step_s * static_cast<double>(trace.steps.size() - 1);
      clips.push_back(clip_of(
          trace, fmt::format("{}{}: {}", name, in_world(place), name_of(trace.collision->kind)),
          end_s - kBeforeCollision_s, end_s));
    }
  }
  if (clips.empty()) {
    throw Failure("{} has no collision of {}: evaluate it first, or look at another planner",
                  place.directory.evaluation().string(), options.planner);
  }
  return clips;
}

}  // namespace

int drive(const DriveOptions& options) {
  const auto positive = [](double time_s) { return time_s > 0.0 && time_s <= kLongest_s; };
  if (!positive(options.seconds) || !positive(options.interval_s) ||
      !(options.from_s >= 0.0 && options.from_s <= kLongest_s)) {
    throw Failure("--from {} --seconds {} --interval {}: give a stretch of time", options.from_s,
                  options.seconds, options.interval_s);
  }
  if (options.film) find_ffmpeg();
  const EvaluationPlace place = evaluation_place(options.run, options.world);
  const fs::path out = options.out.empty() ? place.directory.root() / "drives" : options.out;
  check_folder_for_results(out);
  std::vector<Clip> clips;
  std::string name;
  if (options.collisions) {
    clips = collisions(place, options);
    name = options.planner + "_collisions";
  } else if (!options.episode.empty()) {
    const fs::path file = find_episode(place.directory, options.episode);
    name = file.stem().string();
    clips.push_back(clip_of(recorded(place, file), name + in_world(place), options.from_s,
                            options.from_s + options.seconds));
  } else {
    check_can_drive(options.planner, place);
    const std::uint64_t seed = options.seed.value_or(place.config.evaluation.seeds.front());
    const auto steps = static_cast<std::int64_t>(
        std::ceil((options.from_s + options.seconds) / place.config.simulation.step_s));
    name = EpisodeName{options.planner, seed, options.number}.text();
    const EpisodeTrace trace = traced_by_actor(
        place.directory,
        DriveTask{options.planner, seed, options.number, steps, place.trained.root()}, kPatience);
    clips.push_back(
        clip_of(trace, name + in_world(place), options.from_s, options.from_s + options.seconds));
  }
  for (Clip& clip : clips) clip.speed_changes_mps = place.config.planner.speed_changes_mps;

  create_folders(out);
  const fs::path film = out / (name + ".mp4"), sheet = out / (name + ".png"),
                 player = out / (name + ".html");
  write_file(sheet, contact_sheet(clips, options.interval_s).png());
  write_file(player, player_page(clips));
  fmt::print("contact sheet {}\nplayer {}\n", sheet.string(), player.string());
  if (options.film) {
    ProgressDisplay progress;
    write_film(clips, film, [&](double share) {
      progress.show({fmt::format("film {:.0f} %", 100 * share)}, monotonic_s());
    });
    fmt::print("film {}\n", film.string());
  }
  double seconds = 0.0;
  for (const Clip& clip : clips) seconds += clip.duration_s();
  fmt::print("{:.0f} s of driving{}\n", seconds,
             clips.back().trace.collision ? ", ends with a collision" : "");
  return 0;
}

}  // namespace corridor::cluster
