// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/tensorboard.h"

#include <boost/crc.hpp>

#include "cluster/watch/tensorboard_event.pb.h"
#include "proto/base/failure.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"

namespace corridor::cluster {
namespace {

std::string little_endian(std::uint64_t number, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(number >> (8 * i));
  return text;
}

// As TensorFlow masks it: the CRC of data that hold their own CRC is weak.
std::string masked_crc(const std::string& data) {
  boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> castagnoli;
  castagnoli.process_bytes(data.data(), data.size());
  const std::uint32_t crc = castagnoli.checksum();
  return little_endian(((crc >> 15 | crc << 17) + 0xa282ead8u) & 0xFFFFFFFFu, 4);
}

// The first number of which there is no file yet.
std::filesystem::path next_file(const std::filesystem::path& folder) {
  for (int number = 1;; ++number) {
    auto file = folder / fmt::format("events.out.tfevents.{:06}", number);
    std::error_code unreadable;
    if (!std::filesystem::exists(file, unreadable)) return file;
  }
}

tensorboard::Event event_at(std::int64_t step, double wall_time_s) {
  tensorboard::Event event;
  event.set_step(step);
  event.set_wall_time(wall_time_s);
  return event;
}

}  // namespace

EventWriter::EventWriter(const std::filesystem::path& folder, double wall_time_s) {
  create_folders(folder);
  file_ = next_file(folder);
  out_.open(file_, std::ios::binary);
  if (!out_) throw Failure("cannot write {}", file_.string());
  tensorboard::Event event = event_at(0, wall_time_s);
  event.set_file_version("brain.Event:2");
  append(event.SerializeAsString());
}

void EventWriter::start(std::int64_t step, double wall_time_s) {
  tensorboard::Event event = event_at(step, wall_time_s);
  event.mutable_session_log()->set_status(tensorboard::SessionLog::START);
  append(event.SerializeAsString());
}

void EventWriter::write(std::int64_t step,
                        const std::vector<std::pair<std::string, double>>& values,
                        double wall_time_s) {
  tensorboard::Event event = event_at(step, wall_time_s);
  for (const auto& [tag, value] : values) {
    tensorboard::Summary::Value* added = event.mutable_summary()->add_value();
    added->set_tag(tag);
    added->set_simple_value(static_cast<float>(value));
  }
  append(event.SerializeAsString());
}

void EventWriter::append(const std::string& payload) {
  const std::string length = little_endian(payload.size(), 8);
  out_ << length << masked_crc(length) << payload << masked_crc(payload) << std::flush;
  if (!out_) throw Failure("cannot write {}: is the disk full?", file_.string());
}

}  // namespace corridor::cluster
