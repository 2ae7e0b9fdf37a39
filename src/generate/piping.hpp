// SPDX-License-Identifier: Apache-2.0
// Pipes with bends, flanges, bolts and valves.
#pragma once

#include <vector>

#include "generate/shapes.hpp"

namespace vantage::built_in {

// A ring of bolt heads on a flange face at `frame`, whose z points out of the face. Omitted if the detail is too
// coarse.
void add_bolts(Shaper& shaper, const Frame& frame, double circle_radius, double bolt_radius, int count);

// A flanged joint around a pipe: its extent and its bolts.
struct Flange {
  double radius = 0, half_thickness = 0, bolt_circle = 0, bolt_radius = 0;
  int bolts = 4;
};
Flange flange_for(double pipe_radius);

// A valve in a pipe: straight run of the route, and position along it.
struct Valve {
  std::size_t run = 0;
  double share = 0.5;
};

struct PipeOptions {
  bool flange_at_start = true, flange_at_end = true;
  double flange_every_m = 2.4;                  // along straight runs; 0: none
  bool blind_start = false, blind_end = false;  // closed by a disc, else open: the end lies in a vessel or another pipe
  std::vector<Valve> valves = {};
};

// A pipe through the points of a route, with bends of three pipe radii, or as much as fits. Pipe and flanges are one
// closed surface, with nothing inside.
void add_pipe(Shaper& shaper, const std::vector<dvec3>& route, double radius, const PipeOptions& options = {});

// A short branch with a flange and a blind disc on a vessel: `frame` lies in the vessel's surface, its z points
// outward. `bury` is how far the branch reaches into it, so that no gap shows on a curved surface.
void add_nozzle(Shaper& shaper, const Frame& frame, double radius, double length, double bury);

}  // namespace vantage::built_in
