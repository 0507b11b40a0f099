#include "proto/metrics.h"

#include <sys/resource.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "proto/failure.h"

namespace corridor {
namespace {

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

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

MetricsWriter::MetricsWriter(const std::filesystem::path& file) : file_(file), start_s_(now_s()) {
  const bool torn = ends_torn(file);
  out_.open(file, std::ios::binary | std::ios::app);
  if (!out_) throw Failure("cannot open {} to append metrics to it", file.string());
  if (torn) out_ << '\n';
}

void MetricsWriter::write(const char* phase, std::uint64_t round, std::int64_t step,
                          const std::vector<std::pair<std::string, double>>& values) {
  nlohmann::ordered_json line = {{"phase", phase},
                                 {"round", round},
                                 {"step", step},
                                 {"time_s", now_s() - start_s_},
                                 {"memory_mb", peak_memory_mb()}};
  for (const auto& [name, value] : values) line[name] = value;  // NaN and infinity become null
  out_ << line.dump() << '\n' << std::flush;
  if (!out_) throw Failure("cannot write metrics to {}: is the disk full?", file_.string());
}

}  // namespace corridor
