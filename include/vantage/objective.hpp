// SPDX-License-Identifier: Apache-2.0
/// The objectives of section 4.5: coverage (equation 8), overlap (equations 11 and 13), number of stations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vantage {

/// What a simulated network left in the surveyed voxels, reduced to integers. Exact, so independent of engine, order
/// and chunking.
struct NetworkCounts {
  std::uint64_t voxels = 0;  ///< N_v, or the size of the sample.
  /// Sum of the voxels' weights (`MeshInfo::weight`): `voxels` where all surveyed meshes weigh the same.
  std::uint64_t weight = 0;
  std::uint64_t saturated = 0;        ///< Weight of the voxels that reached the goal density.
  std::uint64_t partial_points = 0;   ///< Points in all other voxels together, each times its voxel's weight.
  std::uint64_t rays = 0;             ///< Rays that were traced.
  std::uint32_t stations = 0;         ///< N_stations, skipped ones included.
  std::vector<std::uint64_t> points;  ///< Per station, all meshes; empty where not counted (rays were skipped).
  std::vector<std::uint64_t> points_on_surveyed;  ///< Per station, those that count.
  std::vector<std::uint64_t> seen;                ///< Per station: voxels with a point of it. Empty without overlap.
  /// Voxels seen by both i and j, i < j, in the order (0,1), (0,2), …, (1,2), …; empty without overlap.
  std::vector<std::uint64_t> shared;
  /// The same counts for each of G interleaved groups of a sample, for standard errors; empty when exact.
  std::vector<NetworkCounts> groups;
  /// Sum over successive sampled voxels of the squared difference of min(count/goal, 1); for the standard error of
  /// coverage.
  double successive_difference_sum = 0;
  double trace_seconds = 0;
  bool cancelled = false;

  std::uint64_t shared_by(std::size_t i, std::size_t j) const;  ///< REQUIRES: i != j, both < stations.
};

/// Symmetric matrix of Overlap_ij (equation 11), zero on the diagonal.
class OverlapMatrix {
 public:
  OverlapMatrix() = default;
  explicit OverlapMatrix(std::size_t n) : n_(n), values_(n * n, 0.0) {}
  std::size_t size() const noexcept { return n_; }
  double operator()(std::size_t i, std::size_t j) const { return values_[i * n_ + j]; }
  void set(std::size_t i, std::size_t j, double value) { values_[i * n_ + j] = values_[j * n_ + i] = value; }
  std::span<const double> row(std::size_t i) const { return {values_.data() + i * n_, n_}; }

 private:
  std::size_t n_ = 0;
  std::vector<double> values_;
};

/// Equation 8, in [0, 1]; where meshes have weights, the mean over voxels is weighted by them. 0 for a scene without
/// surveyed voxels. REQUIRES: goal_density > 0.
double coverage(const NetworkCounts& counts, double goal_density);
/// Equation 11 for every pair; 0/0 is 0.
OverlapMatrix overlap_matrix(const NetworkCounts& counts);
/// Equation 13: average weighted clustering coefficient, in [0, 1]; the maximum is over all pairs. 0/0 is 0, so
/// networks of one or two stations, or without a shared voxel, have 0.
double clustering_coefficient(const OverlapMatrix& overlap);

/// An estimate and its standard error. The error is 0 when all of the population was counted, and 0.5, the largest that
/// a value in [0, 1] can have, where the sample is too small to tell (one voxel).
struct Estimate {
  double value = 0, standard_error = 0;
};
/// Equation 8 from a sample of `population` voxels. Error by successive differences along the Morton order, which a
/// systematic sample needs: s/√n would be too wide. With weights a ratio is estimated, with the jackknife's error over
/// the interleaved groups.
Estimate coverage_estimate(const NetworkCounts& counts, double goal_density, std::uint64_t population);
/// Equation 13 from a sample. Error by the jackknife over the interleaved groups.
Estimate overlap_estimate(const NetworkCounts& counts, std::uint64_t population);
/// Standard errors of `overlap_matrix`, likewise by the jackknife.
OverlapMatrix overlap_standard_errors(const NetworkCounts& counts, std::uint64_t population);

/// Equation 7: rounded(N_min + α (N_max − N_min)), half up, α clamped to [0, 1].
std::size_t station_count_from_alpha(double alpha, std::size_t n_min, std::size_t n_max);

}  // namespace vantage
