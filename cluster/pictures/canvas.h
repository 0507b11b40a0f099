// SPDX-License-Identifier: Apache-2.0
// A drawing surface in pixels, x to the right and y down. What is drawn is kept as values, which
// are written as PNG or SVG. The adapter of cairo.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "cluster/pictures/palette.h"

namespace corridor::cluster {

struct Point {
  double x = 0.0;
  double y = 0.0;
};

struct Area {
  std::vector<Point> corners;
  Colour colour = kInk;
};

struct Line {
  std::vector<Point> points;
  Colour colour = kInk;
  double width = 1.0;
  double dash = 0.0;  // length of dashes and of what is between them; 0 for none
};

enum class Anchor { kStart, kMiddle, kEnd };
struct Text {
  Point at;  // of the anchor, on the line that the letters stand on
  double size = 13.0;
  std::string text;
  Anchor anchor = Anchor::kStart;
  Colour colour = kInk;
  double turn_rad = 0.0;  // about `at`, > 0 to the left
};

// A canvas within another, of which nothing shows beyond its edges.
struct Inset {
  Point at;  // its upper left corner
  double width = 0.0;
  double height = 0.0;
  std::vector<struct Shape> shapes;
};

struct Shape {
  std::variant<Area, Line, Text, Inset> what;
};

// White where nothing is drawn; later shapes hide earlier ones.
struct Canvas {
  double width = 0.0;
  double height = 0.0;
  std::vector<Shape> shapes = {};

  template <typename What>
  void add(What what) {
    shapes.push_back({std::move(what)});
  }
  void rectangle(double left, double top, double width, double height, Colour colour);
  void inset(Point at, const Canvas& canvas);

  // The file's content; `scale`: pixels of it for one of the canvas. Throws Failure when there are
  // more than cairo can draw (32767 a side).
  std::string png(double scale = 1.0) const;
  // Equal canvases give equal text.
  std::string svg() const;
};

}  // namespace corridor::cluster
