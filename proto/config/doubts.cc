// SPDX-License-Identifier: Apache-2.0
#include "proto/config/doubts.h"

#include <utility>

#include "proto/base/format.h"

namespace corridor {
namespace {

class Doubts {
 public:
  template <typename... Args>
  void unless(bool condition, fmt::format_string<Args...> text, Args&&... args) {
    if (!condition) lines_.push_back(fmt::format(text, std::forward<Args>(args)...));
  }
  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
};

void doubt_training(const RunConfig& config, Phase phase, Doubts& doubts) {
  const DqnSettings& dqn = config.phase(phase);
  const NamedNetwork& network = named_network(phase);
  const char* const table = network.name;
  doubts.unless(
      dqn.steps > dqn.minimum_size,
      "the {0} would learn nothing: its training ends after {1}.steps = {2}, and begins to "
      "learn with {1}.minimum_size = {3} rows",
      network.phase_name, table, dqn.steps, dqn.minimum_size);
  doubts.unless(dqn.steps >= dqn.epsilon_steps,
                "{0}.epsilon_steps = {1} is above {0}.steps = {2}: exploration never comes down to "
                "{0}.epsilon_end",
                table, dqn.epsilon_steps, dqn.steps);
  doubts.unless(dqn.steps >= dqn.annealing_steps,
                "{0}.annealing_steps = {1} is above {0}.steps = {2}: the learning rate never comes "
                "down to {0}.learning_rate_end",
                table, dqn.annealing_steps, dqn.steps);
  doubts.unless(dqn.steps >= config.schedule.selection_every_steps,
                "schedule.selection_every_steps = {} is above {}.steps = {}: the {} is evaluated "
                "once, in its last round, and the best of several is not chosen",
                config.schedule.selection_every_steps, table, dqn.steps, network.phase_name);
}

void doubt_world(const RunConfig& config, Doubts& doubts) {
  const TrafficSettings& traffic = config.traffic;
  doubts.unless(traffic.blind_rate_per_s == 0.0 || traffic.blind_duration_s > 0.0,
                "traffic.blind_rate_per_s = {} does nothing with traffic.blind_duration_s = 0",
                traffic.blind_rate_per_s);
  doubts.unless(
      config.evaluation.steps >= config.simulation.episode_steps,
      "evaluation.steps = {} is less than an episode of simulation.episode_steps = {}: its "
      "rewards and collisions are those of episodes' beginnings",
      config.evaluation.steps, config.simulation.episode_steps);
}

}  // namespace

std::vector<std::string> doubts_about(const RunConfig& config) {
  Doubts doubts;
  for (const NamedNetwork& network : kNetworks) doubt_training(config, network.id, doubts);
  doubt_world(config, doubts);
  std::int64_t all_steps = 0;
  for (const DqnSettings& dqn : config.dqn) all_steps += dqn.steps;
  doubts.unless(
      config.schedule.checkpoint_every_steps <= all_steps,
      "schedule.checkpoint_every_steps = {} is above all steps = {}: what is killed before "
      "its end begins anew",
      config.schedule.checkpoint_every_steps, all_steps);
  const std::int64_t round_steps =
      static_cast<std::int64_t>(config.schedule.steps_per_round) * config.run.actors;
  for (const NamedNetwork& network : kNetworks) {
    doubts.unless(
        round_steps * 4 <= config.phase(network.id).steps,
        "a round of schedule.steps_per_round = {} and {} actors is {} steps, and {}.steps "
        "= {}: weights hardly ever get to the actors",
        config.schedule.steps_per_round, config.run.actors, round_steps, network.name,
        config.phase(network.id).steps);
  }
  return doubts.take();
}

}  // namespace corridor
