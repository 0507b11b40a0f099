// SPDX-License-Identifier: Apache-2.0
// The colours of all pictures, each once, as 0xRRGGBB: canvas, gnuplot and the player take them
// from here. Pure.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "proto/base/format.h"

namespace corridor::cluster {

using Colour = std::uint32_t;

inline constexpr Colour kInk = 0x2d2d33, kFaint = 0x77777d, kGrid = 0xe4e4e4, kPaper = 0xffffff;
inline constexpr Colour kAsphalt = 0xededf0, kLine = 0xb8b8bf;
inline constexpr Colour kEgo = 0x0059b5, kOther = 0x858a94, kHit = 0xcc261f;
// Corridors that the MoP was shown as open, the one it chose, its trajectory.
inline constexpr Colour kOpen = 0xc1dbf1, kChosen = 0xf9c979, kPath = 0xdb5e00;
// Of Okabe and Ito (2008), which colour-blind readers can tell apart.
inline constexpr std::array<Colour, 6> kCurves = {0x0072b2, 0xd55e00, 0x009e73,
                                                  0xcc79a7, 0xe69f00, 0x56b4e9};

// "#rrggbb", as SVG, CSS and gnuplot take it.
inline std::string hexadecimal(Colour colour) { return fmt::format("#{:06x}", colour); }

// From `a` (share 0) to `b` (share 1).
inline Colour mixed(Colour a, Colour b, double share) {
  Colour colour = 0;
  for (const int shift : {0, 8, 16}) {
    const double part = std::lerp(a >> shift & 0xff, b >> shift & 0xff, share);
    colour |= static_cast<Colour>(std::lround(part)) << shift;
  }
  return colour;
}

}  // namespace corridor::cluster
