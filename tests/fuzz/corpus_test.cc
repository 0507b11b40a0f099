// SPDX-License-Identifier: Apache-2.0
// What fuzzers have found worth keeping, read again: by every compiler, under every sanitizer.
#include <gtest/gtest.h>

#include <filesystem>

#include "proto/system/files.h"
#include "tests/fuzz/targets.h"

namespace corridor::fuzz {
namespace {

namespace fs = std::filesystem;

TEST(Corpus, IsReadWithoutAFinding) {
  for (const Target& target : targets()) {
    int files = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(CORRIDOR_SOURCE_DIR) /
                                                    "tests/fuzz/corpus" / target.name)) {
      SCOPED_TRACE(entry.path());
      const std::string whole = read_file(entry.path());
      // Also cut off everywhere, as files of a full disk are; of long ones at some places.
      const std::size_t every = whole.size() / 256 + 1;
      for (std::size_t size = 0; size < whole.size(); size += every) {
        target.read(std::string_view(whole).substr(0, size));
      }
      target.read(whole);
      ++files;
    }
    EXPECT_GT(files, 0) << target.name;
  }
}

}  // namespace
}  // namespace corridor::fuzz
