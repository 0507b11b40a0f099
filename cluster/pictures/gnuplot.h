// The adapter of gnuplot.
#pragma once

#include <chrono>
#include <string>

namespace corridor::cluster {

// What gnuplot writes to standard output for a script that sets a terminal and no output: the
// picture. The user's own gnuplot settings do not count. Throws Failure with gnuplot's reason in
// one line when it is not installed, refuses the script, or is not done by the deadline.
std::string run_gnuplot(const std::string& script,
                        std::chrono::milliseconds deadline = std::chrono::minutes(1));

}  // namespace corridor::cluster
