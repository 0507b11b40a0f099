// What all of gnuplot's scripts have in common. Pure.
#pragma once

#include <array>
#include <string>

namespace corridor::cluster {

enum class PictureFormat { kSvg, kPng };

// Of Okabe and Ito (2008), which colour-blind readers can tell apart; hexadecimal.
inline constexpr std::array kColours = {"0072b2", "d55e00", "009e73", "cc79a7", "e69f00", "56b4e9"};
inline constexpr const char* kInk = "333333";

// Text, as gnuplot takes it as it is: in single quotes, since in double ones it runs `commands`.
std::string literal(const std::string& text);

// Sets the terminal; `name` goes into SVG, width and height are in pixels. PNG is twice as large,
// for print.
std::string terminal_script(const std::string& name, int width, int height, PictureFormat format);

}  // namespace corridor::cluster
