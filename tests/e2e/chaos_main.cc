// SPDX-License-Identifier: Apache-2.0
// chaos SCENARIO: trains it undisturbed, then again and again while processes are killed, stopped
// and asked to end at random, and compares the fingerprints. docs/operations.md quotes it.
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>

#include "proto/system/command_line.h"
#include "proto/system/program.h"
#include "tests/e2e/chaos.h"
#include "tests/support/command.h"

namespace {

using namespace corridor;
namespace fs = std::filesystem;

struct Options {
  std::string scenario;
  fs::path directory;
  std::vector<std::string> settings;
  std::string footprint;
  double minutes = 1.0;
  e2e::ChaosSettings chaos;
};

std::vector<std::string> train_command(const Options& options) {
  std::vector<std::string> command = {std::string(CORRIDOR_BIN_DIR) + "/corridor", "train",
                                      options.scenario};
  for (const std::string& setting : options.settings) {
    command.insert(command.end(), {"--set", setting});
  }
  return command;
}

int run(Options options) {
  fs::create_directories(options.directory);
  options.chaos.train = train_command(options);
  options.chaos.run = options.directory / "undisturbed";
  fs::remove_all(options.chaos.run);
  e2e::ChaosSettings calm = options.chaos;
  calm.most = 0;
  const e2e::ChaosResult undisturbed = e2e::train_in_chaos(calm, [](const e2e::Footprint&) {});
  std::printf("undisturbed: %s in %.0f s\n%s", undisturbed.fingerprint.c_str(), undisturbed.seconds,
              undisturbed.trouble.c_str());
  if (!undisturbed.trouble.empty()) return 1;

  std::ofstream footprint(options.footprint);
  footprint << "# time_s processes memory_mb descriptors disk_mb\n";
  options.chaos.run = options.directory / "disturbed";
  std::map<e2e::Disturbance, int> all;
  double seconds = 0.0;
  int trainings = 0, resumes = 0;
  while (seconds < 60.0 * options.minutes && !stop_requested()) {
    fs::remove_all(options.chaos.run);
    const e2e::ChaosResult result =
        e2e::train_in_chaos(options.chaos, [&](const e2e::Footprint& now) {
          footprint << seconds + now.time_s << ' ' << now.processes << ' ' << now.memory_mb << ' '
                    << now.descriptors << ' ' << now.disk_mb << std::endl;
        });
    ++options.chaos.seed;
    ++trainings;
    seconds += result.seconds;
    resumes += result.resumes;
    int count = 0;
    for (const auto& [what, times] : result.disturbances) {
      all[what] += times;
      count += times;
    }
    std::printf("training %d: %s after %d disturbances, %d resumes, %.0f s\n", trainings,
                result.fingerprint.c_str(), count, result.resumes, result.seconds);
    std::fflush(stdout);
    if (!result.trouble.empty() || result.fingerprint != undisturbed.fingerprint) {
      std::printf("NOT as undisturbed: %s\n", result.trouble.c_str());
      return 1;
    }
  }
  for (const auto& [what, times] : all) {
    std::printf("  %-24s %d\n", e2e::disturbance_name(what), times);
  }
  std::printf("%d trainings in %.0f min, %d resumes: all as undisturbed\n", trainings,
              seconds / 60.0, resumes);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Trains while processes are killed at random, and compares the result");
  app.add_option("SCENARIO", options.scenario)->required();
  app.add_option("--directory", options.directory, "where the runs go")->required();
  app.add_option("--set", options.settings, "table.key=value, as of corridor train")
      ->allow_extra_args(false);
  app.add_option("--seed", options.chaos.seed, "of what happens when");
  app.add_option("--every", options.chaos.every_s, "mean seconds between disturbances");
  app.add_option("--most", options.chaos.most, "disturbances of one training");
  app.add_option("--minutes", options.minutes, "trains again until so long is over");
  app.add_option("--deadline", options.chaos.deadline_s, "seconds that one training may take");
  app.add_option("--footprint", options.footprint, "file for memory, descriptors, disk over time");
  CLI11_PARSE(app, argc, argv);
  return run_program("chaos", [&] { return run(options); });
}
