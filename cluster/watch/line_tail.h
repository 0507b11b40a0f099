// SPDX-License-Identifier: Apache-2.0
// What other processes append to a text file, line by line, as it comes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace corridor::cluster {

// The file may come later.
class LineTail {
 public:
  // Begins at the file's present end.
  explicit LineTail(std::filesystem::path file);

  // The whole lines since the last call; a line without its end yet waits for the next call. At
  // most 4 MiB a call, the rest follows.
  std::vector<std::string> read();

 private:
  std::filesystem::path file_;
  std::uintmax_t offset_ = 0;
};

}  // namespace corridor::cluster
