// SPDX-License-Identifier: Apache-2.0
#include "proto/system/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>

namespace corridor {

void start_log(const std::string& program) {
  // The sink has a lock: a thread that writes checkpoints may say something too.
  const auto logger =
      std::make_shared<spdlog::logger>(program, std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %n %l %v");
  logger->flush_on(spdlog::level::trace);
  spdlog::set_default_logger(logger);
}

void log_info(const std::string& text) { spdlog::default_logger_raw()->info(text); }
void log_warning(const std::string& text) { spdlog::default_logger_raw()->warn(text); }

}  // namespace corridor
