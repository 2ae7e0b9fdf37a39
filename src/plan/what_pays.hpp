// SPDX-License-Identifier: Apache-2.0
// The number of stations that pay: a further one would capture less new surface than it has to.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cover/partial_cover.hpp"
#include "vantage/cover.hpp"
#include "vantage/planner.hpp"
#include "vantage/scene.hpp"

namespace vantage {

// A part of the floor (floor_units.hpp) takes a station if that captures so much of what one has to.
inline constexpr double kLeastOfUnit = 0.2;

// Surface that a candidate captures and a network does not, in square metres of all surfaces alike, whatever their
// voxels weigh. `element_m2`: the surface that an element of the sample stands for.
double new_surface_m2(const CoverageMatrix& matrix, const PartialCover& network, std::size_t candidate,
                      double element_m2);

// Surface that a network captures, likewise.
double surface_m2(const CoverageMatrix& matrix, std::span<const std::size_t> network, double element_m2);

// For each unit of floor without one of the chosen candidates, the allowed one in it that captures most new surface, if
// that is as much as `least_m2`; each counts for the next ones. `units`: candidates in each.
std::vector<std::size_t> for_empty_units(const CoverageMatrix& matrix, const StationGraph* graph,
                                         std::span<const std::size_t> chosen,
                                         std::span<const std::vector<std::size_t>> units, double element_m2,
                                         double least_m2);

// What a further station has to capture: so many m², and such a share of what the stations before it capture on
// average, or of a tenth of all that they do if these are fewer than ten.
struct LeastGain {
  double m2 = 0, share = 0;
};

// Follows a greedy choice of `problem.most` further stations at most, and takes `problem.fewest` at least where that is
// more than one. After n of them the next n/5 are looked at together, at least one: a single step of a greedy choice
// may be small by chance. `units`: candidates in each part of the floor that is to have a station. `element_m2`:
// surface of an element.
StationsThatPay stations_that_pay(const CoverProblem& problem, double element_m2, const LeastGain& least,
                                  std::span<const std::vector<std::size_t>> units = {});

// The same columns and goals without weights: square metres are those of all surfaces alike, whatever their voxels
// weigh.
CoverageMatrix with_even_weights(const CoverageMatrix& matrix);

// What further stations add to those that exist, a fifth of `stations` together and at least one: new surface of each
// on average, and the candidates. They are linked where the problem asks for links. REQUIRES: even weights.
struct FurtherStations {
  std::vector<std::size_t> candidates = {};
  double each_m2 = 0;
};
FurtherStations further_stations(CoverProblem even, std::size_t stations, double element_m2);

// Area of all surveyed meshes, in square metres.
double surveyed_area_m2(const Scene& scene);

}  // namespace vantage
