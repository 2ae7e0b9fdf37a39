// SPDX-License-Identifier: Apache-2.0
/// Measures of a network from its counts: coverage (equation 8), overlap (equations 11 and 13), their standard errors,
/// and how stations hang together.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vantage/settings.hpp"
#include "vantage/simulator.hpp"
#include "vantage/trace.hpp"

namespace vantage {

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
/// Scan overlap of every pair: what two scans share, of the smaller one, |i and j| / min(|i|, |j|); 0/0 is 0. How
/// practice states the overlap that registration takes. Not equation 11, which is shared over either.
OverlapMatrix scan_overlap_matrix(const NetworkCounts& counts);
/// From which scan overlap on two stations count as linked, unless asked otherwise: what practice wants.
inline constexpr double default_link = 0.3;
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
/// Equation 13 from a sample, less its bias: what half of the sample gives more than all of it. The error is the
/// jackknife's over the interleaved groups and that bias, added in squares (docs/method.md).
Estimate overlap_estimate(const NetworkCounts& counts, std::uint64_t population);
/// Standard errors of `overlap_matrix`, by the jackknife over the same groups.
OverlapMatrix overlap_standard_errors(const NetworkCounts& counts, std::uint64_t population);

/// How many voxels `evaluate_sampled` needs so that no standard error, of coverage and, with `overlap`, of overlap,
/// exceeds `wanted` on any of `networks`. Found on pilot samples that grow until one holds; at most
/// `simulator.voxel_count()`, then the error is 0. Throws Error invalid_argument unless wanted > 0.
std::uint64_t voxels_for_standard_error(Simulator& simulator, std::span<const Network> networks, double wanted,
                                        bool overlap = true, const Progress& progress = {});

/// Whose surfaces hold scans together.
enum class RegistrationSurfaces {
  surveyed,  ///< Those that are surveyed and no others: on the safe side.
  all,       ///< Those that nobody surveys too, as ground and neighbours: by the voxels of `surroundings_of()`.
};
std::string to_string(RegistrationSurfaces);

/// What registration starts from: one standard deviation of what site and instrument say of a station's pose before
/// scans are matched, and how well scans have the surface. Reasons and sources: docs/method.md.
struct RegistrationOptions {
  RegistrationModel model = {};
  double position_m = 0.03;             ///< Of the head, in each axis; above 0.
  Angle heading = Angle::degrees(0.2);  ///< Above 0.
  /// Of each of the two tilts: a dual-axis compensator's. 0: exactly level, so 4 unknowns a station instead of 6; some
  /// degrees: not levelled at all.
  Angle tilt = Angle::degrees(15.0 / 3600);
  RegistrationSurfaces surfaces = RegistrationSurfaces::surveyed;  ///< The error is that of surveyed ones either way.
};

Settings settings(const RegistrationOptions& options);
/// Throws Error invalid_argument with the member and its value.
void check(const RegistrationOptions& options);

/// What the error of one station's pose does.
struct StationError {
  double rms_m = 0;  ///< Root mean square over the surface that it sees; 0 where it sees none.
  /// Covariance of its head, m², survey frame: row-major, x, y, z.
  std::array<double, 9> covariance{};
  /// Axes of the standard ellipsoid (one sigma) of that, metres: longest first.
  std::array<Vec3, 3> axes{};
};

/// Predicted error of a registered network, metres.
struct RegistrationError {
  double rms_m = 0;    ///< Over the covered surface: root mean square of the displacement of its points.
  double worst_m = 0;  ///< `rms_m` of the worst station.
  std::size_t worst_station = 0;
  std::vector<StationError> stations;
  /// Per station, what gives the displacement anywhere: covariance of [turn · scale_m, shift], 6 × 6 row-major, of the
  /// displacement shift + turn × (p − centre).
  std::vector<std::array<double, 36>> poses;
  Vec3 centre;  ///< Local frame, as `RegistrationSums::centre`.
  double scale_m = 1;

  /// Root mean square of the displacement that station `station` gives a point of the local frame.
  double at(std::size_t station, const Vec3& local) const;
};

/// The covariance of a least-squares adjustment of all scans, planes against planes (Gelfand et al. 2003; Censi 2007),
/// less the best-fitting motion of the whole: that is the survey's own frame, and no error of the registration. Of a
/// sample of a site of `voxels` voxels what the whole site would give. Parts that share nothing have the error that
/// they start from. Where nothing is covered, the error of a position. `surroundings`: the same network's counts by
/// `surroundings_of()`, of a site of `surroundings_voxels`; looked at where `options.surfaces` are all. Throws Error
/// invalid_argument unless `registration` was filled in all counts that are looked at. REQUIRES: with `options.model`.
RegistrationError registration_error(const NetworkCounts& counts, std::uint64_t voxels,
                                     const RegistrationOptions& options = {},
                                     const NetworkCounts* surroundings = nullptr,
                                     std::uint64_t surroundings_voxels = 0);
/// `registration_error(…).rms_m`, of a sample less its bias, and the standard error, by the jackknife over its groups.
Estimate registration_estimate(const NetworkCounts& counts, std::uint64_t voxels,
                               const RegistrationOptions& options = {}, const NetworkCounts* surroundings = nullptr,
                               std::uint64_t surroundings_voxels = 0);

/// The overlap graph as registration sees it: which stations hang together, and by what.
struct Connectivity {
  std::size_t parts = 0;                                     ///< Connected parts.
  std::vector<std::size_t> part;                             ///< Per station, the part it is in, from 0.
  std::vector<std::pair<std::size_t, std::size_t>> bridges;  ///< Links without which a part falls in two, i < j.
  /// Where there is one part: the weakest link of the strongest spanning tree, and its overlap. What the registration
  /// hangs by.
  std::pair<std::size_t, std::size_t> weakest_link{0, 0};
  double weakest_overlap = 0;
};
/// Links are the pairs whose overlap is above 0 and at least `min_overlap`.
Connectivity connectivity(const OverlapMatrix& overlap, double min_overlap);
/// Stations of less overlap count as not linked, unless asked otherwise: figure 12 of the method draws links from 0.01
/// on; its figure 16 those above 0.05.
inline constexpr double default_link_overlap = 0.01;

}  // namespace vantage
