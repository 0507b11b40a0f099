#include "cluster/watch/display.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "proto/base/format.h"

namespace corridor::cluster {
namespace {

constexpr double kPlainInterval_s = 10.0;

int terminal_columns(std::FILE* out) {
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string progress_bar(double done, int width) {
  const int filled = static_cast<int>(std::clamp(done, 0.0, 1.0) * width);
  return fmt::format("[{}{}]", std::string(static_cast<std::size_t>(filled), '#'),
                     std::string(static_cast<std::size_t>(width - filled), '.'));
}

ProgressDisplay::ProgressDisplay(std::FILE* out) : out_(out), terminal_(isatty(fileno(out)) == 1) {}

ProgressDisplay::~ProgressDisplay() { std::fflush(out_); }

bool ProgressDisplay::due(double now_s) const {
  return terminal_ || !last_s_ || now_s - *last_s_ >= kPlainInterval_s;
}

// Back to the first of the lines that stand there, and clear from there on.
void ProgressDisplay::clear() {
  if (shown_ > 0) fmt::print(out_, "\x1b[{}F\x1b[J", shown_);
  shown_ = 0;
}

void ProgressDisplay::announce(const std::string& line) {
  clear();
  fmt::print(out_, "{}\n", line);
  std::fflush(out_);
}

void ProgressDisplay::show(const std::vector<std::string>& lines, double now_s) {
  if (!due(now_s)) return;
  last_s_ = now_s;
  clear();
  for (const std::string& line : lines) {
    // One that wrapped could not be counted.
    const std::size_t columns =
        terminal_ ? static_cast<std::size_t>(terminal_columns(out_) - 1) : line.size();
    fmt::print(out_, "{}\n", line.substr(0, columns));
  }
  if (terminal_) shown_ = lines.size();
  std::fflush(out_);
}

}  // namespace corridor::cluster
