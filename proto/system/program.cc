// SPDX-License-Identifier: Apache-2.0
#include "proto/system/program.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>

#include "proto/base/failure.h"
#include "proto/base/text.h"
#include "proto/system/log.h"
#include "proto/system/pulse.h"

namespace corridor {
namespace {

std::atomic<int> stop_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "set from a signal handler");

void set_signal(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;  // no SA_RESTART: a wait ends, and its loop sees stop_requested()
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

void open_standard_streams() {
  int opened = 0;
  do {
    opened = open("/dev/null", O_RDWR);  // the lowest number that is free
  } while (opened >= 0 && opened <= STDERR_FILENO);
  if (opened >= 0) close(opened);
}

// In one line, whatever names it speaks of.
int report_error(const std::string& name, const char* text) {
  std::fprintf(stderr, "%s: error: %s\n", name.c_str(), replaced(text, '\n', "\\n").c_str());
  return 1;
}

// What a program wrote and nobody got is an error, also when it was written long ago.
void check_standard_output() {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && std::ferror(stdout) == 0) return;
  throw Failure("cannot write all of standard output: {}",
                errno != 0 ? std::strerror(errno) : "an earlier write failed");
}

}  // namespace

const char* const kVersion = CORRIDOR_VERSION;

int run_program(const std::string& name, const std::function<int()>& body) {
  open_standard_streams();
  try {
    start_log(name);
    for (const int signal : kStopSignals) {
      if (!was_ignored(signal)) set_signal(signal, [](int number) { stop_signal = number; });
    }
    set_signal(SIGPIPE, SIG_IGN);
    adopt_pulse();
    const int status = body();
    check_standard_output();
    return status == 0 && stop_signal != 0 ? 128 + stop_signal : status;
  } catch (const Stopped&) {
    std::fflush(stdout);
    std::fprintf(stderr, "%s: stopped by a signal (%s)\n", name.c_str(), strsignal(stop_signal));
    return 128 + stop_signal;
  } catch (const std::exception& error) {
    return report_error(name, error.what());
  } catch (...) {
    return report_error(name, "an exception of unknown type");
  }
}

bool stop_requested() {
  beat();
  return stop_signal != 0;
}

void throw_if_stopped() {
  if (stop_requested()) throw Stopped();
}

bool was_ignored(int signal) {
  struct sigaction current {};
  return sigaction(signal, nullptr, &current) == 0 && current.sa_handler == SIG_IGN;
}

}  // namespace corridor
