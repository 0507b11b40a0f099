#include "cluster/pictures/gnuplot_script.h"

#include "proto/base/format.h"

namespace corridor::cluster {

std::string literal(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += c == '\n' ? ' ' : c;
  }
  return result + "'";
}

std::string terminal_script(const std::string& name, int width, int height, PictureFormat format) {
  if (format == PictureFormat::kSvg) {
    return fmt::format(
        "set terminal svg size {},{} dynamic name {} font 'Helvetica,Arial,sans-serif,13'\n", width,
        height, literal(name));
  }
  return fmt::format("set terminal pngcairo size {},{} font 'sans,10' fontscale 2 linewidth 2\n",
                     2 * width, 2 * height);
}

}  // namespace corridor::cluster
