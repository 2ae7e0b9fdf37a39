// SPDX-License-Identifier: Apache-2.0
// The number of stations that pay: a further one would capture less new surface than it has to.
#pragma once

#include <cstddef>

#include "vantage/cover.hpp"
#include "vantage/planner.hpp"
#include "vantage/scene.hpp"

namespace vantage {

// Follows a greedy choice of `problem.most` further stations at most. After n of them the next n/5 are looked at
// together, at least one: a single step of a greedy choice may be small by chance. `weighted`: the matrix of the
// capture that is asked for; `problem.matrix` has the same candidates and a weight of 1 for each element.
// `element_m2`: surface of an element.
StationsThatPay stations_that_pay(const CoverProblem& problem, const CoverageMatrix& weighted, double element_m2,
                                  double least_m2);

// Area of all surveyed meshes, in square metres.
double surveyed_area_m2(const Scene& scene);

}  // namespace vantage
