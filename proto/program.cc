#include "proto/program.h"

#include <signal.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <exception>
#include <memory>

namespace corridor {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

void set_signal(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;  // no SA_RESTART: a wait ends, and its loop sees stop_requested()
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

void die_with_parent() {
  const pid_t parent = getppid();
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  // The parent may have died just before.
  if (getppid() != parent) stop = true;
}

int report_error(const std::string& name, const char* text) {
  std::fprintf(stderr, "%s: error: %s\n", name.c_str(), text);
  return 1;
}

}  // namespace

int run_program(const std::string& name, bool dies_with_parent, const std::function<int()>& body) {
  try {
    const auto logger =
        std::make_shared<spdlog::logger>(name, std::make_shared<spdlog::sinks::stderr_sink_st>());
    logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %n %l %v");
    logger->flush_on(spdlog::level::trace);
    spdlog::set_default_logger(logger);
    set_signal(SIGTERM, [](int) { stop = true; });
    set_signal(SIGINT, [](int) { stop = true; });
    set_signal(SIGPIPE, SIG_IGN);
    if (dies_with_parent) die_with_parent();
    return body();
  } catch (const std::exception& error) {
    return report_error(name, error.what());
  } catch (...) {
    return report_error(name, "an exception of unknown type");
  }
}

bool stop_requested() { return stop; }

}  // namespace corridor
