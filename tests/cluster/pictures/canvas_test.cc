// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/canvas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "proto/base/failure.h"
#include "proto/system/files.h"
#include "proto/system/subprocess.h"
#include "tests/support/temporary_directory.h"

namespace corridor::cluster {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using testing::ThrowsMessage;

// Of a picture, read by a program that did not write it.
class Pixels {
 public:
  Pixels(const std::string& png, int width) : width_(width) {
    testing_support::TemporaryDirectory temporary;
    const auto file = temporary.path() / "a.png";
    write_file(file, png);
    bytes_ = run_subprocess(*find_program("ffmpeg"),
                            {"-loglevel", "error", "-i", file.string(), "-f", "rawvideo",
                             "-pix_fmt", "rgb24", "-"},
                            "", std::chrono::seconds(20))
                 ->output;
  }
  int rows() const { return static_cast<int>(bytes_.size()) / 3 / width_; }
  Colour at(int x, int y) const {
    Colour colour = 0;
    for (int i = 0; i < 3; ++i) {
      const char byte = bytes_.at(static_cast<std::size_t>(3 * (y * width_ + x) + i));
      colour = colour << 8 | static_cast<unsigned char>(byte);
    }
    return colour;
  }

 private:
  int width_;
  std::string bytes_;
};

TEST(Canvas, IsWhiteWithTheLatestShapeOnTop) {
  Canvas canvas{20, 10};
  canvas.rectangle(5, 2, 10, 4, 0x123456);
  canvas.rectangle(10, 2, 10, 4, kEgo);
  canvas.add(Line{{{0, 9}, {20, 9}}, kHit, 2.0});
  const std::string png = canvas.png();
  EXPECT_THAT(png, StartsWith("\x89PNG\r\n\x1a\n"));
  const Pixels pixels(png, 20);
  EXPECT_EQ(pixels.rows(), 10);
  EXPECT_EQ(pixels.at(4, 3), kPaper);
  EXPECT_EQ(pixels.at(5, 3), 0x123456u);
  EXPECT_EQ(pixels.at(10, 3), kEgo);
  EXPECT_EQ(pixels.at(10, 6), kPaper);
  EXPECT_EQ(pixels.at(3, 8), kHit);
}

TEST(Canvas, ShowsNothingOfAnInsetBeyondItsEdges) {
  Canvas part{4, 4};
  part.rectangle(-10, -10, 100, 100, kEgo);
  Canvas canvas{20, 10};
  canvas.inset({6, 3}, part);
  const Pixels pixels(canvas.png(), 20);
  EXPECT_EQ(pixels.at(6, 3), kEgo);
  EXPECT_EQ(pixels.at(9, 6), kEgo);
  for (const auto& [x, y] : {std::pair{5, 4}, {10, 4}, {7, 2}, {7, 7}})
    EXPECT_EQ(pixels.at(x, y), kPaper) << x << " " << y;
}

TEST(Canvas, IsScaledAsAWhole) {
  Canvas canvas{10, 5};
  canvas.rectangle(2, 1, 1, 1, kEgo);
  const Pixels pixels(canvas.png(2.0), 20);
  EXPECT_EQ(pixels.rows(), 10);
  EXPECT_EQ(pixels.at(5, 3), kEgo);
  EXPECT_EQ(pixels.at(6, 3), kPaper);
}

// Letters are black only where they are: here above their line, and left of it once turned.
TEST(Canvas, WritesTextOnItsLineAndTurnsItToTheLeft) {
  const auto inked = [](const Canvas& canvas, int from_x, int to_x, int from_y, int to_y) {
    const Pixels pixels(canvas.png(), 100);
    for (int y = from_y; y < to_y; ++y) {
      for (int x = from_x; x < to_x; ++x)
        if (pixels.at(x, y) != kPaper) return true;
    }
    return false;
  };
  Canvas flat{100, 100};
  flat.add(Text{{50, 50}, 20, "HHH", Anchor::kEnd});
  EXPECT_TRUE(inked(flat, 0, 50, 30, 50));
  EXPECT_FALSE(inked(flat, 52, 100, 0, 100)) << "it ends there";
  EXPECT_FALSE(inked(flat, 0, 100, 52, 100));
  Canvas turned{100, 100};
  turned.add(Text{{50, 50}, 20, "HHH", Anchor::kStart, kInk, std::numbers::pi / 2});
  EXPECT_TRUE(inked(turned, 30, 50, 0, 50));
  EXPECT_FALSE(inked(turned, 52, 100, 0, 100));
}

TEST(Canvas, IsSvgWithTheSameShapes) {
  Canvas part{4, 4};
  part.add(Area{{{0, 0}, {1, 0.5}, {2, 0}}, kEgo});
  Canvas canvas{20, 10};
  canvas.inset({6, 3}, part);
  canvas.add(Line{{{0, 1}, {20, 1}}, kHit, 2.0, 6.0});
  canvas.add(Text{{3, 4}, 13, "a < b & \"c\"", Anchor::kMiddle, kInk, std::numbers::pi / 2});
  const std::string svg = canvas.svg();
  EXPECT_THAT(svg, StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"20\" "
                              "height=\"10\" viewBox=\"0 0 20 10\""));
  for (const char* text :
       {"<svg x=\"6\" y=\"3\" width=\"4\" height=\"4\" overflow=\"hidden\">\n"
        "<polygon points=\"0,0 1,0.5 2,0\" fill=\"#0059b5\"/>\n</svg>",
        "<polyline points=\"0,1 20,1\" fill=\"none\" stroke=\"#cc261f\" stroke-width=\"2\" "
        "stroke-dasharray=\"6\"/>",
        "text-anchor=\"middle\" transform=\"rotate(-90 3 4)\">a &lt; b &amp;"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
  EXPECT_EQ(canvas.svg(), svg);
  EXPECT_THAT(svg, Not(HasSubstr("id="))) << "one page holds several";
}

TEST(Canvas, ThatIsTooLargeIsRefused) {
  EXPECT_THAT(([] {
                Canvas{10, 40'000}.png();
              }),
              ThrowsMessage<Failure>(HasSubstr("10 x 40000 pixels")));
}

TEST(Palette, WritesAndMixesColours) {
  EXPECT_EQ(hexadecimal(0x0059b5), "#0059b5");
  EXPECT_EQ(mixed(0x000000, 0xff8040, 0.5), 0x804020u);
  EXPECT_EQ(mixed(kPaper, kEgo, 0.0), kPaper);
  EXPECT_EQ(mixed(kPaper, kEgo, 1.0), kEgo);
}

}  // namespace
}  // namespace corridor::cluster
