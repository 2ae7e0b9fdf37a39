// SPDX-License-Identifier: Apache-2.0
// Stairs between two storeys, from the treads that their drawings show.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/openings.hpp"
#include "import/floor_plan/rooms.hpp"

namespace vantage::floor_plan {

// Lines of treads one after the other, `risers` of them. The first is at `foot`, which is the middle of its line; the
// last is at foot + along · length. It is not known which end is lower.
struct Flight {
  Point foot, along;  // a unit vector
  double length = 0, width = 0;
  std::size_t risers = 0;

  Point head() const { return foot + along * length; }
  Flight turned() const { return {head(), along * -1, length, width, risers}; }
};

// Returns the flights that a drawing shows on layers or in blocks of stairs.
std::vector<Flight> find_flights(const Drawing& drawing);

// Input of a storey for its stairs: all in metres of the drawing, around `origin`.
struct StairStorey {
  const Rooms* rooms = nullptr;
  const std::vector<Opening>* openings = nullptr;
  const std::vector<Flight>* flights = nullptr;
  const std::vector<Text>* texts = nullptr;
  Point origin;
};

// A step with its corners and the height of its face above the lower floor; or a landing.
struct Step {
  std::array<Point, 4> corners;  // counter-clockwise; the first two are the front, where people come from
  double low_m = 0, high_m = 0;
};

// A stair in metres of both drawings, without an origin.
struct Stair {
  std::vector<Step> steps;
  std::vector<std::array<Point, 4>> hole;  // in the slab between the storeys
  Point foot;
  double riser_m = 0;
  bool assumed = false;  // true: the lower end is a guess
};

struct StairsFound {
  std::vector<Stair> stairs;
  // Middles of drawn flights that belong to no stair, with the reason.
  std::vector<std::pair<Point, std::string>> left_out;
};

// Finds the stairs from one storey to the next, `rise_m` higher: one flight, or two side by side with a landing. Risers
// share the height as people climb it, and the ends meet floor in both storeys.
StairsFound find_stairs(const StairStorey& lower, const StairStorey& upper, double rise_m);

}  // namespace vantage::floor_plan
