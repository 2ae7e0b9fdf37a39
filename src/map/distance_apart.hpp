// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace vantage {

// Returns a distance in plan that all points keep from their nearest neighbours, except one in `but_one_in`; infinity
// for fewer than two points.
template <class Point>
double distance_apart(const std::vector<Point>& spots, std::size_t but_one_in) {
  std::vector<double> apart;
  for (std::size_t i = 0; i < spots.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < spots.size(); ++j)
      if (j != i) least = std::min(least, std::hypot(spots[i].x - spots[j].x, spots[i].y - spots[j].y));
    apart.push_back(least);
  }
  if (apart.empty()) return std::numeric_limits<double>::infinity();
  const auto at = apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / but_one_in);
  std::nth_element(apart.begin(), at, apart.end());
  return *at;
}

}  // namespace vantage
