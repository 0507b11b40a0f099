// SPDX-License-Identifier: Apache-2.0
// What is installed works where it lies, and is what it should be.
#include <gmock/gmock.h>

#include "tests/e2e/run_support.h"

namespace corridor::e2e {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;
using testing::UnorderedElementsAre;

// Installed for /usr, below a folder of the test's.
class Install : public testing::Test {
 protected:
  Install() {
    const std::string build = fs::path(CORRIDOR_BIN_DIR).parent_path();
    const auto installed = run_command({"cmake", "--install", build, "--prefix", "/usr"},
                                       kDeadline_s, {{"DESTDIR", folder_.path()}});
    EXPECT_EQ(installed.status, 0) << installed.output;
  }

  std::vector<std::string> names(const char* folder) {
    return testing_support::names_in(usr_ / folder);
  }

  TemporaryDirectory folder_;
  const fs::path usr_ = folder_.path() / "usr";
};

TEST_F(Install, HasTheProgramsScenariosAndPagesAndNothingElse) {
  EXPECT_THAT(names("."), UnorderedElementsAre("bin", "libexec", "share"));
  EXPECT_THAT(names("bin"), ElementsAre("corridor"));
  EXPECT_THAT(
      names("libexec/corridor"),
      UnorderedElementsAre("corridor", "corridor-actor", "corridor-learner", "corridor-replay"));
  EXPECT_THAT(names("share/corridor"), UnorderedElementsAre("scenarios", "trained"));
  EXPECT_THAT(names("share/corridor/scenarios"), IsSupersetOf({"paper.toml", "experiments"}));
  EXPECT_THAT(names("share/corridor/trained/paper"),
              UnorderedElementsAre("config.toml", "manifest.json", "networks.safetensors"));
  EXPECT_THAT(
      names("share/doc/corridor"),
      UnorderedElementsAre("README.md", "CHANGELOG.md", "changelog.gz", "copyright", "docs"));
  EXPECT_THAT(names("share/bash-completion/completions"), ElementsAre("corridor"));
  EXPECT_THAT(names("share/man/man1"), ElementsAre("corridor.1.gz"));
}

TEST_F(Install, NamesNothingOfTheBuild) {
  for (const std::string& program : names("libexec/corridor")) {
    const auto read = run_command(
        {"readelf", "--dynamic", (usr_ / "libexec/corridor" / program).string()}, kDeadline_s);
    EXPECT_EQ(read.status, 0) << read.output;
    EXPECT_THAT(read.output, Not(testing::ContainsRegex("R(UN)?PATH"))) << program;
  }
}

TEST_F(Install, ItsCommandFindsItsActors) {
  const std::string corridor = usr_ / "bin/corridor";
  const std::string share = usr_ / "share/corridor";
  const auto at_home = [&](std::vector<std::string> command) {
    command.insert(command.begin(), {"env", "--chdir", folder_.path(), corridor});
    return run_command(command, kDeadline_s);
  };
  const auto checked = at_home({"check", share + "/scenarios/dense.toml"});
  EXPECT_EQ(checked.status, 0) << checked.output;
  const auto driven = at_home({"evaluate", share + "/trained/paper", "--planners", "hierarchical",
                               "--seeds", "1", "--steps", "100"});
  EXPECT_EQ(driven.status, 0) << driven.output;
  EXPECT_THAT(driven.output, HasSubstr("hierarchical"));
}

}  // namespace
}  // namespace corridor::e2e
