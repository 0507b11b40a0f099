// SPDX-License-Identifier: Apache-2.0
// What made a run: its manifest.json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "proto/run/json_record.h"
#include "proto/run/run_directory.h"

namespace corridor {

// What is not known says "unknown".
struct RunVersions {
  std::string corridor;
  std::string git_commit;
  std::string sumo;
  std::string libtorch;
  std::string blas;
  std::string compiler;
  // Of OpenBLAS, by which the learner computes: its kernels, and its version and options. The
  // learner fills them in when it starts; runs of earlier versions do not say.
  std::optional<std::string> blas_core = {};
  std::optional<std::string> blas_config = {};

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("corridor", self.corridor);
    field("git_commit", self.git_commit);
    field("sumo", self.sumo);
    field("libtorch", self.libtorch);
    field("blas", self.blas);
    field("compiler", self.compiler);
    field("blas_core", self.blas_core, kLeftOut);
    field("blas_config", self.blas_config, kLeftOut);
  }
  bool operator==(const RunVersions&) const = default;
};

// Bits depend on all of it but the commit, which may have changed anything or nothing.
struct ChangedVersion {
  std::string name;  // "libtorch"
  std::string before;
  std::string now;
};
std::vector<ChangedVersion> changed_versions(const RunVersions& before, const RunVersions& now);

// What lets a run go on with other versions.
inline constexpr const char* kAllowOtherBits = "--allow-other-bits";
// Throws Failure naming the first of `changed`, unless they are allowed. Lines of all for a
// Continuation.
std::vector<std::string> allowed_changes(const std::vector<ChangedVersion>& changed, bool allowed);

// Where a training went on otherwise than it began, on request.
struct Continuation {
  std::uint64_t round = 0;  // the first that was driven so
  RunVersions versions;
  std::vector<std::string> changes;  // "libtorch 2.6.0, where it was 1.13.0"

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("round", self.round);
    field("versions", self.versions);
    field("changes", self.changes);
  }
  bool operator==(const Continuation&) const = default;
};

struct RunManifest {
  std::string run_id;  // 32 hex digits; who knows them belongs to the run
  std::uint64_t seed = 0;
  std::string scenario;  // its file
  std::string started;   // UTC
  std::string host;
  std::string cpu;
  unsigned cores = 0;
  RunVersions versions;
  // The settings that its result depends on, in TOML: those it began with, but for what
  // `continuations` say.
  std::string config;
  std::optional<std::vector<Continuation>> continuations = {};
  std::optional<std::string> fingerprint =
      {};  // of an exported run, whose checkpoints stayed behind
  // Of a directory that has results only: that of the run whose networks drove.
  std::optional<std::string> trained = {};

  std::string scenario_name() const { return std::filesystem::path(scenario).stem(); }  // "paper"

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("run_id", self.run_id);
    field("seed", self.seed);
    field("scenario", self.scenario);
    field("started", self.started);
    field("host", self.host);
    field("cpu", self.cpu);
    field("cores", self.cores);
    field("versions", self.versions);
    field("config", self.config);
    field("continuations", self.continuations, kLeftOut);
    field("fingerprint", self.fingerprint, kLeftOut);
    field("trained", self.trained, kLeftOut);
  }
  // What it was trained with last.
  const RunVersions& versions_now() const;
  RunVersions& versions_now();
  void go_on(const Continuation& continuation);
  void check() const;
  bool operator==(const RunManifest&) const = default;
};

// Throws Failure when the disk is full.
void write_manifest(const RunDirectory& directory, const RunManifest& manifest);
// Throws Failure naming the file when a member is missing or wrong.
RunManifest read_manifest(const RunDirectory& directory);

// Where what a run's networks drive is recorded, unless people say where: beside them. An exported
// run may lie where nobody may write, or among sources: below the working directory, by its name.
std::filesystem::path results_folder(const RunDirectory& run);
// What is there. Throws Failure when nothing has been driven yet.
RunDirectory open_results(const std::filesystem::path& run);

}  // namespace corridor
