// SPDX-License-Identifier: Apache-2.0
#include "proto/run/tensor_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>

#include "proto/base/failure.h"
#include "proto/base/random.h"
#include "proto/run/run_directory.h"
#include "proto/system/files.h"
#include "tests/support/temporary_directory.h"

namespace corridor {
namespace {

using testing::HasSubstr;

class TensorFiles : public testing::Test {
 protected:
  // The text of what `read_tensors` throws for these bytes, or nothing.
  std::string failure_of(const std::string& bytes) const {
    std::filesystem::remove(file_);  // some file systems flush what is overwritten
    std::ofstream(file_, std::ios::binary) << bytes;
    try {
      read_tensors(file_);
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "";
  }
  static std::string with_header(const std::string& header, const std::string& data) {
    const std::uint64_t size = header.size();
    std::string bytes(8, '\0');
    std::memcpy(bytes.data(), &size, 8);
    return bytes + header + data;
  }
  static TensorFile sample() {
    TensorFile content;
    content.put<float>("weights", {1.5F, -0.0F, std::numeric_limits<float>::infinity()});
    content.put<double>("a", {1e300});
    content.put<std::uint64_t>("keys", {~0ULL, 0});
    content.put<std::uint8_t>("actions", {1, 2, 255});
    content.put<float>("empty", {});
    content.tensors["matrix"] = {{2, 3}, std::vector<float>{1, 2, 3, 4, 5, 6}};
    content.tensors["scalar"] = {{}, std::vector<double>{7}};
    content.metadata = {{"round", "12"}, {"note", "\"quoted\" \xc3\xa4\n"}};
    return content;
  }

  testing_support::TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_.path() / "x.safetensors";
};

TEST_F(TensorFiles, ComeBackEqual) {
  write_tensors(file_, sample());
  EXPECT_EQ(read_tensors(file_), sample());
  write_tensors(file_, {});
  EXPECT_EQ(read_tensors(file_), TensorFile{});
}

TEST_F(TensorFiles, EqualContentGivesEqualBytes) {
  write_tensors(file_, sample());
  const std::string once = read_file(file_);
  write_tensors(file_, sample());
  EXPECT_EQ(read_file(file_), once);
}

TEST_F(TensorFiles, FollowTheSafetensorsFormatByteByByte) {
  TensorFile content;
  content.put<float>("w", {1.0F});
  write_tensors(file_, content);
  const std::string header = R"({"w":{"data_offsets":[0,4],"dtype":"F32","shape":[1]}})";
  EXPECT_EQ(read_file(file_),
            with_header(header + std::string(56 - header.size(), ' '), {"\0\0\x80\x3f", 4}));
}

TEST_F(TensorFiles, GetNamesTheFileWhenATensorIsMissingOrOfAnotherType) {
  const TensorFile content = sample();
  EXPECT_EQ(content.get<std::uint64_t>("keys", "f").size(), 2U);
  try {
    content.get<float>("nothing", "run/x.safetensors");
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_STREQ(failure.what(), "run/x.safetensors has no tensor nothing");
  }
  try {
    content.get<float>("keys", "run/x.safetensors");
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_STREQ(failure.what(), "run/x.safetensors: tensor keys is not of type F32");
  }
}

TEST_F(TensorFiles, CutOffAtAnyLengthTheyAreRefused) {
  write_tensors(file_, sample());
  const std::string whole = read_file(file_);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THAT(failure_of(whole.substr(0, size)), HasSubstr(file_.string())) << size;
  }
  EXPECT_THAT(failure_of(whole + "x"), HasSubstr("bytes of data where its header says"));
}

TEST_F(TensorFiles, HeadersThatLieAreRefused) {
  const std::string four = "abcd";
  const auto entry = [](const std::string& name, const std::string& type, const std::string& shape,
                        const std::string& offsets) {
    return "\"" + name + R"(":{"dtype":")" + type + R"(","shape":)" + shape +
           R"(,"data_offsets":)" + offsets + "}";
  };
  const auto lie = [&](const std::string& entries) {
    return failure_of(with_header("{" + entries + "}", four));
  };
  ASSERT_EQ(lie(entry("w", "F32", "[1]", "[0,4]")), "");
  EXPECT_THAT(lie(entry("w", "F32", "[2]", "[0,4]")), HasSubstr("tensor w: its shape"));
  EXPECT_THAT(lie(entry("w", "F32", "[4294967296,4294967296]", "[0,4]")), HasSubstr("its shape"));
  EXPECT_THAT(lie(entry("w", "F32", "[1]", "[0,8]")), HasSubstr("outside"));
  EXPECT_THAT(lie(entry("w", "F32", "[1]", "[4,0]")), HasSubstr("outside"));
  EXPECT_THAT(lie(entry("w", "F32", "[1]", "[0,18446744073709551615]")), HasSubstr("outside"));
  EXPECT_THAT(lie(entry("w", "F32", "[-1]", "[0,4]")), HasSubstr("whole number"));
  EXPECT_THAT(lie(entry("w", "F16", "[2]", "[0,4]")), HasSubstr("type F16"));
  EXPECT_THAT(lie(entry("w", "U8", "[3]", "[0,3]")), HasSubstr("4 bytes of data"));
  EXPECT_THAT(lie(entry("w", "F32", "[1]", "[0,4]") + "," + entry("v", "F32", "[1]", "[0,4]")),
              HasSubstr("overlap"));
  EXPECT_THAT(lie(entry("w", "U8", "[1]", "[0,1]") + "," + entry("v", "U8", "[2]", "[2,4]")),
              HasSubstr("gap"));
  EXPECT_THAT(lie(entry("w", "F32", "\"1\"", "[0,4]")), HasSubstr("tensor w"));
  EXPECT_THAT(lie(entry("w", "F32", "[1]", "[0]")), HasSubstr("tensor w"));
  EXPECT_THAT(lie(R"("w":3)"), HasSubstr("tensor w"));
  EXPECT_THAT(lie(R"("__metadata__":3)"), HasSubstr("no whole safetensors file"));
  EXPECT_THAT(lie("nonsense"), HasSubstr("no whole safetensors file"));
  EXPECT_THAT(failure_of(with_header("[]", "")), HasSubstr("no object"));
  EXPECT_THAT(failure_of(std::string(8, '\xff') + "{}"), HasSubstr("cut off"));
}

TEST_F(TensorFiles, FlippedBytesNeverCrashTheReader) {
  write_tensors(file_, sample());
  const std::string whole = read_file(file_);
  for (std::uint64_t round = 0; round < 300; ++round) {
    std::string damaged = whole;
    for (std::uint64_t i = 0; i < 3; ++i) {
      damaged[random_below(whole.size(), 1, Purpose::kWireDelay, {round, i})] ^=
          static_cast<char>(1 + random_below(255, 2, Purpose::kWireDelay, {round, i}));
    }
    failure_of(damaged);
  }
}

TEST_F(TensorFiles, MissingOnesAreNamed) {
  EXPECT_THROW(read_tensors(directory_.path() / "none"), Failure);
}

}  // namespace
}  // namespace corridor
