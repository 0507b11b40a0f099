// SPDX-License-Identifier: Apache-2.0
// The command line of `corridor`.
#pragma once

namespace corridor::cluster {

// Parses, runs the command, returns the exit status. Throws Failure for a wrong command line and
// for whatever goes wrong in the command.
int run_command(int argc, const char* const* argv);

}  // namespace corridor::cluster
