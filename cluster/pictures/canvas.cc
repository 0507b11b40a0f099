// SPDX-License-Identifier: Apache-2.0
#include "cluster/pictures/canvas.h"

#include <cairo.h>

#include <memory>
#include <numbers>

#include "cluster/results/table.h"
#include "proto/base/failure.h"

namespace corridor::cluster {
namespace {

constexpr const char* kFont = "sans-serif";

// Draws by cairo.
struct Painter {
  cairo_t* cairo;

  void all(const std::vector<Shape>& shapes) const {
    for (const Shape& shape : shapes) std::visit(*this, shape.what);
  }

  void colour(Colour colour) const {
    cairo_set_source_rgb(cairo, (colour >> 16 & 0xff) / 255.0, (colour >> 8 & 0xff) / 255.0,
                         (colour & 0xff) / 255.0);
  }
  void path(const std::vector<Point>& points) const {
    cairo_new_path(cairo);
    for (const auto& [x, y] : points) cairo_line_to(cairo, x, y);
  }

  void operator()(const Area& area) const {
    colour(area.colour);
    path(area.corners);
    cairo_fill(cairo);
  }
  void operator()(const Line& line) const {
    colour(line.colour);
    cairo_set_line_width(cairo, line.width);
    cairo_set_dash(cairo, &line.dash, line.dash > 0.0 ? 1 : 0, 0.0);
    path(line.points);
    cairo_stroke(cairo);
  }
  void operator()(const Text& text) const {
    colour(text.colour);
    cairo_set_font_size(cairo, text.size);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo, text.text.c_str(), &extents);
    const double before[] = {0.0, 0.5 * extents.x_advance, extents.x_advance};
    cairo_save(cairo);
    cairo_translate(cairo, text.at.x, text.at.y);
    cairo_rotate(cairo, -text.turn_rad);
    cairo_move_to(cairo, -before[static_cast<int>(text.anchor)], 0.0);
    cairo_show_text(cairo, text.text.c_str());
    cairo_restore(cairo);
  }
  void operator()(const Inset& inset) const {
    cairo_save(cairo);
    cairo_translate(cairo, inset.at.x, inset.at.y);
    cairo_rectangle(cairo, 0.0, 0.0, inset.width, inset.height);
    cairo_clip(cairo);
    all(inset.shapes);
    cairo_restore(cairo);
  }
};

std::string svg_points(const std::vector<Point>& points) {
  std::string text;
  for (const auto& [x, y] : points)
    text += fmt::format("{}{:.6g},{:.6g}", text.empty() ? "" : " ", x, y);
  return text;
}

// Draws as elements of SVG.
struct SvgWriter {
  std::string& svg;

  void all(const std::vector<Shape>& shapes) const {
    for (const Shape& shape : shapes) std::visit(*this, shape.what);
  }

  void operator()(const Area& area) const {
    svg += fmt::format("<polygon points=\"{}\" fill=\"{}\"/>\n", svg_points(area.corners),
                       hexadecimal(area.colour));
  }
  void operator()(const Line& line) const {
    svg += fmt::format(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:.6g}\"{}/>\n",
        svg_points(line.points), hexadecimal(line.colour), line.width,
        line.dash > 0.0 ? fmt::format(" stroke-dasharray=\"{:.6g}\"", line.dash) : "");
  }
  void operator()(const Text& text) const {
    constexpr const char* kAnchors[] = {"start", "middle", "end"};
    const double turn_deg = -text.turn_rad * 180.0 / std::numbers::pi;
    svg += fmt::format(
        "<text x=\"{0:.6g}\" y=\"{1:.6g}\" font-size=\"{2:.6g}\" fill=\"{3}\" "
        "text-anchor=\"{4}\"{5}>{6}</text>\n",
        text.at.x, text.at.y, text.size, hexadecimal(text.colour),
        kAnchors[static_cast<int>(text.anchor)],
        text.turn_rad == 0.0 ? ""
                             : fmt::format(" transform=\"rotate({:.6g} {:.6g} {:.6g})\"", turn_deg,
                                           text.at.x, text.at.y),
        html_escaped(text.text));
  }
  void operator()(const Inset& inset) const {
    svg += fmt::format(
        "<svg x=\"{:.6g}\" y=\"{:.6g}\" width=\"{:.6g}\" height=\"{:.6g}\" overflow=\"hidden\">\n",
        inset.at.x, inset.at.y, inset.width, inset.height);
    all(inset.shapes);
    svg += "</svg>\n";
  }
};

}  // namespace

void Canvas::rectangle(double left, double top, double across, double down, Colour colour) {
  add(Area{{{left, top}, {left + across, top}, {left + across, top + down}, {left, top + down}},
           colour});
}

void Canvas::inset(Point at, const Canvas& canvas) {
  add(Inset{at, canvas.width, canvas.height, canvas.shapes});
}

std::string Canvas::png(double scale) const {
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(scale * width),
                                 static_cast<int>(scale * height)),
      cairo_surface_destroy);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> cairo(cairo_create(surface.get()),
                                                                 cairo_destroy);
  const Painter painter{cairo.get()};
  painter.colour(kPaper);
  cairo_paint(cairo.get());
  cairo_scale(cairo.get(), scale, scale);
  cairo_select_font_face(cairo.get(), kFont, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_line_join(cairo.get(), CAIRO_LINE_JOIN_ROUND);
  painter.all(shapes);
  std::string content;
  const cairo_status_t status = cairo_surface_write_to_png_stream(
      surface.get(),
      [](void* written, const unsigned char* data, unsigned int length) {
        static_cast<std::string*>(written)->append(reinterpret_cast<const char*>(data), length);
        return CAIRO_STATUS_SUCCESS;
      },
      &content);
  if (status != CAIRO_STATUS_SUCCESS) {
    throw Failure("cannot draw {:g} x {:g} pixels: {}", scale * width, scale * height,
                  cairo_status_to_string(status));
  }
  return content;
}

std::string Canvas::svg() const {
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.6g}\" height=\"{1:.6g}\" "
      "viewBox=\"0 0 {0:.6g} {1:.6g}\" font-family=\"{2}\" stroke-linejoin=\"round\">\n<rect "
      "width=\"100%\" height=\"100%\" "
      "fill=\"{3}\"/>\n",
      width, height, kFont, hexadecimal(kPaper));
  SvgWriter{text}.all(shapes);
  return text + "</svg>\n";
}

}  // namespace corridor::cluster
