// SPDX-License-Identifier: Apache-2.0
#include "learner/learner_state.h"

#include <algorithm>
#include <utility>

#include "proto/base/failure.h"
#include "proto/base/json.h"

namespace corridor::learner {
namespace {

// "published.0.mop" ..., oldest first.
std::string published_name(std::size_t i, const char* member) {
  return fmt::format("published.{}.{}", i, member);
}

std::string shape_json(const NetworkShape& shape) {
  return Json{{"observations", shape.observations},
              {"hidden", shape.hidden},
              {"actions", shape.actions},
              {"dueling", shape.dueling}}
      .dump();
}

// Reads tensors of a known size.
class Reader {
 public:
  Reader(const TensorFile& tensors, const std::string& file) : tensors_(tensors), file_(file) {}

  std::vector<float> floats(const std::string& name, std::size_t size) const {
    return sized<float>(name, size);
  }
  template <typename T>
  T number(const std::string& name) const {
    return sized<T>(name, 1)[0];
  }
  bool has(const std::string& name) const { return tensors_.tensors.contains(name); }

 private:
  template <typename T>
  const std::vector<T>& sized(const std::string& name, std::size_t size) const {
    const std::vector<T>& values = tensors_.get<T>(name, file_);
    if (values.size() != size) {
      throw Failure("{}: '{}' has {} values, config.toml asks for {}; was config.toml changed?",
                    file_, name, values.size(), size);
    }
    return values;
  }

  const TensorFile& tensors_;
  const std::string& file_;
};

}  // namespace

Phase phase_in_progress(const Schedule& schedule, std::uint64_t next_round) {
  return schedule.phase_of(std::min(next_round, schedule.rounds() - 1));
}

Networks networks_to_use(const LearnerState& state, Phase phase) {
  Networks networks = state.published.back().networks;
  if (state.best) networks[phase] = state.best->parameters;
  return networks;
}

TensorFile to_tensors(const LearnerState& state, const RunConfig& config) {
  const Phase phase = phase_in_progress(Schedule(config), state.next_round);
  TensorFile tensors;
  tensors.metadata = {{"format", "corridor learner checkpoint"},
                      {"phase", phase_name(phase)},
                      {"round", std::to_string(state.next_round)}};
  Networks networks = networks_to_use(state, phase);
  for (const NamedNetwork& network : kNetworks) {
    tensors.metadata[fmt::format("{}.shape", network.name)] =
        shape_json(config.network(network.id));
    tensors.put(network.name, std::move(networks[network.id]));
  }

  tensors.put("next_round", std::vector{state.next_round});
  tensors.put("td.online", state.td.online);
  tensors.put("td.target", state.td.target);
  tensors.put("td.mean_gradient", state.td.mean_gradient);
  tensors.put("td.mean_squared_gradient", state.td.mean_squared_gradient);
  tensors.put("td.updates", std::vector{state.td.updates});
  for (std::size_t i = 0; i < state.published.size(); ++i) {
    tensors.put(published_name(i, "version"), std::vector{state.published[i].version});
    for (const NamedNetwork& network : kNetworks) {
      tensors.put(published_name(i, network.name), state.published[i].networks[network.id]);
    }
  }
  if (state.best) {
    tensors.put("best.version", std::vector{state.best->version});
    tensors.put("best.score", std::vector{state.best->score});
    tensors.put("best.parameters", state.best->parameters);
  }
  return tensors;
}

LearnerState from_tensors(const TensorFile& tensors, const RunConfig& config,
                          const std::string& file) {
  const Reader reader(tensors, file);
  const Schedule schedule(config);
  LearnerState state;
  state.next_round = reader.number<std::uint64_t>("next_round");
  if (state.next_round > schedule.rounds()) {
    throw Failure("{}: {} rounds done of {}; was config.toml changed?", file, state.next_round,
                  schedule.rounds());
  }
  const std::size_t learning = config.parameters(phase_in_progress(schedule, state.next_round));
  state.td = {reader.floats("td.online", learning), reader.floats("td.target", learning),
              reader.floats("td.mean_gradient", learning),
              reader.floats("td.mean_squared_gradient", learning),
              reader.number<std::uint64_t>("td.updates")};
  for (std::size_t i = 0; i < 2 && (i == 0 || reader.has(published_name(i, "version"))); ++i) {
    Weights weights{reader.number<std::uint64_t>(published_name(i, "version")), {}};
    for (const NamedNetwork& network : kNetworks) {
      weights.networks[network.id] =
          reader.floats(published_name(i, network.name), config.parameters(network.id));
    }
    state.published.push_back(std::move(weights));
  }
  if (state.published.back().version != state.next_round) {
    throw Failure("{}: weights {} published before round {}; the file is damaged", file,
                  state.published.back().version, state.next_round);
  }
  if (reader.has("best.version")) {
    state.best =
        Candidate{reader.number<std::uint64_t>("best.version"), reader.number<double>("best.score"),
                  reader.floats("best.parameters", learning)};
  }
  return state;
}

}  // namespace corridor::learner
