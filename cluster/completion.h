// SPDX-License-Identifier: Apache-2.0
// `corridor completion`: the command line as shells and `man` are told of it, generated from its
// declaration.
#pragma once

#include <string>

#include "proto/system/command_line.h"

namespace corridor::cluster {

// A script for bash to source: completes the commands and options of `app`, paths, and the names
// of planners and worlds. Needs no other script.
std::string bash_completion(const CLI::App& app);

// A page of section 1, in roff's man macros: every command and option with its help.
std::string man_page(const CLI::App& app);

// Declares what can be printed: `format` is the name of one.
void declare_completion(CLI::App& command, std::string& format);

// Prints it of `app`, the whole command line. Returns the exit status.
int completion(const CLI::App& app, const std::string& format);

}  // namespace corridor::cluster
