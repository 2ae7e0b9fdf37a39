// SPDX-License-Identifier: Apache-2.0
// Coverage and overlap of section 4.5 from exact integer counts. Clustering of weighted graphs as in equation 13:
// Zhang, Horvath, A General Framework for Weighted Gene Co-Expression Network Analysis, 2005.
#include "vantage/measure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace vantage {

double coverage(const NetworkCounts& counts, double goal_density) {
  if (counts.weight == 0) return 0;
  const double filled =
      static_cast<double>(counts.saturated) + static_cast<double>(counts.partial_points) / goal_density;
  return std::min(filled / static_cast<double>(counts.weight), 1.0);  // rounding may pass 1 in the last place
}

OverlapMatrix overlap_matrix(const NetworkCounts& counts) {
  OverlapMatrix overlap(counts.stations);
  if (counts.seen.empty()) return overlap;
  for (std::size_t i = 0; i < counts.stations; ++i) {
    for (std::size_t j = i + 1; j < counts.stations; ++j) {
      const std::uint64_t both = counts.shared_by(i, j);
      const std::uint64_t either = counts.seen[i] + counts.seen[j] - both;
      if (both > 0) overlap.set(i, j, static_cast<double>(both) / static_cast<double>(either));
    }
  }
  return overlap;
}

OverlapMatrix scan_overlap_matrix(const NetworkCounts& counts) {
  OverlapMatrix overlap(counts.stations);
  if (counts.seen.empty()) return overlap;
  for (std::size_t i = 0; i < counts.stations; ++i)
    for (std::size_t j = i + 1; j < counts.stations; ++j)
      if (const std::uint64_t both = counts.shared_by(i, j))
        overlap.set(i, j, static_cast<double>(both) / static_cast<double>(std::min(counts.seen[i], counts.seen[j])));
  return overlap;
}

namespace {

// Larger networks than the objectives of a search have. Their sums are taken in lanes, which is several times as fast.
constexpr std::size_t kNarrow = 64;

struct LinkSums {
  double any = 0, linked = 0;
};
// Σ a_k and Σ a_k b_k over first <= k < last.
template <std::size_t lanes>
LinkSums sums(const double* a, const double* b, std::size_t first, std::size_t last) {
  std::array<LinkSums, lanes> lane;
  std::size_t k = first;
  for (; k + lanes <= last; k += lanes)
    for (std::size_t l = 0; l < lanes; ++l) lane[l].any += a[k + l], lane[l].linked += a[k + l] * b[k + l];
  LinkSums all;
  for (; k < last; ++k) all.any += a[k], all.linked += a[k] * b[k];
  for (const LinkSums& one : lane) all.any += one.any, all.linked += one.linked;
  return all;
}

}  // namespace

double clustering_coefficient(const OverlapMatrix& overlap) {
  const std::size_t n = overlap.size();
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (const double value : overlap.row(i)) largest = std::max(largest, value);
  }
  if (largest == 0) return 0;

  // With weights w = Overlap / max the factor 1/max of equation 13 is already in the quotient, and no sum can leave the
  // range of doubles.
  std::vector<double> w(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) w[i * n + j] = overlap(i, j) / largest;
  }
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double* wi = w.data() + i * n;
    double triangles = 0, pairs = 0;  // over j < k: both sums of equation 13 hold each pair twice
    for (std::size_t j = 0; j < n; ++j) {
      if (wi[j] == 0) continue;
      const double* wj = w.data() + j * n;
      const auto [any, linked] = n > kNarrow ? sums<8>(wi, wj, j + 1, n) : sums<1>(wi, wj, j + 1, n);
      pairs += wi[j] * any;
      triangles += wi[j] * linked;
    }
    if (pairs > 0) sum += triangles / pairs;
  }
  return sum / static_cast<double>(n);
}

}  // namespace vantage
