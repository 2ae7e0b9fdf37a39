// SPDX-License-Identifier: Apache-2.0
// Recombination and mutation of real vectors inside a box, in unit coordinates.
#pragma once

#include <span>
#include <vector>

#include "optimise/normal_stream.hpp"

namespace vantage::optimise {

struct VariationConfig {
  double crossover_probability = 0.9;  // per pair
  double crossover_index = 15;         // η of simulated binary crossover: larger values stay nearer to the parents
  double mutation_index = 20;          // η of polynomial mutation
};

// One child of two parents by bounded simulated binary crossover (Deb, Agrawal 1995; bounds as in Deb's NSGA-II), then
// polynomial mutation with probability 1/n per coordinate (Deb, Goyal 1996). All values in [0, 1].
std::vector<double> make_child(std::span<const double> first, std::span<const double> second,
                               const VariationConfig& config, NormalStream& random);

// Polynomial mutation of one coordinate.
double mutate(double t, double index, NormalStream& random);

}  // namespace vantage::optimise
