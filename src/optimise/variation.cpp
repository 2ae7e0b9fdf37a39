// SPDX-License-Identifier: Apache-2.0
#include "optimise/variation.hpp"

#include <algorithm>
#include <cmath>

namespace vantage::optimise {
namespace {

constexpr double kEqual = 1e-14;  // parents nearer than this along a coordinate leave nothing to recombine

// Spread factor of simulated binary crossover; the child cannot pass a bound `room` (in units of the parents' distance)
// away.
double spread(double room, double index, double u) {
  const double alpha = 2 - std::pow(1 + 2 * room, -(index + 1));
  return u <= 1 / alpha ? std::pow(u * alpha, 1 / (index + 1)) : std::pow(1 / (2 - u * alpha), 1 / (index + 1));
}

}  // namespace

double mutate(double t, double index, NormalStream& random) {
  const double u = random.uniform(), power = 1 / (index + 1);
  const double step = u < 0.5 ? std::pow(2 * u + (1 - 2 * u) * std::pow(1 - t, index + 1), power) - 1
                              : 1 - std::pow(2 * (1 - u) + (2 * u - 1) * std::pow(t, index + 1), power);
  return std::clamp(t + step, 0.0, 1.0);
}

std::vector<double> make_child(std::span<const double> first, std::span<const double> second,
                               const VariationConfig& config, NormalStream& random) {
  std::vector<double> child(first.begin(), first.end());
  const bool cross = random.uniform() < config.crossover_probability;
  for (std::size_t i = 0; i < child.size(); ++i) {
    if (cross && random.uniform() < 0.5) {
      const double low = std::min(first[i], second[i]), high = std::max(first[i], second[i]), distance = high - low;
      const bool towards_low = random.uniform() < 0.5;
      const double u = random.uniform();
      if (distance > kEqual) {
        const double beta = spread((towards_low ? low : 1 - high) / distance, config.crossover_index, u);
        const double half = 0.5 * beta * distance, middle = 0.5 * (low + high);
        child[i] = std::clamp(towards_low ? middle - half : middle + half, 0.0, 1.0);
      } else {
        child[i] = towards_low ? low : high;
      }
    }
    if (random.uniform() * static_cast<double>(child.size()) < 1)
      child[i] = mutate(child[i], config.mutation_index, random);
  }
  return child;
}

}  // namespace vantage::optimise
