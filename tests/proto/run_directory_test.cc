#include "proto/run_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "proto/settings.h"
#include "tests/proto/failure_of.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

// Without write_file's cost; removed first, since some file systems flush what is overwritten.
void damage(const fs::path& file, const std::string& content) {
  fs::remove(file);
  std::ofstream(file, std::ios::binary) << content;
}

std::vector<std::string> names_in(const fs::path& directory) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

class Files : public testing::Test {
 protected:
  testing_support::TemporaryDirectory directory_;
  fs::path file_ = directory_.path() / "file";
};

TEST_F(Files, AreWrittenWholeAndReadBack) {
  const std::string content = std::string("a\0b\n", 4) + std::string(1'000'000, 'x');
  write_file(file_, content);
  EXPECT_EQ(read_file(file_), content);
  write_file(file_, "");
  EXPECT_EQ(read_file(file_), "");
  EXPECT_THAT(names_in(directory_.path()), UnorderedElementsAre("file"));
}

TEST_F(Files, ThatCannotBeWrittenAreNamedWithTheReason) {
  EXPECT_THAT(failure_of([] { write_file("/nowhere/at/all", "x"); }),
              AllOf(HasSubstr("/nowhere/at/all"), HasSubstr("No such file")));
  fs::create_directory(file_);
  write_file(file_ / "inside", "x");
  EXPECT_THAT(failure_of([&] { write_file(file_, "x"); }), HasSubstr("directory"));
  EXPECT_THAT(names_in(directory_.path()), UnorderedElementsAre("file"));
}

// Writes with a limit on file sizes, which fails in the middle of a file as a full disk does.
[[noreturn]] void write_beyond_the_limit(const fs::path& file) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{1000, 1000};
  setrlimit(RLIMIT_FSIZE, &limit);
  const std::string failure = failure_of([&] { write_file(file, std::string(5000, 'n')); });
  std::fprintf(stderr, "%s\n", failure.c_str());
  std::exit(failure == "no failure" ? 1 : 0);
}

TEST_F(Files, AFullDiskLeavesTheOldFileAndNothingBesideIt) {
  write_file(file_, "old");
  EXPECT_EXIT(write_beyond_the_limit(file_), testing::ExitedWithCode(0), "File too large");
  EXPECT_EQ(read_file(file_), "old");
  EXPECT_THAT(names_in(directory_.path()), UnorderedElementsAre("file"));
}

TEST_F(Files, ThatCannotBeReadAreNamedWithTheReason) {
  EXPECT_THAT(failure_of([&] { read_file(file_); }),
              AllOf(HasSubstr(file_.string()), HasSubstr("No such file")));
  EXPECT_THAT(failure_of([&] { read_file(directory_.path()); }), HasSubstr("Is a directory"));
}

TEST_F(Files, OfUnknownSizeAreReadToTheEnd) {
  EXPECT_THAT(read_file("/proc/self/status"), HasSubstr("VmRSS"));
}

TEST_F(Files, ThatAreNoJsonAreNamed) {
  write_file(file_, "{\"a\": 1}");
  EXPECT_EQ(read_json(file_).at("a"), 1);
  write_file(file_, "{\"a\": ");
  EXPECT_THAT(failure_of([&] { read_json(file_); }),
              AllOf(HasSubstr(file_.string()), HasSubstr("is not JSON")));
}

class Runs : public testing::Test {
 protected:
  RunDirectory create() const { return RunDirectory::create(root_); }

  static void add_checkpoint(const RunDirectory& run, std::uint64_t round, int kept = 2) {
    const fs::path partial = run.begin_checkpoint(round);
    write_file(partial / "learner.safetensors", "learner " + std::to_string(round));
    write_file(partial / "replay.safetensors", "replay " + std::to_string(round));
    run.commit_checkpoint(round, kept);
  }

  testing_support::TemporaryDirectory directory_;
  fs::path root_ = directory_.path() / "runs" / "one";
};

TEST_F(Runs, AreCreatedOnceWithTheirFolders) {
  const RunDirectory run = create();
  for (const fs::path& file : {run.network(), run.log("learner"), run.metrics("actor-0"),
                               run.evaluation() / "x", run.episodes() / "x"}) {
    EXPECT_TRUE(fs::is_directory(file.parent_path())) << file;
  }
  EXPECT_EQ(run.log("learner"), root_ / "log" / "learner.log");
  EXPECT_EQ(run.metrics("actor-0"), root_ / "metrics" / "actor-0.jsonl");
  EXPECT_THAT(failure_of([&] { create(); }),
              AllOf(HasSubstr(root_.string()), HasSubstr("exists already")));
}

TEST_F(Runs, ThatCannotBeCreatedAreNamed) {
  EXPECT_THAT(failure_of([] { RunDirectory::create("/proc/nothing/run"); }),
              HasSubstr("cannot create /proc/nothing/run"));
}

TEST_F(Runs, NeedAConfigAndAManifestToBeOpened) {
  EXPECT_THAT(failure_of([&] { RunDirectory::open(root_); }), HasSubstr("config.toml is missing"));
  const RunDirectory run = create();
  write_file(run.config(), "");
  EXPECT_THAT(failure_of([&] { RunDirectory::open(root_); }),
              HasSubstr("manifest.json is missing"));
  write_file(run.manifest(), "{}");
  EXPECT_EQ(RunDirectory::open(root_).root(), root_);
}

TEST_F(Runs, HaveNoCheckpointAtFirst) { EXPECT_EQ(create().newest_checkpoint(), std::nullopt); }

TEST_F(Runs, CommittedCheckpointsAreFoundAndOldOnesRemoved) {
  const RunDirectory run = create();
  for (const std::uint64_t round : {7, 9, 10, 100}) add_checkpoint(run, round);
  EXPECT_EQ(run.newest_checkpoint(), root_ / "checkpoints" / "100");
  EXPECT_EQ(read_file(*run.newest_checkpoint() / "replay.safetensors"), "replay 100");
  EXPECT_THAT(names_in(root_ / "checkpoints"), UnorderedElementsAre("10", "100", "CURRENT"));
}

TEST_F(Runs, AnUncommittedCheckpointDoesNotCount) {
  const RunDirectory run = create();
  add_checkpoint(run, 7);
  write_file(run.begin_checkpoint(9) / "learner.safetensors", "half");
  EXPECT_EQ(run.newest_checkpoint(), root_ / "checkpoints" / "7");
  EXPECT_THAT(names_in(run.begin_checkpoint(9)), testing::IsEmpty());
  add_checkpoint(run, 11);
  EXPECT_THAT(names_in(root_ / "checkpoints"), UnorderedElementsAre("7", "11", "CURRENT"));
}

TEST_F(Runs, GoneBackToAnEarlierCheckpointTheyDropTheLaterOnes) {
  const RunDirectory run = create();
  for (const std::uint64_t round : {7, 9}) add_checkpoint(run, round);
  write_file(root_ / "checkpoints" / "CURRENT", "7\n");
  EXPECT_EQ(run.newest_checkpoint(), root_ / "checkpoints" / "7");
  add_checkpoint(run, 8);
  EXPECT_EQ(run.newest_checkpoint(), root_ / "checkpoints" / "8");
  EXPECT_THAT(names_in(root_ / "checkpoints"), UnorderedElementsAre("7", "8", "CURRENT"));
}

TEST_F(Runs, ADamagedCheckpointFileIsNamed) {
  const RunDirectory run = create();
  for (const char* name : {"learner.safetensors", "replay.safetensors"}) {
    add_checkpoint(run, 7);
    const fs::path file = root_ / "checkpoints" / "7" / name;
    const std::string content = read_file(file);
    const auto expect_named = [&] {
      EXPECT_THAT(failure_of([&] { run.newest_checkpoint(); }), HasSubstr(file.string()));
    };
    for (std::size_t size = 0; size < content.size(); ++size) {
      damage(file, content.substr(0, size));
      expect_named();
      std::string flipped = content;
      flipped[size] ^= 1;
      damage(file, flipped);
      expect_named();
    }
    fs::remove(file);
    expect_named();
  }
}

TEST_F(Runs, ADamagedCheckpointManifestIsNamed) {
  const RunDirectory run = create();
  add_checkpoint(run, 7);
  const fs::path checkpoint = root_ / "checkpoints" / "7";
  const std::string content = read_file(checkpoint / "manifest.json");
  for (std::size_t size = 0; size + 2 < content.size(); ++size) {  // "}\n"
    damage(checkpoint / "manifest.json", content.substr(0, size));
    EXPECT_THAT(failure_of([&] { run.newest_checkpoint(); }), HasSubstr("manifest.json"));
  }
  for (std::size_t i = 0; i < content.size(); ++i) {
    std::string flipped = content;
    flipped[i] ^= 2;
    if (std::isspace(content[i]) && std::isspace(flipped[i])) continue;
    damage(checkpoint / "manifest.json", flipped);
    EXPECT_THAT(failure_of([&] { run.newest_checkpoint(); }), HasSubstr(checkpoint.string())) << i;
  }
  fs::remove(checkpoint / "manifest.json");
  EXPECT_THAT(failure_of([&] { run.newest_checkpoint(); }), HasSubstr("manifest.json"));
}

TEST_F(Runs, ADamagedCurrentIsNamed) {
  const RunDirectory run = create();
  add_checkpoint(run, 7);
  for (const char* text : {"", "\n", "8\n", "7x\n", "../7\n", "-7", "99999999999999999999999\n"}) {
    write_file(root_ / "checkpoints" / "CURRENT", text);
    EXPECT_THAT(failure_of([&] { run.newest_checkpoint(); }), HasSubstr("checkpoints/")) << text;
  }
}

TEST_F(Runs, TheManifestsRunIdIsChecked) {
  const RunDirectory run = create();
  const std::string id = "0123456789abcdef0123456789abcdef";
  write_file(run.manifest(), R"({"run_id": ")" + id + R"(", "seed": 1})");
  EXPECT_EQ(read_manifest(run).run_id, id);
  for (const char* bad : {"{}", "[]", R"({"run_id": 3})", R"({"run_id": "abc"})",
                          R"({"run_id": "0123456789abcdef0123456789abcdeg"})"}) {
    write_file(run.manifest(), bad);
    EXPECT_THAT(failure_of([&] { read_manifest(run); }), HasSubstr("run_id is not 32 hex")) << bad;
  }
}

TEST(Addresses, OfTcpAreTheConfiguredPorts) {
  RunSettings settings;
  settings.transport = "tcp";
  settings.host = "node";
  const Addresses where = addresses(settings, std::string(32, 'a'));
  EXPECT_EQ(where.replay, "tcp://node:5701");
  EXPECT_EQ(where.learner, "tcp://node:5702");
}

TEST(Addresses, OfIpcDifferByRunAndDoNotShowItsId) {
  const std::string one(32, 'a'), two(32, 'b');
  const Addresses where = addresses({}, one);
  EXPECT_THAT(where.replay, testing::StartsWith("ipc://@corridor-"));
  EXPECT_NE(where.replay, where.learner);
  EXPECT_NE(where.replay, addresses({}, two).replay);
  EXPECT_EQ(where.replay, addresses({}, one).replay);
  EXPECT_EQ(where.replay.find(one.substr(0, 8)), std::string::npos);
  EXPECT_LT(where.replay.size(), 100U);  // a Unix socket's name has 107
}

}  // namespace
}  // namespace corridor
