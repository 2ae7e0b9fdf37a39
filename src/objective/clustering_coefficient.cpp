// SPDX-License-Identifier: Apache-2.0
// Clustering of weighted graphs (equation 13): Zhang, Horvath, A General Framework for Weighted Gene Co-Expression
// Network Analysis, 2005.

#include <algorithm>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "core/target_clones.hpp"
#include "vantage/measure.hpp"

namespace vantage {
namespace {

// Sums for one station over j < k: weights of its pairs of neighbours, and of linked pairs. Both sums of equation 13
// contain each pair twice.
struct LinkSums {
  double pairs = 0, triangles = 0;
  double share() const { return pairs > 0 ? triangles / pairs : 0; }
};

// `w`: n × n, symmetric.
LinkSums link_sums(const std::vector<double>& w, std::size_t n, std::size_t i) {
  const double* const wi = w.data() + i * n;
  LinkSums sums;
  for (std::size_t j = 0; j < n; ++j) {
    if (wi[j] == 0) continue;
    const double* const wj = w.data() + j * n;
    double any = 0, linked = 0;
    for (std::size_t k = j + 1; k < n; ++k) any += wi[k], linked += wi[k] * wj[k];
    sums.pairs += wi[j] * any;
    sums.triangles += wi[j] * linked;
  }
  return sums;
}

// Networks of more than kNarrow stations, larger than a search uses, sum kAtOnce stations at once, so that a row is
// read once for all of them, vectorised over k. 1024 stations have 178 million triples.
constexpr std::size_t kNarrow = 64, kAtOnce = 8;

// linked[b][k] = Σ_j<k w_ij w_jk for stations i = first + b.
VANTAGE_TARGET_CLONES
void add_links(const double* w, std::size_t n, std::size_t first, std::size_t stations, double* linked) {
  for (std::size_t j = 0; j + 1 < n; ++j) {
    const double* const wj = w + j * n;
    for (std::size_t b = 0; b < stations; ++b) {
      const double wij = w[(first + b) * n + j];
      if (wij == 0) continue;
      double* const sum = linked + b * n;
      for (std::size_t k = j + 1; k < n; ++k) sum[k] += wij * wj[k];
    }
  }
}

void link_sums_at_once(const std::vector<double>& w, std::size_t n, std::size_t first, std::span<LinkSums> sums) {
  std::vector<double> linked(sums.size() * n, 0.0);
  add_links(w.data(), n, first, sums.size(), linked.data());
  for (std::size_t b = 0; b < sums.size(); ++b) {
    const double* const wi = w.data() + (first + b) * n;
    double before = 0;
    for (std::size_t k = 0; k < n; ++k) {
      sums[b].pairs += wi[k] * before;
      sums[b].triangles += wi[k] * linked[b * n + k];
      before += wi[k];
    }
  }
}

}  // namespace

double clustering_coefficient(const OverlapMatrix& overlap) {
  const std::size_t n = overlap.size();
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (const double value : overlap.row(i)) largest = std::max(largest, value);
  }
  if (largest == 0) return 0;

  // With weights w = Overlap / max, the quotient includes the factor 1/max of equation 13, and no sum exceeds the range
  // of doubles.
  std::vector<double> w(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) w[i * n + j] = overlap(i, j) / largest;
  }
  double sum = 0;
  if (n <= kNarrow) {
    for (std::size_t i = 0; i < n; ++i) sum += link_sums(w, n, i).share();
  } else {
    std::vector<LinkSums> sums(n);
    parallel::for_all(std::size_t{0}, (n + kAtOnce - 1) / kAtOnce, [&](std::size_t block) {
      const std::size_t first = block * kAtOnce, stations = std::min(kAtOnce, n - first);
      link_sums_at_once(w, n, first, std::span(sums).subspan(first, stations));
    });
    for (const LinkSums& of : sums) sum += of.share();
  }
  return sum / static_cast<double>(n);
}

}  // namespace vantage
