// SPDX-License-Identifier: Apache-2.0
#include "cluster/watch/line_tail.h"

#include <algorithm>
#include <fstream>

namespace corridor::cluster {

LineTail::LineTail(std::filesystem::path file) : file_(std::move(file)) {
  std::error_code missing;
  const std::uintmax_t size = std::filesystem::file_size(file_, missing);
  if (!missing) offset_ = size;
}

std::vector<std::string> LineTail::read() {
  constexpr std::size_t kChunkBytes = 4 * 1024 * 1024;
  std::ifstream in(file_, std::ios::binary | std::ios::ate);
  if (!in) return {};
  const auto size = static_cast<std::uintmax_t>(in.tellg());
  if (size < offset_) offset_ = 0;  // it was written anew
  std::string content(std::min<std::uintmax_t>(size - offset_, kChunkBytes), '\0');
  in.seekg(static_cast<std::streamoff>(offset_));
  in.read(content.data(), static_cast<std::streamsize>(content.size()));
  content.resize(static_cast<std::size_t>(in.gcount()));

  std::vector<std::string> lines;
  std::size_t start = 0;
  for (std::size_t end; (end = content.find('\n', start)) != std::string::npos; start = end + 1) {
    lines.push_back(content.substr(start, end - start));
  }
  // A chunk without an end of line is no text of ours: skipped, or it would never end.
  offset_ += start == 0 && content.size() == kChunkBytes ? content.size() : start;
  return lines;
}

}  // namespace corridor::cluster
