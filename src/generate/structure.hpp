// SPDX-License-Identifier: Apache-2.0
// Steelwork: frames, decks, railings, stairs, ladders, cable trays. Parts on the ground have no face there.
#pragma once

#include <vector>

#include "generate/shapes.hpp"

namespace vantage::built_in {

// A column of wide-flange section with its foot plate and bolts.
void add_column(Shaper& shaper, const dvec3& foot, double height, double width);
// A horizontal beam of wide-flange section whose top is at the height of `from` and `to`.
void add_beam(Shaper& shaper, const dvec3& from, const dvec3& to, double width, double depth);

// A deck over a rectangle at height z: a plate with edge beams, or bearing bars and cross rods if `grating` is set.
struct Deck {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0, z = 0;
  bool grating = false;
};
void add_deck(Shaper& shaper, const Deck& deck);

// A railing along a polyline: posts and two rails; a toe plate on level parts. A deck hides the posts' lower ends;
// `hanging` posts, beside a stringer, are closed there.
void add_railing(Shaper& shaper, const std::vector<dvec3>& path, bool hanging = false);

// Stairs from `foot` on the ground up to `top`: stringers, treads and railings on both sides.
void add_stairs(Shaper& shaper, Shaper& railing, const dvec3& foot, const dvec3& top, double width);

// A ladder at `foot` up to `height`, leaning against something in the direction −out; with a safety cage above 2.2 m.
void add_ladder(Shaper& shaper, const dvec3& foot, const dvec3& out, double height);

// A ladder-type cable tray with cables between two points on one axis.
void add_cable_tray(Shaper& tray, Shaper& cables, const dvec3& from, const dvec3& to, double width);

}  // namespace vantage::built_in
