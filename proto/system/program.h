// SPDX-License-Identifier: Apache-2.0
// What every main() does the same way: logging, signals, one catch.
#pragma once

#include <functional>
#include <string>

namespace corridor {

// "major.minor.patch", as CMakeLists.txt has it.
extern const char* const kVersion;

// Runs `body` and returns the process's exit status: body's own; where that is 0 and a signal asked
// to stop, 128 + the signal, so that whoever started the process knows that it may not be done; or
// 1 after a Failure or another exception, whose text goes to standard error as one line
// "<name>: error: <text>".
// Before that: spdlog writes "time name level text" to standard error; SIGTERM and SIGINT set
// stop_requested(); SIGPIPE is ignored; the pulse is adopted (proto/system/pulse.h).
int run_program(const std::string& name, const std::function<int()>& body);

// Whether a signal has asked this process to end. Every loop that waits looks at it; it is a sign
// of life (proto/system/pulse.h).
bool stop_requested();

}  // namespace corridor
