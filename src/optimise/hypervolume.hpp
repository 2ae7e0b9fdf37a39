// SPDX-License-Identifier: Apache-2.0
// Hypervolume, contributions, truncation and ranks of point sets stored row-major. All objectives are minimised.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vantage::optimise {

// k points of m objectives each.
struct PointSet {
  std::span<const double> values;
  std::size_t objectives;

  std::size_t size() const { return values.size() / objectives; }
  std::span<const double> operator[](std::size_t i) const { return values.subspan(i * objectives, objectives); }
};

// True if a is nowhere worse than b and somewhere better.
bool dominates(std::span<const double> a, std::span<const double> b);
// True if the point is strictly better than the reference in every objective, so that it spans a volume.
bool inside(std::span<const double> point, std::span<const double> reference);

double volume(const PointSet& points, std::span<const double> reference);
// Volume that each point alone dominates. Dominated points and duplicates have 0, and reduce those that dominate them.
std::vector<double> contributions(const PointSet& points, std::span<const double> reference);
// Removes `count` points one by one, each time the least contributor among the rest (the later one of equals). Returns
// them in order of removal.
std::vector<std::size_t> least_contributors(const PointSet& points, std::span<const double> reference,
                                            std::size_t count);

std::vector<std::size_t> ranks(const PointSet& points);

}  // namespace vantage::optimise
