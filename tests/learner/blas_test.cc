// SPDX-License-Identifier: Apache-2.0
#include "learner/blas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace corridor::learner {
namespace {

TEST(Blas, NamesTheFileThatIsLoaded) {
  const Blas blas = blas_in_use();
  if (!blas.library.empty()) {
    EXPECT_TRUE(std::filesystem::exists(blas.library)) << blas.library;
  }
  EXPECT_EQ(blas.core.empty(), blas.library.find("openblas") == std::string::npos);
}

TEST(Blas, WarnsOfTheReferenceLibraryOnly) {
  EXPECT_THAT(warning_about({"/usr/lib/x86_64-linux-gnu/blas/libblas.so.3.11.0", "", ""}),
              testing::HasSubstr("apt-get install libopenblas0-serial"));
  EXPECT_EQ(warning_about({"/usr/lib/x86_64-linux-gnu/openblas-serial/libblas.so.3", "Zen", ""}),
            "");
  EXPECT_EQ(warning_about({}), "");
}

}  // namespace
}  // namespace corridor::learner
