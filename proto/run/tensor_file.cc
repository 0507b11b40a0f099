// SPDX-License-Identifier: Apache-2.0
#include "proto/run/tensor_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>

#include "proto/base/text.h"
#include "proto/run/json_record.h"
#include "proto/system/files.h"

namespace corridor {
namespace {

static_assert(std::endian::native == std::endian::little, "the format's numbers are little-endian");

constexpr std::size_t kLengthBytes = 8;
constexpr const char* kMetadataKey = "__metadata__";

std::size_t size_of(const TensorData& data) {
  return std::visit([](const auto& values) { return values.size(); }, data);
}

std::string_view bytes_of(const TensorData& data) {
  return std::visit(
      [](const auto& values) {
        return std::string_view(reinterpret_cast<const char*>(values.data()),
                                values.size() * sizeof(values[0]));
      },
      data);
}

// As many values as fill `bytes`, in memory of their own: the file's may be misaligned.
template <typename T>
std::vector<T> values_from(std::string_view bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

TensorData data_from(const std::string& type, std::string_view bytes) {
  if (type == tensor_type<float>()) return values_from<float>(bytes);
  if (type == tensor_type<double>()) return values_from<double>(bytes);
  if (type == tensor_type<std::uint64_t>()) return values_from<std::uint64_t>(bytes);
  if (type == tensor_type<std::uint8_t>()) return values_from<std::uint8_t>(bytes);
  throw Failure("type {} is none of {}", type, listed(kTensorTypes));
}

// Values that a shape asks for; nothing when more than `limit`.
std::optional<std::size_t> value_count(const std::vector<std::size_t>& shape, std::size_t limit) {
  std::size_t count = 1;
  for (const std::size_t extent : shape) {
    if (__builtin_mul_overflow(count, extent, &count)) return std::nullopt;
  }
  return count <= limit ? std::optional(count) : std::nullopt;
}

struct Extent {
  std::size_t begin = 0;
  std::size_t end = 0;
  auto operator<=>(const Extent&) const = default;
};

// One entry of the header. Its numbers may lie.
Tensor tensor_from(const Json& entry, std::string_view data, std::vector<Extent>& extents) {
  std::vector<std::size_t> offsets;
  read_value(entry.at("data_offsets"), offsets);
  if (offsets.size() != 2) throw Failure("it has {} offsets", offsets.size());
  const Extent extent{offsets[0], offsets[1]};
  if (extent.begin > extent.end || extent.end > data.size()) {
    throw Failure("it lies outside the file's {} bytes of data", data.size());
  }
  extents.push_back(extent);
  const std::string_view bytes = data.substr(extent.begin, extent.end - extent.begin);
  Tensor tensor;
  read_value(entry.at("shape"), tensor.shape);
  tensor.data = data_from(entry.at("dtype").get<std::string>(), bytes);
  const std::size_t size = size_of(tensor.data);
  if (value_count(tensor.shape, size) != size || bytes_of(tensor.data).size() != bytes.size()) {
    throw Failure("its shape does not fit its {} bytes", bytes.size());
  }
  return tensor;
}

// As safetensors demands: every byte of the data belongs to exactly one tensor.
void check_cover(std::vector<Extent> extents, std::size_t data_bytes) {
  std::ranges::sort(extents);
  std::size_t covered = 0;
  for (const Extent& extent : extents) {
    if (extent.begin != covered) throw Failure("tensors overlap or leave a gap");
    covered = extent.end;
  }
  if (covered != data_bytes) {
    throw Failure("it has {} bytes of data where its header says {}", data_bytes, covered);
  }
}

TensorFile parse(std::string_view content) {
  if (content.size() < kLengthBytes) throw Failure("it is only {} bytes long", content.size());
  std::uint64_t header_bytes = 0;
  std::memcpy(&header_bytes, content.data(), kLengthBytes);
  content.remove_prefix(kLengthBytes);
  if (header_bytes > content.size()) throw Failure("its header is cut off");
  const std::string_view header = content.substr(0, header_bytes);
  const std::string_view data = content.substr(header_bytes);

  TensorFile file;
  std::vector<Extent> extents;
  const Json entries = Json::parse(header);
  if (!entries.is_object()) throw Failure("its header is no object");
  for (const auto& [name, entry] : entries.items()) {
    if (name == kMetadataKey) {
      file.metadata = entry.get<std::map<std::string, std::string>>();
      continue;
    }
    try {
      file.tensors.emplace(name, tensor_from(entry, data, extents));
    } catch (const std::exception& error) {
      throw Failure("tensor {}: {}", name, error.what());
    }
  }
  check_cover(std::move(extents), data.size());
  return file;
}

}  // namespace

void write_tensors(const std::filesystem::path& file, const TensorFile& content) {
  Json header = Json::object();
  if (!content.metadata.empty()) header[kMetadataKey] = content.metadata;
  std::size_t offset = 0;
  for (const auto& [name, tensor] : content.tensors) {
    const std::size_t size = size_of(tensor.data);
    CORRIDOR_CHECK(value_count(tensor.shape, size) == size, "tensor {} has {} values", name, size);
    const std::size_t end = offset + bytes_of(tensor.data).size();
    header[name] = {{"dtype", kTensorTypes[tensor.data.index()]},
                    {"shape", tensor.shape},
                    {"data_offsets", {offset, end}}};
    offset = end;
  }

  std::string text = header.dump();
  text.resize((text.size() + 7) / 8 * 8, ' ');  // aligns the data
  const std::uint64_t header_bytes = text.size();
  std::string bytes;
  bytes.reserve(kLengthBytes + text.size() + offset);
  bytes.append(reinterpret_cast<const char*>(&header_bytes), kLengthBytes);
  bytes.append(text);
  for (const auto& [name, tensor] : content.tensors) bytes.append(bytes_of(tensor.data));
  write_file(file, bytes);
}

TensorFile parse_tensors(std::string_view content, const std::string& name) {
  try {
    return parse(content);
  } catch (const std::exception& error) {
    throw Failure("{} is no whole safetensors file: {}", name, error.what());
  }
}

TensorFile read_tensors(const std::filesystem::path& file) {
  return parse_tensors(read_file(file), file.string());
}

}  // namespace corridor
