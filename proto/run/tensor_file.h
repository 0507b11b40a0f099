// SPDX-License-Identifier: Apache-2.0
// Named arrays in one file, in the safetensors format (8-byte header length, JSON header, raw
// little-endian data), which Python reads with `safetensors` or a few lines of NumPy.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "proto/base/failure.h"

namespace corridor {

using TensorData = std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint64_t>,
                                std::vector<std::uint8_t>>;

// The format's names of these types, in this order.
inline constexpr std::array kTensorTypes = {"F32", "F64", "U64", "U8"};
static_assert(kTensorTypes.size() == std::variant_size_v<TensorData>);
template <typename T>
const char* tensor_type() {
  return kTensorTypes[TensorData(std::vector<T>()).index()];
}

struct Tensor {
  std::vector<std::size_t> shape;
  TensorData data;  // row-major; as many values as the shape says
  bool operator==(const Tensor&) const = default;
};

// Ordered by name, so that equal content gives equal bytes.
struct TensorFile {
  std::map<std::string, Tensor> tensors;
  std::map<std::string, std::string> metadata;

  // One-dimensional array under `name`.
  template <typename T>
  void put(const std::string& name, std::vector<T> values) {
    const std::size_t size = values.size();
    tensors.insert_or_assign(name, Tensor{{size}, std::move(values)});
  }
  // Throws Failure when missing or of another type; `file` names it in the message.
  template <typename T>
  const std::vector<T>& get(const std::string& name, const std::string& file) const {
    const auto found = tensors.find(name);
    if (found == tensors.end()) throw Failure("{} has no tensor {}", file, name);
    const auto* values = std::get_if<std::vector<T>>(&found->second.data);
    if (!values) throw Failure("{}: tensor {} is not of type {}", file, name, tensor_type<T>());
    return *values;
  }

  bool operator==(const TensorFile&) const = default;
};

// Atomic (as write_file). Throws Failure on I/O errors.
void write_tensors(const std::filesystem::path& file, const TensorFile& content);
// Throws Failure naming the file: missing, truncated, a header that lies about sizes or offsets.
TensorFile read_tensors(const std::filesystem::path& file);
// The same from a file's content; `name` names it in messages.
TensorFile parse_tensors(std::string_view content, const std::string& name);

}  // namespace corridor
