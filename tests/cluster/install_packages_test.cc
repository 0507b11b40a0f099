// SPDX-License-Identifier: Apache-2.0
// The script cluster/install_packages, on machines that are made up: dpkg-query, apt-get, apt-cache
// and id are scripts of ours.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/command.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing_support::CommandResult;

class InstallPackages : public testing::Test {
 protected:
  InstallPackages() {
    write("list.txt", "# comment\none\n\ntwo\n");
    release("ID=debian\nVERSION_ID=\"13\"\nPRETTY_NAME=\"Debian 13\"");
    program("dpkg-query", "echo installed");
    program("apt-cache", "echo $2 is there");
    program("apt-get", "echo apt-get $* >&2");
    user(0);
  }
  void release(const std::string& text) { write("os-release", text); }
  void program(const std::string& name, const std::string& script) {
    write(name, "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(directory_.path() / name, std::filesystem::perms::owner_all);
  }
  void user(int id) { program("id", "echo " + std::to_string(id)); }

  CommandResult run() {
    const std::string directory = directory_.path().string();
    return testing_support::run_command(
        {std::string(CORRIDOR_SOURCE_DIR) + "/cluster/install_packages", directory + "/list.txt"},
        60.0,
        {{"PATH", directory + ":/usr/bin:/bin"},
         {"CORRIDOR_OS_RELEASE", directory + "/os-release"}});
  }

 private:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(directory_.path() / name) << text;
  }
  testing_support::TemporaryDirectory directory_;
};

TEST_F(InstallPackages, SaysNothingAndNeedsNoNetworkWhereAllAreInstalled) {
  const CommandResult result = run();
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.output, "");
}

TEST_F(InstallPackages, AnotherReleaseIsNamedAndItGoesOn) {
  release("ID=ubuntu\nVERSION_ID=\"24.04\"\nPRETTY_NAME=\"Ubuntu 24.04.1 LTS\"");
  EXPECT_EQ(run().output,
            "corridor: this is Ubuntu 24.04.1 LTS; it is tested on Debian 12 and 13 only\n");
  release("ID=debian\nPRETTY_NAME=\"Debian GNU/Linux forky/sid\"");
  const CommandResult result = run();
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.output, HasSubstr("this is Debian GNU/Linux forky/sid;"));
}

TEST_F(InstallPackages, WhatIsHalfInstalledIsNamed) {
  program("dpkg-query", "[ $4 = two ] && echo half-configured || echo installed");
  const CommandResult result = run();
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.output, AllOf(HasSubstr("two (half-configured)"),
                                   HasSubstr("dpkg --configure -a"), Not(HasSubstr("one"))));
}

TEST_F(InstallPackages, AUserIsToldWhatToRunAsRoot) {
  program("dpkg-query", "[ $4 = two ] && exit 1 || echo installed");
  user(1000);
  const CommandResult result = run();
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.output, HasSubstr("apt-get install -y --no-install-recommends two\n"));
}

TEST_F(InstallPackages, RootInstallsWhatIsMissing) {
  program("dpkg-query", "echo config-files");
  const CommandResult result = run();
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("apt-get update"),
                    HasSubstr("apt-get install -y -qq --no-install-recommends one two\n")));
}

TEST_F(InstallPackages, WhatNoArchiveHasIsNamed) {
  program("dpkg-query", "exit 1");
  program("apt-cache", "[ $2 = two ] || echo $2 is there");
  const CommandResult result = run();
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("in none of the archives of /etc/apt/sources.list*: two\n"),
                    Not(HasSubstr("apt-get install"))));
}

}  // namespace
}  // namespace corridor
