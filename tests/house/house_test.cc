// SPDX-License-Identifier: Apache-2.0
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
    {"proto/wire/", {"proto/base/", "proto/settings/", "proto/system/"}},
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
      {{"torch/", "ATen/", "c10/"}, {"learner/torch_networks.", "learner/blas."}},
      {{"toml"}, {"proto/config/toml_library.h"}},
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
      {{"cairo"}, {"cluster/pictures/canvas.cc"}},
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

TEST(House, TheClockIsReadInOnePlaceAndTheCalendarForPeopleOnly) {
  static const std::regex kCalendar(
      R"(system_clock|CLOCK_REALTIME|gettimeofday|\btime\((nullptr|NULL|0)\))");
  for (const std::string& file : sources()) {
    if (file != "proto/system/clock.h") {
      EXPECT_EQ(content_of(kRoot / file).find("steady_clock"), std::string::npos) << file;
    }
    if (file.starts_with("cluster/")) continue;  // manifests, and events for TensorBoard
    EXPECT_FALSE(std::regex_search(content_of(kRoot / file), kCalendar)) << file;
  }
}

TEST(House, RandomNumbersComeFromCountersOnly) {
  static const std::regex kGenerator(
      R"(std::(mt19937|random_device|default_random_engine|uniform_\w+_distribution|rand\b))");
  for (const std::string& file : sources()) {
    EXPECT_FALSE(std::regex_search(content_of(kRoot / file), kGenerator)) << file;
  }
}

// Lines that begin with a row's first cell, "| `name` |", by the heading that they stand under.
std::map<std::string, std::multiset<std::string>> rows_by_section(const fs::path& document) {
  static const std::regex kHeading(R"(^#+ `([^`]+)`.*)");
  static const std::regex kRow(R"(^\| `([^`]+)` \|.*)");
  std::map<std::string, std::multiset<std::string>> rows;
  std::string section;
  std::istringstream lines(content_of(document));
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) section.clear();
    if (std::regex_match(line, match, kHeading)) section = match[1];
    if (std::regex_match(line, match, kRow)) rows[section].insert(match[1]);
  }
  return rows;
}

// The units of a room: a header and its source are one.
std::map<std::string, std::set<std::string>> units_by_room() {
  std::map<std::string, std::set<std::string>> units;
  for (const std::string& file : sources()) {
    const std::string room = room_of(file);
    units[room].insert(fs::path(file.substr(room.size())).replace_extension().string());
  }
  return units;
}

TEST(House, EveryRoomHasOneRowInTheArchitecture) {
  std::multiset<std::string> expected;
  for (const auto& [room, below] : kRooms) expected.insert(room.substr(0, room.size() - 1));
  std::multiset<std::string> written;
  for (const auto& [section, rows] : rows_by_section(kRoot / "docs" / "architecture.md")) {
    written.insert(rows.begin(), rows.end());
  }
  EXPECT_EQ(written, expected);
}

TEST(House, EveryFileHasOneRowInItsRoomsSection) {
  const auto rows = rows_by_section(kRoot / "docs" / "files.md");
  for (const auto& [room, units] : units_by_room()) {
    const auto section = rows.find(room.substr(0, room.size() - 1));
    ASSERT_NE(section, rows.end()) << room << " has no section";
    EXPECT_EQ(section->second, std::multiset<std::string>(units.begin(), units.end())) << room;
  }
}

TEST(House, OneNameIsOneThing) {
  std::map<std::string, std::set<std::string>> folders;
  for (const std::string& file : sources()) {
    folders[fs::path(file).stem().string()].insert(fs::path(file).parent_path().string());
  }
  for (const auto& [name, where] : folders) {
    if (name != "main") {
      EXPECT_EQ(where.size(), 1u) << name << " stands in " << *where.begin() << " and elsewhere";
    }
  }
}

TEST(House, TheArchitectureFitsThreeScreens) {
  const std::string text = content_of(kRoot / "docs" / "architecture.md");
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 150);
}

// The limits of the house's style.
TEST(House, FilesStaySmallEnoughToRead) {
  for (const std::string& file : sources()) {
    const std::string text = content_of(kRoot / file);
    const auto lines = std::count(text.begin(), text.end(), '\n');
    EXPECT_LE(lines, file.ends_with(".h") ? 250 : 500) << file;
  }
}

// As clang-format lays them out: a body ends at the brace in the column of its signature's first
// line, which follows the end of something else.
TEST(House, FunctionsFitAScreen) {
  static const std::regex kNoFunction(
      R"(^ *(if|for|while|switch|else|do|try|namespace|struct|class|enum|union|extern)\b.*)");
  static const std::regex kEnds(
      R"(.*[;{}]|\s*|\s*//.*|#.*| (public|private|protected):|template <.*>)");
  for (const std::string& file : sources()) {
    if (!file.ends_with(".h") && !file.ends_with(".cc")) continue;
    std::istringstream text(content_of(kRoot / file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    for (std::size_t brace = 0; brace < lines.size(); ++brace) {
      if (!lines[brace].ends_with("{") || lines[brace].find('}') != std::string::npos) continue;
      std::size_t first = brace;
      while (first > 0 && !std::regex_match(lines[first - 1], kEnds)) --first;
      const std::size_t column = lines[first].find_first_not_of(' ');
      if (column > 2 || lines[first].find('(') == std::string::npos) continue;  // of a class
      if (std::regex_match(lines[first], kNoFunction)) continue;
      const std::string end = std::string(column, ' ') + "}";
      std::size_t last = brace + 1;
      while (last < lines.size() && !lines[last].starts_with(end)) ++last;
      EXPECT_LE(last - first + 1, 70u) << file << ":" << first + 1;
    }
  }
}

TEST(House, LinesFitTheirColumns) {
  for (const std::string& file : sources()) {
    std::istringstream text(content_of(kRoot / file));
    int number = 1;
    for (std::string line; std::getline(text, line); ++number) {
      EXPECT_LE(line.size(), 100u) << file << ":" << number;
    }
  }
}

// Beside the product's: tests, scenarios, scripts and CMake's files, but for what programs wrote.
TEST(House, EverySourceNamesItsLicense) {
  static const std::regex kSource(R"(.*\.(h|cc|hpp|capnp|proto|toml|py)|(.*/)?CMakeLists\.txt)");
  std::size_t checked = 0;
  const auto check = [&](const fs::path& path) {
    const std::string file = fs::relative(path, kRoot).string();
    std::istringstream text(content_of(path));
    std::string line;
    std::getline(text, line);
    const bool is_script = line.starts_with("#!");
    if (!is_script && !std::regex_match(file, kSource)) return;
    if (is_script) std::getline(text, line);
    EXPECT_TRUE(line == "// SPDX-License-Identifier: Apache-2.0" ||
                line == "# SPDX-License-Identifier: Apache-2.0")
        << file << " begins with " << line;
    ++checked;
  };
  check(kRoot / "CMakeLists.txt");
  check(kRoot / ".ci" / "run");
  for (const char* folder :
       {"proto", "scenarios", "actor", "replay", "learner", "cluster", "docs", "tests"}) {
    for (fs::recursive_directory_iterator entry(kRoot / folder), end; entry != end; ++entry) {
      const std::string name = fs::relative(entry->path(), kRoot).string();
      if (name == "tests/fuzz/corpus" || name == "scenarios/trained") {
        entry.disable_recursion_pending();
      } else if (entry->is_regular_file()) {
        check(entry->path());
      }
    }
  }
  EXPECT_GT(checked, 400u);
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
