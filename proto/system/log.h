// SPDX-License-Identifier: Apache-2.0
// A process's log: lines "time name level text" on standard error, which its starter keeps. With
// proto/base/format.h the only user of spdlog. Any thread.
#pragma once

#include <string>
#include <utility>

#include "proto/base/format.h"

namespace corridor {

// From now on every line bears this program's name.
void start_log(const std::string& program);

void log_info(const std::string& text);
void log_warning(const std::string& text);

template <typename... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) requires(sizeof...(Args) > 0) {
  log_info(fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) requires(sizeof...(Args) > 0) {
  log_warning(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace corridor
