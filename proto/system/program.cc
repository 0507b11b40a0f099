// SPDX-License-Identifier: Apache-2.0
#include "proto/system/program.h"

#include <signal.h>

#include <atomic>
#include <cstdio>
#include <exception>
#include <memory>

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

int report_error(const std::string& name, const char* text) {
  std::fprintf(stderr, "%s: error: %s\n", name.c_str(), text);
  return 1;
}

}  // namespace

const char* const kVersion = CORRIDOR_VERSION;

int run_program(const std::string& name, const std::function<int()>& body) {
  try {
    start_log(name);
    for (const int signal : {SIGTERM, SIGINT}) {
      set_signal(signal, [](int number) { stop_signal = number; });
    }
    set_signal(SIGPIPE, SIG_IGN);
    adopt_pulse();
    const int status = body();
    return status == 0 && stop_signal != 0 ? 128 + stop_signal : status;
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

}  // namespace corridor
