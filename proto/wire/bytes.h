// SPDX-License-Identifier: Apache-2.0
// The bytes of a message: being written, looked at, and where they lie once they are complete.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace corridor {

using Bytes = std::vector<std::byte>;
using ByteView = std::span<const std::byte>;

// Complete bytes, as they were received or encoded. Copies share them: what is sent may have to be
// sent again.
class Body {
 public:
  Body() = default;
  Body(Bytes bytes) {
    const auto owner = std::make_shared<const Bytes>(std::move(bytes));
    bytes_ = *owner;
    owner_ = owner;
  }
  // `owner`, of whatever type, keeps the bytes.
  Body(std::shared_ptr<const void> owner, ByteView bytes)
      : owner_(std::move(owner)), bytes_(bytes) {}
  operator ByteView() const { return bytes_; }

 private:
  std::shared_ptr<const void> owner_;
  ByteView bytes_;
};

}  // namespace corridor
