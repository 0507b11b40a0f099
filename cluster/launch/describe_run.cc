// SPDX-License-Identifier: Apache-2.0
#include "cluster/launch/describe_run.h"

#include <array>
#include <chrono>
#include <cstring>
#include <ctime>
#include <fstream>
#include <thread>

#include "proto/base/failure.h"
#include "proto/config/run_config.h"
#include "proto/run/run_directory.h"
#include "proto/system/identity.h"
#include "proto/system/program.h"
#include "proto/system/subprocess.h"

namespace corridor::cluster {
namespace {

constexpr const char* kUnknown = "unknown";

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t value = line.find(": ");
    if (value != std::string::npos) return line.substr(value + 2);
  }
  return kUnknown;
}

constexpr std::chrono::seconds kPatience{60};

// "Eclipse SUMO netconvert Version 1.15.0": the tool that has just made the network.
std::string sumo_version() {
  const auto netconvert = find_program("netconvert");
  if (!netconvert) return kUnknown;
  const auto said = run_subprocess(*netconvert, {"--version"}, "", kPatience);
  const std::string text = said ? said->output : "";
  const std::size_t at = text.find("Version ");
  if (at == std::string::npos) return kUnknown;
  const std::size_t start = at + std::strlen("Version ");
  return text.substr(start, text.find_first_of(" \n", start) - start);
}

// Which library Debian's alternatives have the learner load.
std::string blas_library() {
  std::error_code missing;
  const auto library = std::filesystem::canonical(CORRIDOR_BLAS_LINK, missing);
  return missing ? kUnknown : library.string();
}

}  // namespace

std::string draw_run_id() {
  return fmt::format("{:016x}{:016x}", random_64_bits(), random_64_bits());
}

RunVersions versions_here() {
  return {kVersion,       CORRIDOR_GIT_COMMIT, sumo_version(), CORRIDOR_TORCH_VERSION,
          blas_library(), CORRIDOR_COMPILER};
}

RunManifest describe_run(const std::string& run_id, std::uint64_t seed,
                         const std::filesystem::path& scenario, const std::string& config_toml,
                         const RunVersions& versions) {
  RunManifest manifest;
  manifest.run_id = run_id;
  manifest.seed = seed;
  manifest.scenario = std::filesystem::absolute(scenario).string();
  manifest.started = utc_now();
  manifest.host = host_name();
  manifest.cpu = cpu_model();
  manifest.cores = std::thread::hardware_concurrency();
  manifest.versions = versions;
  manifest.config = config_toml;
  return manifest;
}

RunConfig config_at_start(const RunDirectory& directory) {
  return parse_run_config(read_manifest(directory).config, directory.manifest().string());
}

}  // namespace corridor::cluster
