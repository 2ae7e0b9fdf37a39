// SPDX-License-Identifier: Apache-2.0
// Small random problems for which everything can be tried.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/philox.hpp"
#include "vantage/cover.hpp"

namespace vantage::test {

using Chosen = std::vector<std::size_t>;

inline CoverageMatrix random_matrix(std::size_t candidates, std::size_t elements, std::uint64_t seed,
                                    double density = 0.3, std::uint32_t heaviest = 1) {
  RandomStream random(seed);
  std::vector<std::uint32_t> weights(elements);
  for (std::uint32_t& w : weights) w = 1 + static_cast<std::uint32_t>(random.uniform() * heaviest);
  CoverageMatrix made(weights, 10);
  std::vector<std::uint32_t> amounts(elements);
  for (std::size_t k = 0; k < candidates; ++k) {
    for (std::uint32_t& a : amounts)
      a = random.uniform() < density ? static_cast<std::uint32_t>(random.uniform() * 15) : 0;
    made.add(amounts);
  }
  return made;
}

// Each pair is linked, by an overlap of 1, with that probability.
inline StationGraph random_links(std::size_t size, std::uint64_t seed, double density) {
  RandomStream random(seed);
  StationGraph graph(size);
  for (std::size_t a = 0; a < size; ++a)
    for (std::size_t b = a + 1; b < size; ++b)
      if (random.uniform() < density) graph.set_overlap(a, b, 1);
  return graph;
}

// F(chosen) as vantage/cover.hpp defines it.
inline double coverage_by_definition(const CoverageMatrix& matrix, std::span<const std::size_t> chosen) {
  std::vector<double> amounts(matrix.elements());
  for (const std::size_t k : chosen)
    for (const CoverageMatrix::Entry& one : matrix.column(k)) amounts[one.element] += one.amount;
  double sum = 0, weights = 0;
  for (std::size_t e = 0; e < amounts.size(); ++e) {
    sum += matrix.weights()[e] * std::min(amounts[e] / matrix.goal(), 1.0);
    weights += matrix.weights()[e];
  }
  return sum / weights;
}

// True if links of at least `link` lead from the first to all others. It looks for neighbours in as many rounds as
// there are candidates.
inline bool connected_by_definition(const StationGraph& graph, std::span<const std::size_t> chosen, double link) {
  std::vector<bool> reached(chosen.size(), false);
  if (!chosen.empty()) reached[0] = true;
  for (std::size_t round = 0; round < chosen.size(); ++round)
    for (std::size_t i = 0; i < chosen.size(); ++i)
      for (std::size_t j = 0; j < chosen.size(); ++j)
        if (reached[i] && chosen[i] != chosen[j] && static_cast<double>(graph.overlap(chosen[i], chosen[j])) >= link)
          reached[j] = true;
  return std::ranges::all_of(reached, [](bool one) { return one; });
}

// Every set of `count` of so many candidates.
inline void each_choice(std::size_t candidates, std::size_t count, const std::function<void(const Chosen&)>& with) {
  std::vector<bool> in(candidates);
  std::fill(in.begin(), in.begin() + static_cast<std::ptrdiff_t>(count), true);
  do {
    Chosen chosen;
    for (std::size_t k = 0; k < candidates; ++k)
      if (in[k]) chosen.push_back(k);
    with(chosen);
  } while (std::prev_permutation(in.begin(), in.end()));
}

}  // namespace vantage::test
