// SPDX-License-Identifier: Apache-2.0
/// Measures of a network from its counts: coverage (equation 8), overlap (equations 11 and 13), their standard errors,
/// registration and connectivity. Whatever takes counts throws Error invalid_argument where these are `cancelled`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vantage/settings.hpp"
#include "vantage/simulator.hpp"
#include "vantage/trace.hpp"

namespace vantage {

/// Symmetric matrix with a number for each pair of stations, zero on the diagonal.
class PairMatrix {
 public:
  PairMatrix() = default;
  explicit PairMatrix(std::size_t n) : n_(n), values_(n * n, 0.0) {}  ///< Makes one of `n` stations, all 0.
  std::size_t size() const noexcept { return n_; }                    ///< Number of stations.
  /// Number of a pair. REQUIRES: i, j < size(), as below.
  double operator()(std::size_t i, std::size_t j) const { return values_[i * n_ + j]; }
  /// Sets i, j and j, i.
  void set(std::size_t i, std::size_t j, double value) { values_[i * n_ + j] = values_[j * n_ + i] = value; }
  /// Numbers of station i with each.
  std::span<const double> row(std::size_t i) const { return {values_.data() + i * n_, n_}; }

 private:
  std::size_t n_ = 0;
  std::vector<double> values_;
};
/// Overlap_ij (equation 11): the voxels that both stations see, of those that either sees.
class OverlapMatrix : public PairMatrix {
 public:
  using PairMatrix::PairMatrix;
};
/// Scan overlap: the voxels that both stations see, of those that the smaller scan sees, |i and j| / min(|i|, |j|).
/// Practice states the overlap that registration takes so. It is up to twice the overlap of equation 11, or more where
/// scans differ in size.
class ScanOverlapMatrix : public PairMatrix {
 public:
  using PairMatrix::PairMatrix;
};

/// Equation 8, in [0, 1]: a mean over voxels, weighted by the weights of meshes. 0 for a scene without surveyed voxels.
/// REQUIRES: goal_density > 0.
double coverage(const NetworkCounts& counts, double goal_density);
/// Equation 11 for every pair; 0/0 is 0.
OverlapMatrix overlap_matrix(const NetworkCounts& counts);
/// Scan overlap of every pair; 0/0 is 0.
ScanOverlapMatrix scan_overlap_matrix(const NetworkCounts& counts);
/// Smallest scan overlap at which two stations count as linked, by default; usual in practice.
inline constexpr double default_link = 0.3;
/// Equation 13: average weighted clustering coefficient, in [0, 1]; the maximum is over all pairs. 0/0 is 0, so
/// networks of one or two stations, or without a shared voxel, have 0.
double clustering_coefficient(const OverlapMatrix& overlap);

/// An estimate and its standard error. The error is 0 when the whole population was counted. It is 0.5, the largest
/// possible for a value in [0, 1], if the sample is too small to tell (one voxel).
struct Estimate {
  double value = 0, standard_error = 0;  ///< In the unit of what is estimated; NaN: not known.
};
/// Equation 8 from a sample of `population` voxels. The error uses successive differences along the Morton order, as a
/// systematic sample needs: s/√n would be too wide. With weights it is a ratio estimate, with the jackknife's error
/// over the interleaved groups.
Estimate coverage_estimate(const NetworkCounts& counts, double goal_density, std::uint64_t population);
/// Equation 13 from a sample, less its bias: the excess of half of the sample over all of it. The error combines the
/// jackknife's over the interleaved groups and that bias, added in squares (docs/method.md).
Estimate overlap_estimate(const NetworkCounts& counts, std::uint64_t population);
/// Standard errors of `overlap_matrix`, by the jackknife over the same groups.
PairMatrix overlap_standard_errors(const NetworkCounts& counts, std::uint64_t population);

/// Number of voxels that `evaluate_sampled` needs so that no standard error exceeds `wanted` on any of `networks`: of
/// coverage and, with `overlap`, of overlap. Found on growing pilot samples; at most `simulator.voxel_count()`, whose
/// error is 0. A stopped call returns the size that it was about to try. Throws Error invalid_argument unless wanted >
/// 0.
std::uint64_t voxels_for_standard_error(Simulator& simulator, std::span<const Network> networks, double wanted,
                                        bool overlap = true, const Progress& progress = {});

/// Surfaces by which scans are registered.
enum class RegistrationSurfaces {
  surveyed,  ///< Surveyed surfaces only: conservative.
  all,       ///< All surfaces, e.g. ground and neighbours too, as voxels of `surroundings_of()`.
};
std::string to_string(RegistrationSurfaces);  ///< "surveyed", "all"

/// Prior of registration: one standard deviation of each station's pose before scans are matched, and how accurately
/// scans have the surface. Reasons and sources: docs/method.md.
struct RegistrationOptions {
  RegistrationModel model = {};         ///< Accuracy of a surface in one scan.
  double position_m = 0.03;             ///< Head's position, in each axis; above 0.
  Angle heading = Angle::degrees(0.2);  ///< Above 0.
  /// Each of the two tilts, as by a dual-axis compensator. 0: exactly level, so 4 unknowns a station instead of 6; some
  /// degrees: not levelled at all.
  Angle tilt = Angle::degrees(15.0 / 3600);
  bool tilt_of_scanner = false;  ///< In place of `tilt` that of the scanners: `levelled_by()`.
  RegistrationSurfaces surfaces = RegistrationSurfaces::surveyed;  ///< The error is that of surveyed surfaces either
                                                                   ///< way.
};

/// Its members as named values, for results and configuration files.
Settings settings(const RegistrationOptions& options);
/// One row for each setting, and its bounds.
const SettingTable<RegistrationOptions>& registration_settings();
/// Throws Error invalid_argument with the member and its value.
void check(const RegistrationOptions& options);
/// The options with the tilt of the scanners (`Scanner::tilt_accuracy`), the largest of several, if they ask for it.
/// Evaluations, plans and proposals of targets begin with this. Throws Error invalid_argument for a scanner that states
/// none.
RegistrationOptions levelled_by(RegistrationOptions options, std::span<const Scanner> scanners);

/// Effect of the error of one station's pose.
struct StationError {
  double rms_m = 0;  ///< Root mean square over the surface that it sees; 0 if it sees none.
  /// Covariance of the head, m², survey frame: row-major, x, y, z.
  std::array<double, 9> covariance{};
  /// Axes of its standard ellipsoid (one sigma), metres: longest first.
  std::array<Vec3, 3> axes{};
};

/// Predicted error of a registered network, metres.
struct RegistrationError {
  double rms_m = 0;               ///< Root mean square displacement of the points of the covered surface.
  double random_m = 0;            ///< The same without the errors that all scans of an instrument share.
  double worst_m = 0;             ///< `rms_m` of the worst station.
  std::size_t worst_station = 0;  ///< Its place in the network.
  /// As `rms_m`, in the site's frame and not in the survey's own; known if a station sees a control point.
  std::optional<double> absolute_rms_m = std::nullopt;
  std::vector<StationError> stations;  ///< One for each station.
  /// Per station: covariance of [turn · scale_m, shift], 6 × 6 row-major. The displacement at p is shift + turn × (p −
  /// centre).
  std::vector<std::array<double, 36>> poses;
  Vec3 centre;         ///< Local frame, as `RegistrationSums::centre`.
  double scale_m = 1;  ///< Length that turns of `poses` are multiplied by.

  /// Root mean square displacement of a point of the local frame by station `station`.
  double at(std::size_t station, const Vec3& local) const;
};

/// Connectivity of the overlap graph, for registration.
struct Connectivity {
  std::size_t parts = 0;                                     ///< Connected components.
  std::vector<std::size_t> part;                             ///< Per station, its component, from 0.
  std::vector<std::pair<std::size_t, std::size_t>> bridges;  ///< Links without which a component falls in two, i < j.
  /// The weakest link of the strongest spanning tree, and its overlap, if there is one component. The whole
  /// registration depends on it.
  std::pair<std::size_t, std::size_t> weakest_link{0, 0};
  double weakest_overlap = 0;  ///< Overlap of the weakest link.
};
/// Links are the pairs whose overlap is above 0 and at least `min_overlap`, from 0 to 1.
/// Throws Error: invalid_argument.
Connectivity connectivity(const PairMatrix& overlap, double min_overlap);
/// Smallest overlap (equation 11) at which stations count as linked, by default. Figure 12 of the method draws links
/// from 0.01 on; its figure 16 those above 0.05.
inline constexpr double default_link_overlap = 0.01;

}  // namespace vantage
