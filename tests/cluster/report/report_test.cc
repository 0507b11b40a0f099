// SPDX-License-Identifier: Apache-2.0
#include "cluster/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>

#include "proto/base/failure.h"
#include "proto/system/files.h"
#include "tests/support/fake_run.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;
using testing_support::fake_run_config;
using testing_support::make_fake_run;

class Report : public testing::Test {
 protected:
  Report() {
    make_fake_run(one_, fake_run_config(1), 100.0);
    make_fake_run(two_, fake_run_config(2), 200.0);
  }

  static std::map<std::string, std::string> files(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      files[entry.path().filename()] = read_file(entry.path());
    }
    return files;
  }

  testing_support::TemporaryDirectory temporary_;
  std::filesystem::path one_ = temporary_.path() / "one", two_ = temporary_.path() / "two";
  std::filesystem::path out_ = temporary_.path() / "out" / "of" / "it";
};

TEST_F(Report, IsAPageWithItsFiguresBesideIt) {
  EXPECT_EQ(report({{one_, two_}, out_}), 0);
  const auto written = files(out_);
  std::set<std::string> names;
  for (const auto& [name, content] : written) names.insert(name);
  EXPECT_EQ(names, (std::set<std::string>{"report.html", "mop_training.svg", "mop_training.png",
                                          "mop_learning.svg", "mop_learning.png",
                                          "mop_selection.svg", "mop_selection.png"}));
  EXPECT_THAT(written.at("mop_training.png"), StartsWith("\x89PNG"));
  EXPECT_THAT(written.at("mop_training.svg"), HasSubstr("lowest to highest"));
  const std::string& page = written.at("report.html");
  EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(page, HasSubstr("lowest to highest"));
  EXPECT_THAT(page, HasSubstr("2 training seeds"));
}

TEST_F(Report, OfTheSameRunsIsTheSame) {
  report({{one_}, {}});
  report({{one_}, out_});
  EXPECT_EQ(files(one_ / "report"), files(out_));
}

TEST_F(Report, ThatCannotBeMadeWritesNothing) {
  EXPECT_THROW(report({{one_, temporary_.path() / "missing"}, out_}), Failure);
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(Report, NamesAFolderThatCannotBeWritten) {
  write_file(temporary_.path() / "file", "");
  EXPECT_THAT(
      [&] {
        report({{one_}, temporary_.path() / "file" / "out"});
      },
      ThrowsMessage<Failure>(HasSubstr("file/out")));
}

}  // namespace
}  // namespace corridor::cluster
