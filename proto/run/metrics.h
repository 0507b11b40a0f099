// Named numbers over training steps, one JSON object a line; names as in CleanRL and TensorBoard
// ("charts/SPS", "losses/td_loss", "replay/size").
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace corridor {

class MetricsWriter {
 public:
  // Appends. Throws Failure when the file cannot be opened.
  explicit MetricsWriter(const std::filesystem::path& file);

  // {"phase":"MoP","round":7,"step":3584,"time_s":1.25,"memory_mb":61.5,<name>:<value>,...}. `step`
  // counts the phase's environment steps of all actors; time_s is seconds since the writer was
  // made, memory_mb the process's peak resident memory: these, time/* and */SPS are all that
  // differs between two equal runs. Flushed at once. Throws Failure when the disk is full.
  void write(const char* phase, std::uint64_t round, std::int64_t step,
             const std::vector<std::pair<std::string, double>>& values);

 private:
  std::filesystem::path file_;
  std::ofstream out_;
  double start_s_;
};

// The numbers of a metrics line by name.
using MetricsValues = std::map<std::string, double, std::less<>>;

// 0 when there is no such number.
double value_of(const MetricsValues& values, std::string_view name);

// One line of a metrics file (proto/run/metrics.h).
struct MetricsLine {
  std::string phase;
  std::uint64_t round = 0;
  std::int64_t step = 0;
  MetricsValues values;  // all other numbers by name
};

// Nothing when the text is no such line.
std::optional<MetricsLine> parse_metrics_line(std::string_view text);

// The last whole line of a metrics file; nothing when the file is missing or has none.
std::optional<MetricsLine> last_metrics_line(const std::filesystem::path& file);

}  // namespace corridor
