// SPDX-License-Identifier: Apache-2.0
// The search space of section 4.4: decision vectors and their networks.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "site/placement_oracle.hpp"
#include "vantage/optimiser.hpp"
#include "vantage/problem.hpp"

namespace vantage {

class DecisionSpace {
 public:
  // Throws Error invalid_argument.
  DecisionSpace(const PlacementOracle& oracle, const SurveyProblem& problem);

  std::size_t dimension() const;
  bool searches_number() const { return min_ < max_; }
  Bounds bounds() const;

  // Equation 7: number of stations of x to search, without existing ones.
  std::size_t placed_count(std::span<const double> x) const;
  // Existing stations first, then those of x.
  std::vector<PlacedStation> decode(std::span<const double> x) const;
  // Coordinates of x that belong to station `i` of decode(x), which is not an existing one.
  std::vector<std::size_t> coordinates(std::size_t i) const;
  // The coordinates of each station of x; stations are interchangeable.
  std::vector<std::vector<std::size_t>> blocks() const;
  std::size_t existing() const { return existing_.size(); }
  // x with stations at `heads`, repeated if x has more. Throws if a head is outside the search area.
  std::vector<double> encode(std::span<const Vec3> heads) const;
  // x of these stations, by their (u, v). REQUIRES: at least one, at most the largest searched number.
  std::vector<double> encode(std::span<const PlacedStation> stations) const;
  // An x for each number of stations up to that of `heads`, the largest number first.
  std::vector<std::vector<double>> encode_each(std::span<const Vec3> heads) const;

 private:
  double height(std::span<const double> x, std::size_t i) const;
  bool searches_scanner() const { return scanners_.size() > 1; }
  std::size_t first_scanner() const { return max_ * (heights_ ? 3 : 2); }  // coordinate
  std::uint32_t scanner(std::span<const double> x, std::size_t i) const;
  double encoded(std::uint32_t scanner) const;  // the middle of its range
  const PlacementOracle& oracle_;
  std::size_t min_, max_;
  bool heights_;
  std::vector<std::uint32_t> scanners_;
  std::array<double, 2> height_bounds_{};
  std::vector<PlacedStation> existing_;
};

}  // namespace vantage
