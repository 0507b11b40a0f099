// SPDX-License-Identifier: Apache-2.0
// What made a run: its manifest.json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

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

  template <typename Self, typename Field>
  static void fields(Self& self, Field field) {
    field("corridor", self.corridor);
    field("git_commit", self.git_commit);
    field("sumo", self.sumo);
    field("libtorch", self.libtorch);
    field("blas", self.blas);
    field("compiler", self.compiler);
  }
  bool operator==(const RunVersions&) const = default;
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
  std::string config;                      // the settings that it began with, in TOML
  std::optional<std::string> fingerprint;  // of an exported run, whose checkpoints stayed behind

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
    field("fingerprint", self.fingerprint, kLeftOut);
  }
  void check() const;
  bool operator==(const RunManifest&) const = default;
};

// Throws Failure when the disk is full.
void write_manifest(const RunDirectory& directory, const RunManifest& manifest);
// Throws Failure naming the file when a member is missing or wrong.
RunManifest read_manifest(const RunDirectory& directory);

}  // namespace corridor
