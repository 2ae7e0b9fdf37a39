// SPDX-License-Identifier: Apache-2.0
// Test problems of the optimiser benchmark. All objectives are minimised.
// ZDT: Zitzler, Deb, Thiele 2000. DTLZ2: Deb, Thiele, Laumanns, Zitzler 2002. ELLI, CIGTAB, IHR: Igel, Hansen, Roth
// 2007, table 2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "vantage/optimiser.hpp"

namespace vantage::bench {

struct MoProblem {
  std::string name;
  std::size_t dimension, objectives;
  Bounds bounds;
  std::function<void(std::span<const double> x, std::span<double> f)> evaluate;
  // Coordinates of stations in holes, which are to be drawn again; empty if the problem has none.
  std::function<std::vector<std::size_t>(std::span<const double> x)> misplaced = {};
  std::vector<std::vector<std::size_t>> blocks = {};                         // OptimiserConfig::blocks
  std::function<std::size_t(std::span<const double> x)> blocks_in_use = {};  // likewise
};

// Rotations, where the problem has any, are drawn from the seed. Throws std::invalid_argument for an unknown name.
// STATION: a stand-in for the planning of surveys, see the source.
MoProblem mo_problem(const std::string& name, std::size_t dimension, std::uint64_t seed);

// sphere, ellirot (1e6, rotated), rosen.
std::function<double(std::span<const double>)> so_problem(const std::string& name, std::size_t dimension,
                                                          std::uint64_t seed);

}  // namespace vantage::bench
