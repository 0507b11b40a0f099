#include "cluster/watch/display.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "proto/base/format.h"

namespace corridor::cluster {
namespace {

constexpr double kPlainInterval_s = 10.0;

int terminal_columns() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

double monotonic_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string progress_bar(double done, int width) {
  const int filled = static_cast<int>(std::clamp(done, 0.0, 1.0) * width);
  return fmt::format("[{}{}]", std::string(static_cast<std::size_t>(filled), '#'),
                     std::string(static_cast<std::size_t>(width - filled), '.'));
}

ProgressDisplay::ProgressDisplay() : terminal_(isatty(STDOUT_FILENO) == 1) {}

ProgressDisplay::~ProgressDisplay() { std::fflush(stdout); }

bool ProgressDisplay::due(double now_s) const {
  return terminal_ || !last_s_ || now_s - *last_s_ >= kPlainInterval_s;
}

void ProgressDisplay::announce(const std::string& line) {
  if (shown_ > 0) fmt::print("\x1b[{}F\x1b[J", shown_);
  shown_ = 0;
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

void ProgressDisplay::show(const std::vector<std::string>& lines, double now_s) {
  if (!due(now_s)) return;
  last_s_ = now_s;
  if (terminal_) {
    // Back to the first of the lines that stand there, and clear from there on. A line that wrapped
    // could not be counted, so none may.
    if (shown_ > 0) fmt::print("\x1b[{}F\x1b[J", shown_);
    const auto columns = static_cast<std::size_t>(terminal_columns() - 1);
    for (const std::string& line : lines) fmt::print("{}\n", line.substr(0, columns));
    shown_ = lines.size();
  } else {
    for (const std::string& line : lines) fmt::print("{}\n", line);
  }
  std::fflush(stdout);
}

}  // namespace corridor::cluster
