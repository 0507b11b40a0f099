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

TEST(House, OnlyTheAllowedIncludeDirectionsAreUsed) {
  // Who may include what, the longest matching folder first.
  const std::vector<std::pair<std::string, std::vector<std::string>>> allowed = {
      {"proto/", {"proto/"}},
      {"scenarios/", {"scenarios/", "proto/"}},
      {"actor/driving/",
       {"actor/driving/", "proto/transition.h", "proto/settings.h", "proto/random.h",
        "proto/failure.h"}},
      {"actor/vehicle/", {"actor/vehicle/", "proto/failure.h"}},
      {"actor/world/", {"actor/world/", "actor/vehicle/", "actor/driving/", "proto/"}},
      {"actor/policy/", {"actor/policy/", "actor/driving/", "proto/"}},
      {"actor/", {"actor/", "proto/"}},
      {"replay/", {"replay/", "proto/"}},
      {"learner/", {"learner/", "proto/"}},
      {"cluster/", {"cluster/", "scenarios/", "proto/"}},
  };
  for (const std::string& file : sources()) {
    const auto rule = std::find_if(allowed.begin(), allowed.end(), [&](const auto& entry) {
      return file.starts_with(entry.first);
    });
    ASSERT_NE(rule, allowed.end()) << file;
    for (const std::string& include : includes_of(file)) {
      if (is_ours(include)) {
        EXPECT_TRUE(starts_with_any(include, rule->second)) << file << " includes " << include;
      }
    }
  }
}

TEST(House, EachForeignLibraryIsUsedByItsAdapterOnly) {
  const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> adapters = {
      {{"libsumo/", "xercesc/"}, {"actor/world/sumo_world.cc"}},
      {{"zmq"}, {"proto/endpoint.cc"}},
      {{"capnp/", "kj/", "proto/wire.capnp.h"}, {"proto/codec.cc"}},
      {{"torch/", "ATen/", "c10/"},
       {"learner/q_network.", "learner/torch_networks.", "learner/blas."}},
      {{"toml"}, {"proto/run_config.cc"}},
      {{"google/protobuf", "cluster/tensorboard_event.pb.h", "boost/"}, {"cluster/tensorboard.cc"}},
      {{"Eigen/"}, {"actor/policy/", "actor/driving/", "actor/vehicle/path_tracker."}},
      {{"ode/"}, {"actor/vehicle/ode_vehicle.cc"}},
      {{"webots/"}, {"actor/vehicle/webots_vehicle.h"}},
      {{"cairo"}, {"cluster/film.cc"}},
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
