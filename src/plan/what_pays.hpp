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

// Least new surface of a station in a part of the floor (floor_units.hpp), as a share of what any station must add.
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

// Least new surface of a further station: in m², and as a share of the average of the stations before it. If those are
// fewer than ten, a tenth of their total stands for the average.
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

// Further stations that a greedy choice adds, a fifth of `stations` and at least one: the candidates, and their new
// surface on average. They are linked if the problem asks for links. REQUIRES: even weights.
struct FurtherStations {
  std::vector<std::size_t> candidates = {};
  double each_m2 = 0;
};
FurtherStations further_stations(CoverProblem even, std::size_t stations, double element_m2);

// Area of all surveyed meshes, in square metres.
double surveyed_area_m2(const Scene& scene);

}  // namespace vantage
