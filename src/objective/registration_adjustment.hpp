// SPDX-License-Identifier: Apache-2.0
// Covariance of a network registered plane against plane, and by targets. Point-to-plane information: Gelfand, Ikemoto,
// Rusinkiewicz, Levoy, Geometrically Stable Sampling for the ICP Algorithm, 2003; Censi, An accurate closed-form
// estimate of ICP's covariance, 2007.
//
// Unknowns of a station are x = [turn · scale, shift]: a point at q (in units of scale, from the centre of the covered
// surface) moves by shift + turn · scale × q. With rotations in the scale of the surface and coordinates from its
// centre, the matrix is well conditioned wherever on Earth the site lies.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <vector>

#include "objective/sparse_covariance.hpp"
#include "vantage/measure.hpp"
#include "vantage/registration.hpp"

namespace vantage {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix36d = Eigen::Matrix<double, 3, 6>;

// Returns the displacement at q by an unknown vector.
Matrix36d displacement(const Eigen::Vector3d& q);

// Mass, centre and second moments of a surface.
struct Moments {
  double mass = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  Moments() = default;
  explicit Moments(const double* m);
  void add(const Moments& other);
  // Returns the moments about another centre, in units of `scale`.
  Moments moved(const Eigen::Vector3d& centre, double scale) const;
  // Returns Σ displacement(q)ᵀ displacement(q).
  Matrix6d quadratic() const;
};

// Adjusts the stations that see something.
class RegistrationAdjustment {
 public:
  // `sums`: of the surfaces that register the scans; `share` scales them from counted voxels to the whole site.
  // `covered`: of the surface whose error is wanted. Borrows all of them.
  RegistrationAdjustment(const RegistrationSums& sums, double share, const RegistrationSums& covered,
                         const RegistrationOptions& options, std::span<const RegistrationTarget> targets);

  // Errors that all scans of an instrument share (`RegistrationSums::instrument`) are unknown and not estimated. Their
  // effect is added: C + K Kᵀ with K = C · instrument().
  RegistrationError error() const;

  // The rest predicts the effect of a further target without a new adjustment. A column of unknowns has `unknowns()`
  // entries for each of `stations()`.
  bool covers_something() const { return mass_ > 0; }
  std::span<const std::size_t> stations() const { return stations_; }  // by their places in the network
  Eigen::Index unknowns() const { return unknowns_; }                  // of a station: 4 or 6
  Eigen::MatrixXd covariance() const;                                  // of all unknowns
  // The mean square error over the covered surface is tr(metric() · covariance()).
  Eigen::MatrixXd metric() const;
  // Returns the inverse covariance of a target's centre in a scan. REQUIRES: the station is one of `stations()`.
  Eigen::Matrix3d sighting_weight(const RegistrationTarget& target, const RegistrationTarget::Sighting& sighting) const;
  // Returns the displacement of a point of the local frame by a station's unknowns: 3 × unknowns().
  Eigen::MatrixXd displacement_at(const Vec3& local) const;

 private:
  Eigen::Vector3d head(std::size_t place) const;
  Eigen::Vector3d scaled(const Vec3& from_sums_centre) const;
  Matrix6d information_of(std::size_t i, std::size_t j) const;
  Matrix6d from_sums() const;
  Matrix6d prior_of(std::size_t place) const;
  Eigen::MatrixXd mean() const;
  PartialInverse inverse_times(const Eigen::MatrixXd& right) const;
  // Returns Σ Jᵀ w (b − b̄) of all unknowns × errors of the instrument; no columns if none are stated.
  Eigen::MatrixXd instrument() const;
  std::size_t pair(std::size_t i, std::size_t j) const;  // its first sum
  bool tied(std::size_t i, std::size_t j) const;
  Eigen::MatrixXd information() const;
  SparseBlocks sparse_information() const;
  template <class Add>
  void for_information(const Add& add) const;
  template <class Add>
  void for_targets(const Add& add) const;
  Eigen::MatrixXd of_unknowns(const Eigen::MatrixXd& all) const;
  std::vector<Matrix6d> relative_covariances(const PartialInverse& covariances, const Eigen::MatrixXd& mean) const;

  const RegistrationSums& sums_;
  double share_;  // voxels of the site divided by counted voxels
  RegistrationOptions options_;
  std::span<const RegistrationTarget> targets_;
  Eigen::Index unknowns_;  // per station
  std::vector<std::size_t> stations_;
  std::vector<Moments> moments_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  // in units of the sums' radius, as is the scale
  double scale_ = 1, mass_ = 0;
};

// Inputs of an adjustment. Borrows the counts.
struct RegistrationInputs {
  const RegistrationSums& held_by;
  double share;
  const RegistrationSums& covered;
};
// Returns them. Throws Error invalid_argument as registration_error().
RegistrationInputs registration_inputs(const NetworkCounts& counts, std::uint64_t voxels,
                                       const RegistrationOptions& options, const NetworkCounts* surroundings,
                                       std::uint64_t surroundings_voxels);

}  // namespace vantage
