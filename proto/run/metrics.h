// SPDX-License-Identifier: Apache-2.0
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

// What the processes of a training write and others read; the "time/" names stand in
// proto/system/time_account.h. Over the steps since the process's last line, unless said otherwise.
namespace metric {
// An actor's, of the phase's planner as it explores.
inline constexpr const char* kStepsPerS = "charts/SPS";  // the learner's too, of all actors
inline constexpr const char* kRewardPer1000 = "charts/reward_per_1000";
inline constexpr const char* kCollisionsPer1000 = "charts/collisions_per_1000";
inline constexpr const char* kEpsilon = "charts/epsilon";
inline constexpr const char* kEpisodicReturn = "charts/episodic_return";  // mean over kEpisodes
inline constexpr const char* kEpisodes = "charts/episodes";               // that ended
// The learner's.
inline constexpr const char* kUpdates = "charts/updates";  // of the phase so far
inline constexpr const char* kLearningRate = "charts/learning_rate";
inline constexpr const char* kTdLoss = "losses/td_loss";  // this and the next two: of its batches
inline constexpr const char* kQValues = "losses/q_values";
inline constexpr const char* kRiskValues = "losses/risk_values";
inline constexpr const char* kGreedyRewardPer1000 = "eval/reward_per_1000";  // of a selection
inline constexpr const char* kGreedyCollisionsPer1000 = "eval/collisions_per_1000";
inline constexpr const char* kGreedyScore = "eval/score";
// The replay server's, of the phase so far.
inline constexpr const char* kReplaySize = "replay/size";
inline constexpr const char* kReplayInserted = "replay/inserted";
inline constexpr const char* kReplaySampled = "replay/sampled";
inline constexpr const char* kSamplesPerInsert = "replay/samples_per_insert";
inline constexpr const char* kStalePriorities = "replay/stale_priorities";
}  // namespace metric

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
