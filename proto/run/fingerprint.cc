// SPDX-License-Identifier: Apache-2.0
#include "proto/run/fingerprint.h"

#include <algorithm>
#include <span>

#include "proto/base/failure.h"
#include "proto/base/hash.h"

namespace corridor {
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

// kReplayFile with all of the rows.
TensorFile whole_replay(const std::filesystem::path& checkpoint) {
  TensorFile replay = read_checkpoint_file(checkpoint, kReplayFile);
  const auto first_of = [&](const char* tensor) {
    return replay.get<std::uint64_t>(tensor, kReplayFile).at(0);
  };
  const std::uint64_t next_key = first_of(kNextKeyTensor);
  const std::uint64_t oldest_key = next_key - replay.get<float>(kLeavesTensor, kReplayFile).size();
  std::vector<float> rows;
  std::size_t stride = 0;
  for (const RowsFile& file : rows_files(checkpoint)) {
    const TensorFile part = read_checkpoint_file(checkpoint, file.name());
    const auto& values = part.get<float>(kRowsTensor, file.name());
    stride = part.tensors.at(kRowsTensor).shape.back();
    const std::uint64_t given_way = oldest_key > file.first_key ? oldest_key - file.first_key : 0;
    const std::size_t skipped = std::min<std::size_t>(given_way * stride, values.size());
    rows.insert(rows.end(), values.begin() + static_cast<std::ptrdiff_t>(skipped), values.end());
  }
  if (rows.size() != (next_key - oldest_key) * stride) {
    throw Failure("{} is damaged: it has not all rows with the keys {} to {}", checkpoint.string(),
                  oldest_key, next_key);
  }
  replay.tensors.insert_or_assign(kRowsTensor,
                                  Tensor{{next_key - oldest_key, stride}, std::move(rows)});
  return replay;
}

}  // namespace

std::string fingerprint(const TensorFile& learner, const TensorFile& replay) {
  Hash hash;
  add(hash, learner);
  add(hash, replay);
  return hash.hex();
}

std::string fingerprint(const std::filesystem::path& checkpoint) {
  return fingerprint(read_checkpoint_file(checkpoint, kLearnerFile), whole_replay(checkpoint));
}

}  // namespace corridor
