// SPDX-License-Identifier: Apache-2.0
// What every program's command line does alike. The only user of CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>

#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/system/program.h"

namespace corridor {

// What help calls the value of an option that is a path: shells complete it as one.
inline constexpr const char* kPathType = "PATH";

}  // namespace corridor

template <>
constexpr const char* CLI::detail::type_name<std::filesystem::path>() {
  return corridor::kPathType;
}

namespace corridor {

// A check of options: their texts are whole numbers in this range. By itself CLI11 takes -1 for the
// largest one.
inline CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
  return CLI::Validator(
      [=](const std::string& text) {
        const auto number = parse_number<std::uint64_t>(text);
        const bool good = number && *number >= low && *number <= high;
        return good ? "" : fmt::format("'{}' is no whole number from {} to {}", text, low, high);
      },
      "");
}

// Refuses "" for whatever takes a value: a script's variable that nobody has set.
inline void refuse_empty_values(CLI::App& app) {
  for (CLI::Option* const option : app.get_options()) {
    if (option->get_items_expected_max() == 0) continue;
    option->check(CLI::Validator(
        [](const std::string& text) { return text.empty() ? "its value is empty" : ""; }, ""));
  }
}

// Parses, --version included. Returns the exit status where that is all there is to do (--help,
// --version), else nothing. Throws Failure in one line for what is wrong; `program` is how people
// call it.
inline std::optional<int> parse_command_line(CLI::App& app, const std::string& program, int argc,
                                             const char* const* argv) {
  app.set_version_flag("--version", kVersion, "print the version");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      std::ostringstream text, no_errors;
      const int status = app.exit(error, text, no_errors);
      fmt::print("{}", text.str());  // run_program sees to what is lost of it
      return status;
    }
    throw Failure("{}; see {} --help", error.what(), program);
  }
  return std::nullopt;
}

}  // namespace corridor
