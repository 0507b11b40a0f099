// SPDX-License-Identifier: Apache-2.0
#include "proto/run/metrics.h"

#include <sys/resource.h>

#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/system/clock.h"

namespace corridor {
namespace {

// The largest share of the process that has been in memory.
double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Whether a process died in the middle of the file's last line.
bool ends_torn(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in || in.tellg() == std::ifstream::pos_type(0)) return false;
  in.seekg(-1, std::ios::end);
  return in.get() != '\n';
}

}  // namespace

MetricsWriter::MetricsWriter(const std::filesystem::path& file)
    : file_(file), start_s_(monotonic_s()) {
  const bool torn = ends_torn(file);
  out_.open(file, std::ios::binary | std::ios::app);
  if (!out_) throw Failure("cannot open {} to append metrics to it", file.string());
  if (torn) out_ << '\n';
}

void MetricsWriter::write(const char* phase, std::uint64_t round, std::int64_t step,
                          const std::vector<std::pair<std::string, double>>& values) {
  OrderedJson line = {{"phase", phase},
                      {"round", round},
                      {"step", step},
                      {"time_s", monotonic_s() - start_s_},
                      {"memory_mb", peak_memory_mb()}};
  for (const auto& [name, value] : values) line[name] = value;  // NaN and infinity become null
  out_ << line.dump() << '\n' << std::flush;
  if (!out_) throw Failure("cannot write metrics to {}: is the disk full?", file_.string());
}

double value_of(const MetricsValues& values, std::string_view name) {
  const auto found = values.find(name);
  return found == values.end() ? 0.0 : found->second;
}

std::optional<MetricsLine> parse_metrics_line(std::string_view text) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  MetricsLine line;
  try {
    json.at("phase").get_to(line.phase);
    line.round = whole_number<std::uint64_t>(json.at("round"));
    line.step = whole_number<std::int64_t>(json.at("step"));
  } catch (const std::exception&) {
    return std::nullopt;
  }
  for (const auto& [name, value] : json.items()) {
    // What was not finite is null.
    if (value.is_number() && name != "round" && name != "step") line.values[name] = value;
  }
  return line;
}

std::optional<MetricsLine> last_metrics_line(const std::filesystem::path& file) {
  // Longer than any two lines, so that it holds a whole one.
  constexpr std::streamoff kTailBytes = 64 * 1024;
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return std::nullopt;
  in.seekg(std::max<std::streamoff>(0, in.tellg() - kTailBytes));
  std::optional<MetricsLine> last;
  for (std::string text; std::getline(in, text);) {
    if (auto line = parse_metrics_line(text)) last = std::move(line);
  }
  return last;
}

}  // namespace corridor
