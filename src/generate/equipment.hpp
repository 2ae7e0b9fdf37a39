// SPDX-License-Identifier: Apache-2.0
// Vessels and machines of the industrial site. Closed shells, without triangles inside.
#pragma once

#include "generate/shapes.hpp"

namespace vantage::built_in {

// An upright vessel with dished heads on four legs. The shell runs from `shell_low` to `shell_high` above the foot.
struct UprightVessel {
  dvec3 foot{};
  double radius = 1, shell_low = 1, shell_high = 3;
  bool manhole = true;    // facing east
  bool agitator = false;  // a motor on top
};
void add_upright_vessel(Shaper& shell, Shaper& legs, const UprightVessel& vessel);

// A horizontal vessel along x on two saddles with plinths.
struct LyingVessel {
  dvec3 centre{};
  double radius = 0.9, shell_length = 3.8;
};
void add_lying_vessel(Shaper& shell, Shaper& saddles, const LyingVessel& vessel);

// A shell-and-tube exchanger along x between x0 and x1; its channel at the x1 end. `support_from` is the height on
// which its saddles stand.
void add_exchanger(Shaper& shell, Shaper& saddles, const dvec3& centre, double length, double radius,
                   double support_from);

// A pump with its motor on a base; suction to the south at `suction`, discharge straight up above it.
void add_pump(Shaper& pump, Shaper& motor, Shaper& base, const dvec3& suction, double discharge_height);

// A cabinet with a door frame and a plinth.
void add_cabinet(Shaper& shaper, const dvec3& low, const dvec3& high);

}  // namespace vantage::built_in
