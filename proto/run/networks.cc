// SPDX-License-Identifier: Apache-2.0
#include "proto/run/networks.h"

#include <string>

#include "proto/base/failure.h"
#include "proto/run/checkpoints.h"
#include "proto/run/tensor_file.h"

namespace corridor {
namespace {

Networks networks_in(const TensorFile& tensors, const RunConfig& config, const std::string& file) {
  Networks networks;
  for (const NamedNetwork& network : kNetworks) {
    const auto& parameters = tensors.get<float>(network.name, file);
    const std::size_t expected = config.parameters(network.id);
    if (parameters.size() != expected) {
      throw Failure(
          "{}: the {} has {} parameters, the settings ask for {}: they are of another one", file,
          network.phase_name, parameters.size(), expected);
    }
    networks[network.id] = parameters;
  }
  return networks;
}

}  // namespace

std::optional<Networks> given_networks(const RunDirectory& directory, const RunConfig& config) {
  const std::filesystem::path file = directory.networks();
  if (!std::filesystem::exists(file)) return std::nullopt;
  return networks_in(read_tensors(file), config, file.string());
}

void write_networks(const RunDirectory& directory, const Networks& networks) {
  TensorFile tensors;
  tensors.metadata = {{"format", "corridor networks"}};
  for (const NamedNetwork& network : kNetworks) tensors.put(network.name, networks[network.id]);
  write_tensors(directory.networks(), tensors);
}

std::optional<Networks> newest_networks(const RunDirectory& directory, const RunConfig& config) {
  const auto checkpoint = Checkpoints(directory.checkpoints()).newest();
  if (!checkpoint) return given_networks(directory, config);
  return networks_in(read_checkpoint_file(*checkpoint, kLearnerFile), config,
                     (*checkpoint / kLearnerFile).string());
}

}  // namespace corridor
