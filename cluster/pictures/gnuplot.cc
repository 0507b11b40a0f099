#include "cluster/pictures/gnuplot.h"

#include <cstring>

#include "proto/base/failure.h"
#include "proto/system/subprocess.h"

namespace corridor::cluster {
namespace {

// gnuplot says the line, then marks the place, then says what is wrong.
std::string last_line(std::string text) {
  text.erase(text.find_last_not_of(" \n") + 1);
  text.erase(0, text.rfind('\n') + 1);
  text.erase(0, text.find_first_not_of(' '));
  return text;
}

}  // namespace

std::string run_gnuplot(const std::string& script, std::chrono::milliseconds deadline) {
  const auto program = find_program("gnuplot");
  if (!program) {
    throw Failure("gnuplot is not installed, and it draws the figures: install gnuplot-nox");
  }
  const auto result = run_subprocess(*program, {"--default-settings"}, script, deadline);
  if (!result) {
    throw Failure("gnuplot was not done within {} s and was killed",
                  std::chrono::duration<double>(deadline).count());
  }
  if (result->status > 128) {
    throw Failure("gnuplot ended with signal {}", strsignal(result->status - 128));
  }
  if (result->status != 0 || result->output.empty()) {
    throw Failure("gnuplot drew nothing: {}", last_line(result->errors));
  }
  return result->output;
}

}  // namespace corridor::cluster
