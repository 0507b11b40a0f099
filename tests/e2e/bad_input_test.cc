// SPDX-License-Identifier: Apache-2.0
// What users and the world do wrong: one clear line, a non-zero exit, nothing left running.
#include <netinet/in.h>
#include <sys/socket.h>

#include <csignal>

#include "proto/base/random.h"
#include "proto/run/checkpoints.h"
#include "proto/settings/sumo_names.h"
#include "proto/system/test_delay.h"
#include "tests/e2e/run_support.h"

namespace corridor::e2e {
namespace {

namespace fs = std::filesystem;

// The command fails by itself, says each of `hints` in its last line, and leaves nothing.
void expect_failure(const std::vector<std::string>& command, const std::vector<std::string>& hints,
                    const std::map<std::string, std::string>& environment = {}) {
  const CommandResult result = run_command(command, kDeadline_s, environment);
  EXPECT_GT(result.status, 0) << result.output;
  EXPECT_LT(result.status, 128) << result.output;
  const std::size_t error = result.output.rfind("error: ");
  ASSERT_NE(error, std::string::npos) << result.output;
  const std::string text = result.output.substr(error);
  EXPECT_EQ(lines_in(text), 1) << result.output;
  for (const auto& hint : hints) EXPECT_NE(text.find(hint), std::string::npos) << result.output;
}

fs::path newest_checkpoint(const fs::path& run) {
  return Checkpoints(run / "checkpoints").newest().value();
}

class BadInput : public testing::Test {
 protected:
  ~BadInput() override { expect_nothing_left(temporary.path()); }

  fs::path scenario(const std::string& text) const {
    const fs::path file = temporary.path() / "scenario.toml";
    std::ofstream(file) << text;
    return file;
  }
  std::vector<std::string> train(const fs::path& file) const {
    return {kCorridor, "train", file, "--run", temporary.path() / "run"};
  }

  TemporaryDirectory temporary;
  fs::path run = temporary.path() / "run";
};

TEST_F(BadInput, AnUnknownKeyIsNamedWithTheOneThatWasMeant) {
  expect_failure(train(scenario("[traffic]\nblind_rate = 0.1\n")),
                 {"traffic.blind_rate", "blind_rate_per_s"});
  EXPECT_FALSE(fs::exists(run));
}

TEST_F(BadInput, AWrongTypeIsNamed) {
  expect_failure(train(scenario("[road]\nlanes = \"three\"\n")), {"road.lanes", "three"});
}

TEST_F(BadInput, AValueOutOfRangeIsNamed) {
  expect_failure(train(scenario("[mop]\ngamma = 1.5\n")), {"mop.gamma", "1.5"});
  expect_failure({kCorridor, "train", kSmoke, "--run", run, "--actors", "0"}, {"run.actors", "0"});
}

TEST_F(BadInput, AMissingScenarioIsNamed) {
  expect_failure(train(temporary.path() / "nothing.toml"), {"nothing.toml"});
}

TEST_F(BadInput, CheckSaysWhetherAScenarioIsRight) {
  const CommandResult good = run_command({kCorridor, "check", kSmoke}, kDeadline_s);
  EXPECT_EQ(good.status, 0) << good.output;
  expect_failure({kCorridor, "check", scenario("[bp]\nsteps = -1\n")}, {"bp.steps", "-1"});
}

TEST_F(BadInput, ARunDirectoryThatExistsIsLeftAlone) {
  fs::create_directory(run);
  std::ofstream(run / "mine") << "precious";
  expect_failure(train_command(run), {run.string(), "exists"});
  EXPECT_TRUE(fs::exists(run / "mine"));
  EXPECT_EQ(std::distance(fs::directory_iterator(run), {}), 1);
}

TEST_F(BadInput, CommandsOnWhatIsNoRunSaySo) {
  for (const char* command : {"resume", "evaluate", "fingerprint"}) {
    expect_failure({kCorridor, command, temporary.path() / "none"}, {"none"});
  }
}

TEST_F(BadInput, AnUnknownPlannerIsNamedWithTheKnownOnes) {
  ASSERT_EQ(run_command(train_command(run), kDeadline_s).status, 0);
  expect_failure({kCorridor, "evaluate", run, "--planners", "best"}, {"best", "hierarchical"});
  expect_failure({kCorridor, "redrive", run, "hierarchical_9_9"}, {"hierarchical_9_9"});
}

TEST_F(BadInput, APortInUseIsNamed) {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(listener, 1), 0);
  socklen_t size = sizeof address;
  getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  const std::string port = std::to_string(ntohs(address.sin_port));
  expect_failure(
      train_command(run, {"--set", "run.transport=\"tcp\"", "--set", "run.replay_port=" + port}),
      {port, "in use"});
  close(listener);
}

// A TCP port that nobody listens on now.
int free_port() {
  const int probe = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT_EQ(bind(probe, reinterpret_cast<sockaddr*>(&address), size), 0);
  getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
  close(probe);
  return ntohs(address.sin_port);
}

// Connects to a port of ours and sends it `bytes`; whether anybody was there.
bool send_bytes(int port, const std::string& bytes) {
  const int connection = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  const bool connected =
      connect(connection, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  if (connected) (void)!send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  close(connection);
  return connected;
}

TEST_F(BadInput, RandomBytesToEverySocketChangeNothing) {
  const auto undisturbed = temporary.path() / "undisturbed";
  ASSERT_EQ(run_command(train_command(undisturbed), kDeadline_s).status, 0);

  const int replay_port = free_port();
  int learner_port = free_port();
  while (learner_port == replay_port) learner_port = free_port();
  Command training(train_command(run, {"--set", "run.transport=\"tcp\"", "--set",
                                       "run.replay_port=" + std::to_string(replay_port), "--set",
                                       "run.learner_port=" + std::to_string(learner_port)}),
                   {{kTestDelayVariable, "40"}});
  // The start of ZeroMQ's own greeting lets some of the bytes reach its framing.
  const std::string greeting("\xff\0\0\0\0\0\0\0\x01\x7f\x03\0NULL", 16);
  int received = 0;
  // However long the processes take to start.
  for (std::uint64_t i = 0; i < 3000 && received < 200; ++i) {
    std::string bytes = i % 3 == 0 ? greeting : "";
    for (std::uint64_t j = 0; j < 40 + i; ++j) {
      bytes.push_back(static_cast<char>(random_bits(i, Purpose::kWireDelay, {j})));
    }
    received += send_bytes(replay_port, bytes) && send_bytes(learner_port, bytes);
    training.wait_for("never printed", 0.01);
  }
  EXPECT_GT(received, 50);
  const CommandResult result = training.finish(kDeadline_s);
  ASSERT_EQ(result.status, 0) << result.output;
  EXPECT_EQ(fingerprint(run), fingerprint(undisturbed));
}

TEST_F(BadInput, MissingSumoIsNamed) {
  expect_failure(train_command(run), {"netconvert", "sumo"},
                 {{"PATH", "/nonexistent"}, {"SUMO_HOME", "/nonexistent"}});
  EXPECT_FALSE(fs::exists(run));
}

// Truncated, flipped or missing.
void damage(const fs::path& file, int how) {
  const auto size = fs::file_size(file);
  if (how == 0) fs::resize_file(file, size / 2);
  if (how == 1) {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekg(static_cast<std::streamoff>(size / 2));
    const char flipped = static_cast<char>(bytes.peek() ^ 1);
    bytes.seekp(static_cast<std::streamoff>(size / 2));
    bytes.put(flipped);
  }
  if (how == 2) fs::remove(file);
}

TEST_F(BadInput, ADamagedNewestCheckpointIsNamedAndTheOneBeforeIsUsed) {
  ASSERT_EQ(run_command(train_command(run), kDeadline_s).status, 0);
  const std::string expected = fingerprint(run);
  const fs::path whole = temporary.path() / "whole";
  fs::rename(run, whole);
  // The newest checkpoint's own files; rows that the one before has too are one file on disk.
  std::vector<std::string> own;
  for (const auto& entry : fs::directory_iterator(newest_checkpoint(whole))) {
    if (fs::hard_link_count(entry.path()) == 1) own.push_back(entry.path().filename());
  }
  ASSERT_EQ(own.size(), 4u);  // manifest, learner, replay, the newest rows
  for (std::size_t i = 0; i < own.size(); ++i) {
    fs::remove_all(run);
    fs::copy(whole, run, fs::copy_options::recursive);
    // A flipped bit of the manifest is blamed on the file whose hash it was.
    damage(newest_checkpoint(run) / own[i],
           own[i] == "manifest.json" ? 0 : static_cast<int>(i) % 3);
    expect_failure({kCorridor, "fingerprint", run}, {newest_checkpoint(run).string()});
    const CommandResult resumed = run_command({kCorridor, "resume", run}, kDeadline_s);
    EXPECT_EQ(resumed.status, 0) << resumed.output;
    EXPECT_NE(resumed.output.find(own[i]), std::string::npos) << resumed.output;
    EXPECT_EQ(fingerprint(run), expected) << own[i];
  }
}

TEST_F(BadInput, WhenEveryCheckpointIsDamagedResumeSaysSoAndChangesNothing) {
  ASSERT_EQ(run_command(train_command(run), kDeadline_s).status, 0);
  for (const auto& entry : fs::directory_iterator(run / "checkpoints")) {
    damage(entry.path() / kLearnerFile, 0);
  }
  for (int attempt = 0; attempt < 2; ++attempt) {
    expect_failure({kCorridor, "resume", run}, {"no checkpoint", kLearnerFile});
  }
}

TEST_F(BadInput, ASettingThatTheResultDependsOnIsRefusedOnResume) {
  ASSERT_EQ(run_command(train_command(run), kDeadline_s).status, 0);
  expect_failure({kCorridor, "resume", run, "--set", "bp.gamma=0.5"}, {"bp.gamma = 0.5"});
}

TEST_F(BadInput, AnActorThatDiesAtStartEndsTheRunWithItsReason) {
  Command training(train_command(run, {"--set", "mop.steps=1000000"}));
  ASSERT_TRUE(training.wait_for("MoP", 60.0));
  training.signal(SIGINT);
  ASSERT_EQ(training.finish(30.0).status, 130);
  // The network is gone when the actors look for it.
  fs::remove(run / "sumo" / kSumoNetworkFile);
  expect_failure({kCorridor, "resume", run}, {"actor", kSumoNetworkFile});
}

TEST_F(BadInput, AProcessThatDiesAgainAndAgainEndsTheRunWithItsName) {
  Command training(train_command(run, {"--set", "mop.steps=1000000"}));
  ASSERT_TRUE(training.wait_for("MoP", 60.0));
  // Faster than anything can be done.
  while (training.read_for(0.02)) {
    for (const auto& process : processes_with("corridor-replay " + run.string())) {
      kill(process.pid, SIGKILL);
    }
  }
  const CommandResult result = training.finish(30.0);
  EXPECT_EQ(result.status, 1) << result.output;
  EXPECT_NE(result.output.find("5 times in a row, without any progress in between: replay ended "
                               "with signal 9"),
            std::string::npos)
      << result.output;
}

TEST_F(BadInput, AKilledLauncherTakesEverythingWithIt) {
  Command training(train_command(run, {"--set", "mop.steps=1000000"}));
  ASSERT_TRUE(training.wait_for("MoP", 60.0));
  ASSERT_GE(processes_with(run.string()).size(), 5u);
  training.signal(SIGKILL);
  EXPECT_EQ(training.finish(10.0).status, 137);
  EXPECT_TRUE(eventually([&] { return processes_with(run.string()).empty(); }, 20.0));
  expect_nothing_left(run);
}

TEST_F(BadInput, ASecondLauncherIsRefusedWhileARunGoesOn) {
  Command training(train_command(run, {"--set", "mop.steps=1000000"}));
  ASSERT_TRUE(training.wait_for("MoP", 60.0));
  const CommandResult second = run_command({kCorridor, "resume", run}, kDeadline_s);
  EXPECT_EQ(second.status, 1) << second.output;
  EXPECT_NE(second.output.find(std::to_string(training.pid())), std::string::npos) << second.output;
  training.signal(SIGTERM);
  EXPECT_EQ(training.finish(30.0).status, 143);
}

TEST_F(BadInput, AFullOrReadOnlyDiskEndsTheRunWithAClearLineAndItGoesOnWhenItCan) {
  // A file system of its own, which only a process that may mount can have.
  const fs::path disk = temporary.path() / "disk";
  fs::create_directory(disk);
  const std::string mount = "mount -t tmpfs -o size=";
  const auto in_namespace = [](const std::string& script) {
    return std::vector<std::string>{"unshare", "-m", "sh", "-c", script, "sh"};
  };
  if (run_command(in_namespace(mount + "1m none " + disk.string()), 10.0).status != 0) {
    GTEST_SKIP() << "may not mount";
  }
  const fs::path undisturbed = temporary.path() / "undisturbed";
  ASSERT_EQ(run_command(train_command(undisturbed), kDeadline_s).status, 0);

  const std::string corridor = "'" + kCorridor + "'";
  const std::string resume = corridor + " resume " + (disk / "run").string();
  const std::string remount = "mount -o remount,";
  const std::string again = resume + "; echo \"status $?\"; ";
  std::vector<std::string> command = in_namespace(
      mount + "1m none " + disk.string() + "; \"$@\"; echo \"status $?\"; " + again + remount +
      "size=100m,ro " + disk.string() + "; " + again + remount + "rw " + disk.string() + "; " +
      again + corridor + " fingerprint " + (disk / "run").string());
  for (const auto& argument : train_command(disk / "run")) command.push_back(argument);
  const CommandResult result = run_command(command, kDeadline_s);

  std::vector<std::string> errors;
  std::istringstream lines(result.output);
  std::string last;
  for (std::string line; std::getline(lines, line); last = line) {
    if (line.find("error: ") != std::string::npos) errors.push_back(line);
  }
  ASSERT_EQ(errors.size(), 3u) << result.output;
  EXPECT_NE(errors[0].find("No space left on device"), std::string::npos) << errors[0];
  EXPECT_NE(errors[1].find("No space left on device"), std::string::npos) << errors[1];
  EXPECT_NE(errors[2].find("Read-only file system"), std::string::npos) << errors[2];
  EXPECT_EQ(last, fingerprint(undisturbed)) << result.output;
}

TEST_F(BadInput, AFileSizeLimitEndsTheRunWithAClearLineAndItGoesOnWithoutIt) {
  const fs::path undisturbed = temporary.path() / "undisturbed";
  ASSERT_EQ(run_command(train_command(undisturbed), kDeadline_s).status, 0);
  // A limit on the size of files: writes fail part-way, as they do where a disk ends. The learner's
  // part of the first checkpoint is larger.
  std::vector<std::string> command = {"sh", "-c", "trap '' XFSZ; ulimit -f 400; exec \"$@\"", "sh"};
  for (const auto& argument : train_command(run)) command.push_back(argument);
  expect_failure(command, {"checkpoints/"});
  EXPECT_EQ(run_command({kCorridor, "resume", run}, kDeadline_s).status, 0);
  EXPECT_EQ(fingerprint(run), fingerprint(undisturbed));
}

}  // namespace
}  // namespace corridor::e2e
