// What every main() does the same way: logging, signals, one catch.
#pragma once

#include <functional>
#include <string>

namespace corridor {

inline constexpr const char* kVersion = "0.1.0";

// Runs `body` and returns the process's exit status: body's own, or 1 after a Failure or another
// exception, whose text goes to standard error as one line "<name>: error: <text>".
// Before that: spdlog writes "time name level text" to standard error; SIGTERM and SIGINT set
// stop_requested(); SIGPIPE is ignored. With PR_SET_PDEATHSIG the process gets SIGTERM when its
// parent dies, if `dies_with_parent`.
int run_program(const std::string& name, bool dies_with_parent, const std::function<int()>& body);

// Whether a signal has asked this process to end. Every loop that waits looks at it.
bool stop_requested();

}  // namespace corridor
