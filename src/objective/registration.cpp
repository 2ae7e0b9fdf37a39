// SPDX-License-Identifier: Apache-2.0
// Covariance of a network registered plane against plane. Point-to-plane information: Gelfand, Ikemoto, Rusinkiewicz,
// Levoy, Geometrically Stable Sampling for the ICP Algorithm, 2003; Censi, An accurate closed-form estimate of ICP's
// covariance, 2007.
//
// Unknowns of a station are x = [turn · scale, shift]: a point at q (in units of scale, from the centre of the covered
// surface) moves by shift + turn · scale × q. With rotations in the scale of the surface and coordinates from its
// centre, the matrix is well conditioned wherever on Earth the site lies.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "core/setting_list.hpp"
#include "objective/whole_counts.hpp"
#include "vantage/error.hpp"
#include "vantage/measure.hpp"

namespace vantage {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix36d = Eigen::Matrix<double, 3, 6>;

constexpr std::size_t of_pair = RegistrationSums::of_pair, of_station = RegistrationSums::of_station;
constexpr double least_scale_m = 1;  // least scale of rotations, for tiny surfaces

Vector3d to_eigen(const Vec3& v) { return {v.x, v.y, v.z}; }

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// Displacement at q by an unknown vector.
Matrix36d displacement(const Vector3d& q) {
  Matrix36d m;
  m << -cross_matrix(q), Matrix3d::Identity();
  return m;
}

// Mass, centre and second moments of a surface.
struct Moments {
  double mass = 0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();

  Moments() = default;
  explicit Moments(const double* m) : mass(m[0]), first(m[1], m[2], m[3]) {
    second << m[4], m[5], m[6], m[5], m[7], m[8], m[6], m[8], m[9];
  }
  void add(const Moments& other) {
    mass += other.mass;
    first += other.first;
    second += other.second;
  }
  // The same about another centre, in units of `scale`.
  Moments moved(const Vector3d& centre, double scale) const {
    Moments m;
    m.mass = mass;
    m.first = (first - mass * centre) / scale;
    m.second = (second - first * centre.transpose() - centre * first.transpose() + mass * centre * centre.transpose()) /
               (scale * scale);
    return m;
  }
  // Σ displacement(q)ᵀ displacement(q).
  Matrix6d quadratic() const {
    Matrix6d m;
    m << second.trace() * Matrix3d::Identity() - second, cross_matrix(first), -cross_matrix(first),
        mass * Matrix3d::Identity();
    return m;
  }
};

// Adjustment of the stations that see something.
class Adjustment {
 public:
  // `sums`: of the surfaces that register the scans; `share` scales them from the counted voxels to the whole site.
  // `covered`: of the surface whose error is wanted.
  Adjustment(const RegistrationSums& sums, double share, const RegistrationSums& covered,
             const RegistrationOptions& options)
      : sums_(sums), share_(share), options_(options), unknowns_(options.tilt.in_radians() > 0 ? 6 : 4) {
    Moments all;
    const Vector3d offset = to_eigen(sums.centre - covered.centre) / covered.radius_m;
    for (std::size_t k = 0; k < sums.heads.size(); ++k) {
      const Moments own =
          Moments(covered.surface.data() + k * of_station).moved(offset, sums.radius_m / covered.radius_m);
      if (!(own.mass > 0) && !(sums.surface[k * of_station] > 0)) continue;
      stations_.push_back(k);
      moments_.push_back(own);
      all.add(own);
    }
    if (!(all.mass > 0)) return;
    centre_ = all.first / all.mass;
    const double spread = (all.second.trace() / all.mass - centre_.squaredNorm());
    scale_ = std::max(std::sqrt(std::max(spread, 0.0)), least_scale_m / sums.radius_m);
    mass_ = all.mass;
    for (Moments& own : moments_) own = own.moved(centre_, scale_);
  }

  RegistrationError error() const {
    RegistrationError result;
    result.stations.resize(sums_.heads.size());
    result.poses.resize(sums_.heads.size());
    result.centre = sums_.centre;
    if (!(mass_ > 0)) {
      result.rms_m = result.worst_m = std::sqrt(3.0) * options_.position_m;
      return result;
    }
    const Vector3d centre = centre_ * sums_.radius_m;
    result.centre = result.centre + Vec3{centre.x(), centre.y(), centre.z()};
    result.scale_m = scale_ * sums_.radius_m;
    const auto covariances = relative_covariances();
    double total = 0;
    for (std::size_t k = 0; k < stations_.size(); ++k) {
      const std::size_t place = stations_[k];
      const double squares = std::max((moments_[k].quadratic() * covariances[k]).trace(), 0.0);
      total += squares;
      StationError& station = result.stations[place];
      station.rms_m = moments_[k].mass > 0 ? std::sqrt(squares / moments_[k].mass) : 0;
      if (station.rms_m > result.worst_m) {
        result.worst_m = station.rms_m;
        result.worst_station = place;
      }
      const Matrix36d at_head = displacement(head(place));
      describe_head(station, at_head * covariances[k] * at_head.transpose());
      Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(result.poses[place].data()) = covariances[k];
    }
    result.rms_m = std::sqrt(total / mass_);
    return result;
  }

 private:
  static void describe_head(StationError& station, const Matrix3d& covariance) {
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(station.covariance.data()) = covariance;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance);
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d v = solver.eigenvectors().col(2 - axis) * std::sqrt(std::max(solver.eigenvalues()[2 - axis], 0.0));
      station.axes[static_cast<std::size_t>(axis)] = {v.x(), v.y(), v.z()};
    }
  }

  Vector3d head(std::size_t place) const { return (to_eigen(sums_.heads[place]) / sums_.radius_m - centre_) / scale_; }

  // Σ w_i w_j / Σw · J Jᵀ with J about the surface's centre and in its scale.
  Matrix6d information_of(std::size_t i, std::size_t j) const {
    const std::size_t n = sums_.heads.size();
    const double* sum = sums_.pairs.data() + (i * (2 * n - i - 1) / 2 + (j - i - 1)) * of_pair;
    Matrix6d h;
    for (int a = 0; a < 6; ++a)
      for (int b = a; b < 6; ++b) h(a, b) = h(b, a) = *sum++ * share_;
    Matrix6d moved = Matrix6d::Identity();
    moved.topLeftCorner<3, 3>() /= scale_;
    moved.topRightCorner<3, 3>() = -cross_matrix(centre_) / scale_;
    return moved * h * moved.transpose();
  }

  // Prior of tilt, heading and head.
  Matrix6d prior_of(std::size_t place) const {
    const auto weight = [](double sigma) { return sigma > 0 ? 1 / (sigma * sigma) : 0; };
    const double scale = scale_ * sums_.radius_m;
    Matrix6d given = Matrix6d::Zero();
    given.diagonal() << weight(options_.tilt.in_radians() * scale), weight(options_.tilt.in_radians() * scale),
        weight(options_.heading.in_radians() * scale), 0, 0, 0;
    const Matrix36d at_head = displacement(head(place));
    return given + weight(options_.position_m) * at_head.transpose() * at_head;
  }

  MatrixXd information() const {
    const auto size = static_cast<Eigen::Index>(stations_.size()) * 6;
    MatrixXd all = MatrixXd::Zero(size, size);
    for (std::size_t a = 0; a < stations_.size(); ++a) {
      const auto i = static_cast<Eigen::Index>(a) * 6;
      all.block<6, 6>(i, i) += prior_of(stations_[a]);
      for (std::size_t b = a + 1; b < stations_.size(); ++b) {
        const auto j = static_cast<Eigen::Index>(b) * 6;
        const Matrix6d h = information_of(stations_[a], stations_[b]);
        all.block<6, 6>(i, i) += h;
        all.block<6, 6>(j, j) += h;
        all.block<6, 6>(i, j) -= h;
        all.block<6, 6>(j, i) -= h;
      }
    }
    return all;
  }

  // Leaves out the two tilts of each station if they are known.
  MatrixXd of_unknowns(const MatrixXd& all) const {
    if (unknowns_ == 6) return all;
    const Eigen::Index n = all.rows() / 6;
    MatrixXd some(4 * n, 4 * n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) some.block<4, 4>(4 * i, 4 * j) = all.block<4, 4>(6 * i + 2, 6 * j + 2);
    return some;
  }

  // Covariance of each station's unknowns without the best-fitting motion of the whole: (I − 1 B) C (I − 1 B)ᵀ. B x is
  // that motion, the mean of the stations' motions in the metric of the surface that each sees.
  std::vector<Matrix6d> relative_covariances() const {
    const MatrixXd information = of_unknowns(this->information());
    const Eigen::Index d = unknowns_, size = information.rows(), skipped = 6 - d;
    const MatrixXd c = information.llt().solve(MatrixXd::Identity(size, size));
    MatrixXd sum = MatrixXd::Zero(d, d), metric(d, size);
    for (std::size_t k = 0; k < moments_.size(); ++k) {
      const MatrixXd own = moments_[k].quadratic().block(skipped, skipped, d, d);
      metric.middleCols(static_cast<Eigen::Index>(k) * d, d) = own;
      sum += own;
    }
    const MatrixXd mean = sum.completeOrthogonalDecomposition().solve(metric);
    const MatrixXd with_mean = c * mean.transpose(), of_mean = mean * with_mean;
    std::vector<Matrix6d> all;
    for (std::size_t k = 0; k < moments_.size(); ++k) {
      const Eigen::Index at = static_cast<Eigen::Index>(k) * d;
      const MatrixXd cross = with_mean.middleRows(at, d);
      Matrix6d own = Matrix6d::Zero();
      own.block(skipped, skipped, d, d) = c.block(at, at, d, d) - cross - cross.transpose() + of_mean;
      all.push_back(own);
    }
    return all;
  }

  const RegistrationSums& sums_;
  double share_;  // voxels of the site over counted voxels
  RegistrationOptions options_;
  Eigen::Index unknowns_;  // per station
  std::vector<std::size_t> stations_;
  std::vector<Moments> moments_;
  Vector3d centre_ = Vector3d::Zero();  // in units of the sums' radius, as is the scale
  double scale_ = 1, mass_ = 0;
};

}  // namespace

std::string to_string(RegistrationSurfaces surfaces) {
  return surfaces == RegistrationSurfaces::all ? "all" : "surveyed";
}

Settings settings(const RegistrationOptions& options) {
  return SettingList()
      .add("rho_m", options.model.rho_m, {"registration-rho"})
      .add("patch_m", options.model.patch_m, {"registration-patch"})
      .add("position_m", options.position_m, {"registration-position"})
      .add("heading_deg", options.heading, {"registration-heading"})
      .add("tilt_deg", options.tilt, {"registration-tilt"})
      .add("surfaces", to_string(options.surfaces), {"registration-surfaces"})
      .take();
}

void check(const RegistrationOptions& options) {
  const auto above_zero = [](const char* what, double value, bool or_zero = false) {
    if (std::isfinite(value) && (value > 0 || (or_zero && value == 0))) return;
    std::ostringstream text;
    text << "registration: " << what << " is " << value << ", but must be " << (or_zero ? "0 or above" : "above 0");
    throw Error(Errc::invalid_argument, text.str());
  };
  above_zero("rho_m", options.model.rho_m);
  above_zero("patch_m", options.model.patch_m);
  above_zero("position_m", options.position_m);
  above_zero("heading", options.heading.in_degrees());
  above_zero("tilt", options.tilt.in_degrees(), true);
}

double RegistrationError::at(std::size_t station, const Vec3& local) const {
  const Matrix36d m = displacement((to_eigen(local) - to_eigen(centre)) / scale_m);
  const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> covariance(poses[station].data());
  return std::sqrt(std::max((m * covariance * m.transpose()).trace(), 0.0));
}

RegistrationError registration_error(const NetworkCounts& counts, std::uint64_t voxels,
                                     const RegistrationOptions& options, const NetworkCounts* surroundings,
                                     std::uint64_t surroundings_voxels) {
  check(options);
  require_whole(counts, "registration");
  if (surroundings) require_whole(*surroundings, "registration");
  const bool all = options.surfaces == RegistrationSurfaces::all;
  const auto summed = [&](const NetworkCounts* c) { return c && c->registration.heads.size() == counts.stations; };
  if (!summed(&counts)) throw Error(Errc::invalid_argument, "registration: the evaluation was not asked for its sums");
  if (all && !summed(surroundings))
    throw Error(Errc::invalid_argument,
                "registration: by all surfaces, but the surroundings were not evaluated, or not asked for their sums");
  const NetworkCounts& held_by = all ? *surroundings : counts;
  const std::uint64_t of = all ? surroundings_voxels : voxels;
  const double share = held_by.voxels > 0 ? static_cast<double>(of) / static_cast<double>(held_by.voxels) : 1;
  return Adjustment(held_by.registration, share, counts.registration, options).error();
}

}  // namespace vantage
