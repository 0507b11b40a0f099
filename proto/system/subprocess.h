// SPDX-License-Identifier: Apache-2.0
// Another program, run to its end: netconvert, gnuplot, ffmpeg, an actor of ours.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace corridor {

// The executable of that name in the first of `folders` and those of PATH that has it.
std::optional<std::filesystem::path> find_program(const std::string& name,
                                                  std::vector<std::filesystem::path> folders = {});

// As exec wants them: a pointer to each, and the null behind them. `texts` outlive it.
std::vector<char*> pointers_to(std::vector<std::string>& texts);

struct SubprocessResult {
  int status = 0;      // as a shell says: 128 + signal when one ended it
  std::string output;  // standard output and standard error, each cut off at 64 MiB
  std::string errors;
  bool operator==(const SubprocessResult&) const = default;
};

// Runs `program` in `directory` (this process's, unless given) with `input` as its standard input
// until it has ended and nobody has its outputs open any more. Returns nothing, and kills it, when
// that is not so once `patience` is over. Throws Failure when it cannot be started, and Stopped,
// having killed it, when a signal asks this process to end (proto/system/program.h).
std::optional<SubprocessResult> run_subprocess(const std::filesystem::path& program,
                                               const std::vector<std::string>& arguments,
                                               const std::string& input,
                                               std::chrono::milliseconds patience,
                                               const std::filesystem::path& directory = {});

}  // namespace corridor
