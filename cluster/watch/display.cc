// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/display.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "proto/base/format.h"
#include "proto/base/text.h"

namespace corridor::cluster {
namespace {

constexpr double kPlainInterval_s = 10.0;
constexpr std::size_t kBarWidth = 20;

int terminal_columns(std::FILE* out) {
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

// One that understands control sequences.
bool is_terminal(std::FILE* out) {
  const char* const kind = std::getenv("TERM");
  return isatty(fileno(out)) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

// A reader that has gone must not end what is shown: run_program says so at the end.
void put(std::FILE* out, const std::string& text) { std::fputs(text.c_str(), out); }

}  // namespace

std::string progress_line(const std::string& title, std::int64_t done, std::int64_t total,
                          const std::string& unit, double per_s) {
  const double share = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1.0;
  std::string bar(kBarWidth, '.');
  std::fill_n(bar.begin(), static_cast<int>(std::clamp(share, 0.0, 1.0) * kBarWidth), '#');
  std::string text = fmt::format("{}[{}] {:5.1f} %  {} of {} {}", title, bar, 100.0 * share,
                                 grouped(done), grouped(total), unit);
  if (per_s > 0.0) {
    text += fmt::format("  {} {}/s  {} left", grouped(std::llround(per_s)), unit,
                        duration_text(static_cast<double>(total - done) / per_s));
  }
  return text;
}

ProgressDisplay::ProgressDisplay(std::FILE* out) : out_(out), terminal_(is_terminal(out)) {}

ProgressDisplay::~ProgressDisplay() { std::fflush(out_); }

// Back to the first of the lines that stand there, and clear from there on.
void ProgressDisplay::clear() {
  if (shown_ > 0) put(out_, fmt::format("\x1b[{}F\x1b[J", shown_));
  shown_ = 0;
}

void ProgressDisplay::announce(const std::string& line) {
  clear();
  put(out_, line + "\n");
  std::fflush(out_);
}

void ProgressDisplay::show(const std::vector<std::string>& lines, double now_s) {
  if (!terminal_ && last_s_ && now_s - *last_s_ < kPlainInterval_s) return;
  last_s_ = now_s;
  clear();
  for (const std::string& line : lines) {
    // One that wrapped could not be counted.
    const std::size_t columns =
        terminal_ ? static_cast<std::size_t>(terminal_columns(out_) - 1) : line.size();
    put(out_, line.substr(0, columns) + "\n");
  }
  if (terminal_) shown_ = lines.size();
  std::fflush(out_);
}

}  // namespace corridor::cluster
