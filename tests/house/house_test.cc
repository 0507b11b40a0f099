// The rules of docs/architecture.md that a compiler does not check.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = CORRIDOR_SOURCE_DIR;

std::string content_of(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

// Headers and sources of the product, relative to the root.
std::vector<std::string> sources() {
  std::vector<std::string> result;
  for (const char* folder : {"proto", "scenarios", "actor", "replay", "learner", "cluster"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      const auto extension = entry.path().extension();
      if (extension == ".h" || extension == ".cc" || extension == ".capnp" ||
          extension == ".proto") {
        result.push_back(fs::relative(entry.path(), kRoot).string());
      }
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<std::string> includes_of(const std::string& file) {
  static const std::regex kInclude(R"(^\s*#include\s+[<"]([^>"]+)[>"])", std::regex::multiline);
  const std::string text = content_of(kRoot / file);
  std::vector<std::string> result;
  for (std::sregex_iterator it(text.begin(), text.end(), kInclude), end; it != end; ++it) {
    result.push_back((*it)[1]);
  }
  return result;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const std::string& prefix) { return text.starts_with(prefix); });
}

bool is_ours(const std::string& include) {
  return starts_with_any(include,
                         {"proto/", "scenarios/", "actor/", "replay/", "learner/", "cluster/"});
}

// The rooms, and which rooms each may include beside itself; a room has the files of its folder
// that are in no deeper room. docs/architecture.md draws it.
const std::vector<std::pair<std::string, std::vector<std::string>>> kRooms = {
    {"proto/base/", {}},
    {"proto/settings/", {"proto/base/"}},
    {"proto/system/", {"proto/base/"}},
    {"proto/config/", {"proto/base/", "proto/settings/", "proto/system/"}},
    {"proto/wire/", {"proto/base/", "proto/settings/"}},
    {"proto/run/", {"proto/base/", "proto/settings/", "proto/system/", "proto/config/"}},
    {"scenarios/", {"proto/base/", "proto/settings/", "proto/system/"}},
    {"actor/algebra/", {}},
    {"actor/driving/", {"proto/base/", "proto/settings/"}},
    {"actor/vehicle/", {"proto/base/", "actor/algebra/"}},
    {"actor/world/",
     {"proto/base/", "proto/settings/", "proto/system/", "actor/driving/", "actor/vehicle/"}},
    {"actor/policy/", {"proto/base/", "proto/settings/", "actor/algebra/", "actor/driving/"}},
    {"actor/", {"proto/", "actor/driving/", "actor/world/", "actor/policy/"}},
    {"replay/", {"proto/"}},
    {"learner/", {"proto/"}},
    {"cluster/launch/", {"proto/"}},
    {"cluster/watch/", {"proto/"}},
    {"cluster/results/", {"proto/"}},
    {"cluster/pictures/", {"proto/", "cluster/results/"}},
    {"cluster/report/", {"proto/", "cluster/launch/", "cluster/results/", "cluster/pictures/"}},
    {"cluster/",
     {"proto/", "scenarios/", "cluster/launch/", "cluster/watch/", "cluster/results/",
      "cluster/pictures/", "cluster/report/"}},
};

// The longest match.
std::string room_of(const std::string& file) {
  std::string best;
  for (const auto& [room, below] : kRooms) {
    if (file.starts_with(room) && room.size() > best.size()) best = room;
  }
  return best;
}

TEST(House, OnlyTheAllowedIncludeDirectionsAreUsed) {
  std::map<std::string, std::vector<std::string>> below(kRooms.begin(), kRooms.end());
  for (const std::string& file : sources()) {
    const std::string room = room_of(file);
    ASSERT_FALSE(room.empty()) << file;
    for (const std::string& include : includes_of(file)) {
      if (!is_ours(include)) continue;
      const std::string other = room_of(include);
      EXPECT_TRUE(other == room || starts_with_any(other, below[room]))
          << file << " includes " << include;
    }
  }
}

// Rooms stand in dependency order, so no chain of them leads back.
TEST(House, EveryRoomStandsOnRoomsBeforeIt) {
  std::vector<std::string> before;
  for (const auto& [room, below] : kRooms) {
    for (const std::string& lower : below) {
      EXPECT_TRUE(
          std::any_of(before.begin(), before.end(),
                      [&](const std::string& earlier) { return earlier.starts_with(lower); }))
          << room << " stands on " << lower;
    }
    before.push_back(room);
  }
}

TEST(House, EachForeignLibraryIsUsedByItsAdapterOnly) {
  const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> adapters = {
      {{"libsumo/", "xercesc/"}, {"actor/world/sumo_world.cc"}},
      {{"zmq"}, {"proto/wire/endpoint.cc"}},
      {{"capnp/", "kj/", "proto/wire/wire.capnp.h"}, {"proto/wire/codec.cc"}},
      {{"torch/", "ATen/", "c10/"},
       {"learner/torch_q_network.", "learner/torch_networks.", "learner/blas."}},
      {{"toml"}, {"proto/config/run_config.cc"}},
      {{"google/protobuf", "cluster/watch/tensorboard_event.pb.h", "boost/"},
       {"cluster/watch/tensorboard.cc"}},
      {{"Eigen/"}, {"actor/algebra/matrix.h"}},
      {{"nlohmann/"}, {"proto/base/json.h", "proto/base/json_fwd.h"}},
      {{"spdlog/fmt"}, {"proto/base/format.h"}},
      {{"spdlog/spdlog", "spdlog/sinks"}, {"proto/system/log.cc"}},
      {{"xxhash"}, {"proto/base/hash.h"}},
      {{"CLI/"}, {"proto/system/command_line.h"}},
      {{"ode/"}, {"actor/vehicle/ode_vehicle.cc"}},
      {{"webots/"}, {"actor/vehicle/webots_vehicle.h"}},
      {{"cairo"}, {"cluster/pictures/film.cc"}},
  };
  for (const std::string& file : sources()) {
    for (const std::string& include : includes_of(file)) {
      for (const auto& [library, homes] : adapters) {
        if (starts_with_any(include, library)) {
          EXPECT_TRUE(starts_with_any(file, homes)) << file << " includes " << include;
        }
      }
    }
  }
}

TEST(House, TheDrivingDomainKnowsNoSimulatorSocketClockOrLog) {
  for (const std::string& file : sources()) {
    if (!file.starts_with("actor/driving/")) continue;
    for (const std::string& include : includes_of(file)) {
      const bool foreign = starts_with_any(
          include, {"chrono", "thread", "iostream", "fstream", "spdlog/spdlog", "random", "ctime"});
      EXPECT_FALSE(foreign) << file << " includes " << include;
    }
  }
}

TEST(House, RandomNumbersComeFromCountersOnly) {
  static const std::regex kGenerator(
      R"(std::(mt19937|random_device|default_random_engine|uniform_\w+_distribution|rand\b))");
  for (const std::string& file : sources()) {
    EXPECT_FALSE(std::regex_search(content_of(kRoot / file), kGenerator)) << file;
  }
}

TEST(House, ArchitectureNamesEveryFile) {
  const std::string text = content_of(kRoot / "docs" / "architecture.md");
  ASSERT_FALSE(text.empty());
  for (const std::string& file : sources()) {
    const std::string stem = fs::path(file).stem().string();
    EXPECT_TRUE(std::regex_search(text, std::regex("\\b" + stem + "\\b"))) << file;
  }
}

TEST(House, FilesStaySmallEnoughToRead) {
  for (const std::string& file : sources()) {
    const std::string text = content_of(kRoot / file);
    const auto lines = std::count(text.begin(), text.end(), '\n');
    EXPECT_LE(lines, file.ends_with(".h") ? 300 : 550) << file;
  }
}

TEST(House, EveryPackageIsNamedOnce) {
  std::istringstream lines(content_of(kRoot / "cluster" / "packages.txt"));
  std::set<std::string> seen;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.starts_with("#")) continue;
    EXPECT_TRUE(seen.insert(line).second) << line;
  }
  EXPECT_TRUE(seen.contains("libopenblas0-serial"));
}

}  // namespace
