// SPDX-License-Identifier: Apache-2.0
// `corridor experiment`: every training and evaluation of an experiment file, and their tables.
//
//   DIR/experiment.toml              the file, as it was at the first start
//   DIR/log/                         one log a process
//   DIR/runs/<name>-<training seed>  ordinary run directories; each one's scenarios/<scenario> has
//                                    its evaluations
//   DIR/results.md, results.json     tables for people; every evaluation for programs
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace corridor::cluster {

struct ExperimentOptions {
  std::filesystem::path file = {};
  std::filesystem::path directory = {};
  std::optional<int> jobs = {};  // cores to use; else all
};

// Trains and evaluates what is not there yet, as many at a time as there are cores: a training uses
// two. What is there stays: the command goes on after anything that stopped it. Arms in which
// nothing is learned are driven beside the first training seed only. Returns the exit status: 0, or
// 128 + signal when stopped by one. Throws Failure for a wrong file, for a directory that holds
// another experiment or other settings, and when a process fails.
int experiment(const ExperimentOptions& options, const std::string& program);

}  // namespace corridor::cluster
