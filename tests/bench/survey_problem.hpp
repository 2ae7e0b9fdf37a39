// SPDX-License-Identifier: Apache-2.0
// Survey planning on prisms seen from outside, without rays: a stand-in that has what makes planning hard (holes,
// stations that see one side or another but nothing in between, networks that are the same whatever the stations'
// order) at 10 µs a network.
#pragma once

#include "optimiser_problems.hpp"

namespace vantage::bench {

// `name`: WALLS, the paper's four walls, or YARD, nine boxes of several heights. Coordinates are u, v of each of n/2
// stations; the objectives are 1 - coverage and 1 - overlap as equations 8 and 13 have them, over 600 patches of wall.
MoProblem survey_problem(const std::string& name, std::size_t n);
// The first of these objectives alone.
MoProblem coverage_problem(const std::string& name, std::size_t n);
// 1 - the scalarised fitness of 4 to 12 stations before WALLS: u, v of each, then the coordinate of their number.
MoProblem fitness_problem();

}  // namespace vantage::bench
