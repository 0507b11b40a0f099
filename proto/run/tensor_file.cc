#include "proto/run/tensor_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>

#include "proto/base/failure.h"
#include "proto/base/json.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"

namespace corridor {
namespace {

static_assert(std::endian::native == std::endian::little, "the format's numbers are little-endian");

constexpr std::size_t kLengthBytes = 8;
constexpr const char* kMetadataKey = "__metadata__";

// The format's name of each type in TensorData.
template <typename T>
constexpr const char* kTypeName = nullptr;
template <>
constexpr const char* kTypeName<float> = "F32";
template <>
constexpr const char* kTypeName<double> = "F64";
template <>
constexpr const char* kTypeName<std::uint64_t> = "U64";
template <>
constexpr const char* kTypeName<std::uint8_t> = "U8";

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
  if (type == kTypeName<float>) return values_from<float>(bytes);
  if (type == kTypeName<double>) return values_from<double>(bytes);
  if (type == kTypeName<std::uint64_t>) return values_from<std::uint64_t>(bytes);
  if (type == kTypeName<std::uint8_t>) return values_from<std::uint8_t>(bytes);
  throw Failure("type {} is none of F32, F64, U64, U8", type);
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
};

// One entry of the header. Its numbers may lie.
Tensor tensor_from(const Json& entry, std::string_view data, std::vector<Extent>& extents) {
  const std::vector<std::size_t> offsets = whole_numbers<std::size_t>(entry.at("data_offsets"));
  if (offsets.size() != 2) throw Failure("it has {} offsets", offsets.size());
  const Extent extent{offsets[0], offsets[1]};
  if (extent.begin > extent.end || extent.end > data.size()) {
    throw Failure("it lies outside the file's {} bytes of data", data.size());
  }
  extents.push_back(extent);
  const std::string_view bytes = data.substr(extent.begin, extent.end - extent.begin);
  Tensor tensor{whole_numbers<std::size_t>(entry.at("shape")),
                data_from(entry.at("dtype").get<std::string>(), bytes)};
  const auto [size, width] = std::visit(
      [](const auto& values) { return std::pair(values.size(), sizeof(values[0])); }, tensor.data);
  if (value_count(tensor.shape, size) != size || size * width != bytes.size()) {
    throw Failure("its shape does not fit its {} bytes", bytes.size());
  }
  return tensor;
}

// As safetensors demands: every byte of the data belongs to exactly one tensor.
void check_cover(std::vector<Extent> extents, std::size_t data_bytes) {
  std::sort(extents.begin(), extents.end(), [](const Extent& a, const Extent& b) {
    return std::pair(a.begin, a.end) < std::pair(b.begin, b.end);
  });
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

template <typename T>
const std::vector<T>& TensorFile::get(const std::string& name, const std::string& file) const {
  const auto found = tensors.find(name);
  if (found == tensors.end()) throw Failure("{} has no tensor {}", file, name);
  const auto* values = std::get_if<std::vector<T>>(&found->second.data);
  if (!values) throw Failure("{}: tensor {} is not of type {}", file, name, kTypeName<T>);
  return *values;
}

template const std::vector<float>& TensorFile::get(const std::string&, const std::string&) const;
template const std::vector<double>& TensorFile::get(const std::string&, const std::string&) const;
template const std::vector<std::uint64_t>& TensorFile::get(const std::string&,
                                                           const std::string&) const;
template const std::vector<std::uint8_t>& TensorFile::get(const std::string&,
                                                          const std::string&) const;

void write_tensors(const std::filesystem::path& file, const TensorFile& content) {
  Json header = Json::object();
  if (!content.metadata.empty()) header[kMetadataKey] = content.metadata;
  std::size_t offset = 0;
  for (const auto& [name, tensor] : content.tensors) {
    const char* type =
        std::visit([](const auto& values) { return kTypeName<std::decay_t<decltype(values[0])>>; },
                   tensor.data);
    const std::size_t size = std::visit([](const auto& v) { return v.size(); }, tensor.data);
    CORRIDOR_CHECK(value_count(tensor.shape, size) == size, "tensor {} has {} values", name, size);
    const std::size_t end = offset + bytes_of(tensor.data).size();
    header[name] = {{"dtype", type}, {"shape", tensor.shape}, {"data_offsets", {offset, end}}};
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
