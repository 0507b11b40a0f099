// SPDX-License-Identifier: Apache-2.0
// The adapter of TensorBoard: event files that it reads while they grow. A file is a sequence of
// TFRecords: the payload's length (8 bytes, little-endian), the masked CRC-32C of these 8 bytes
// (4), the payload, its masked CRC-32C (4). A payload is a message Event (tensorboard_event.proto).
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace corridor::cluster {

// One thread owns it.
class EventWriter {
 public:
  // Begins a new file in the folder, which it creates: TensorBoard reads a folder's files in the
  // order of their names, and these are numbered. Throws Failure when that cannot be done.
  EventWriter(const std::filesystem::path& folder, double wall_time_s);

  // What was written before of `step` and later ones counts no longer: they are driven again.
  void start(std::int64_t step, double wall_time_s);
  // Values by tag. Both throw Failure when the disk is full.
  void write(std::int64_t step, const std::vector<std::pair<std::string, double>>& values,
             double wall_time_s);

 private:
  void append(const std::string& payload);

  std::filesystem::path file_;
  std::ofstream out_;
};

}  // namespace corridor::cluster
