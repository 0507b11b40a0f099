#include "cluster/checkpoint.h"

#include <nlohmann/json.hpp>
#include <span>

#include "proto/hash.h"
#include "proto/json_numbers.h"

namespace corridor::cluster {
namespace {

void add(Hash& hash, const TensorFile& file) {
  hash.add_value(static_cast<std::uint64_t>(file.metadata.size()));
  for (const auto& [key, value] : file.metadata) {
    hash.add(key);
    hash.add(value);
  }
  hash.add_value(static_cast<std::uint64_t>(file.tensors.size()));
  for (const auto& [name, tensor] : file.tensors) {
    hash.add(name);
    hash.add_value(static_cast<std::uint64_t>(tensor.data.index()));
    hash.add_value(static_cast<std::uint64_t>(tensor.shape.size()));
    for (const std::size_t size : tensor.shape) hash.add_value(static_cast<std::uint64_t>(size));
    std::visit([&](const auto& values) { hash.add_values(std::span(values)); }, tensor.data);
  }
}

}  // namespace

std::optional<Checkpoint> newest_checkpoint(const RunDirectory& directory) {
  const std::optional<std::filesystem::path> found = directory.newest_checkpoint();
  if (!found) return std::nullopt;
  // Its presence and type were checked with the rest.
  const auto round = whole_number<std::uint64_t>(read_json(*found / "manifest.json").at("round"));
  return Checkpoint{*found, round + 1};
}

std::string fingerprint(const TensorFile& learner, const TensorFile& replay) {
  Hash hash;
  add(hash, learner);
  add(hash, replay);
  return hash.hex();
}

std::string fingerprint(const Checkpoint& checkpoint) {
  return fingerprint(read_tensors(checkpoint.directory / "learner.safetensors"),
                     read_tensors(checkpoint.directory / "replay.safetensors"));
}

}  // namespace corridor::cluster
