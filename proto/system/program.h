// SPDX-License-Identifier: Apache-2.0
// What every main() does the same way: logging, signals, one catch.
#pragma once

#include <array>
#include <csignal>
#include <functional>
#include <string>

namespace corridor {

// "major.minor.patch", as CMakeLists.txt has it.
extern const char* const kVersion;

// Signals that ask a process to end. One that was ignored when the process started stays ignored,
// as under nohup.
inline constexpr std::array kStopSignals = {SIGINT, SIGTERM, SIGHUP, SIGUSR1};

// Thrown where a signal has asked this process to end and nothing is left to be said or kept.
struct Stopped {};

// Runs `body` and returns the process's exit status: body's own; where that is 0 and a signal asked
// to stop, 128 + the signal, so that whoever started the process knows that it may not be done; or
// 1 after a Failure or another exception, whose text goes to standard error as one line
// "<name>: error: <text>", and where standard output did not take all that was written to it.
// After Stopped a line says which signal it was.
// Before that: descriptors 0 to 2 that are closed are opened on /dev/null, so that no file of ours
// gets their numbers; spdlog writes "time name level text" to standard error; kStopSignals set
// stop_requested(); SIGPIPE is ignored; the pulse is adopted (proto/system/pulse.h).
int run_program(const std::string& name, const std::function<int()>& body);

// Whether a signal has asked this process to end. Every loop that waits looks at it; it is a sign
// of life (proto/system/pulse.h).
bool stop_requested();
// Throws Stopped when it has.
void throw_if_stopped();
// Whether this process was started to ignore it.
bool was_ignored(int signal);

}  // namespace corridor
