// SPDX-License-Identifier: Apache-2.0
/// Attainable coverage of a site, and the share of it that a network captures.
///
/// The attainable count a_v of a voxel is the most points that one station alone leaves in it, up to the goal g_v, over
/// a set of stations: one on each candidate. With weights w_v, attainable coverage is Σ w_v a_v/g_v / Σ w_v. A network
/// with n_v points in each voxel captures Σ w_v min(a_v, n_v)/g_v / Σ w_v a_v/g_v of it. Stations that only add points
/// where one station already gets as much of the surface count for nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "vantage/measure.hpp"
#include "vantage/progress.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

/// Shares of what is attainable that a network captures.
struct CapturedShares {
  Estimate all;                                 ///< Share for all surveyed surface.
  std::map<std::string, Estimate> meshes = {};  ///< Share for the meshes of each pattern that was asked for.
};

/// Attainable counts of a sample of the surveyed voxels, or of all of them.
class AttainableCounts {
 public:
  /// Holds no voxels.
  AttainableCounts() = default;
  /// Has no station yet, in the voxels that `Simulator::evaluate_sampled` draws for these `SampleOptions`. Throws Error
  /// invalid_argument for 0 voxels.
  AttainableCounts(const Simulator& simulator, std::uint64_t voxels, std::uint64_t from = 0);

  /// The same of a smaller sample from the same place, which is part of this one. Throws Error invalid_argument for 0
  /// voxels, or more than there are here.
  AttainableCounts part(const Simulator& simulator, std::uint64_t voxels) const;

  const std::vector<std::uint32_t>& voxels() const noexcept { return voxels_; }  ///< Voxel of each element, ascending.
  std::uint64_t sample_voxels() const noexcept { return sample_voxels_; }        ///< As asked for.
  std::uint64_t from() const noexcept { return from_; }                          ///< As asked for.
  std::uint64_t population() const noexcept { return population_; }              ///< Number of surveyed voxels.
  /// Elements of the surveyed meshes of a pattern.
  struct OfMeshes {
    std::string meshes;             ///< The pattern, as it was given.
    std::vector<std::uint8_t> has;  ///< 1 for each element of those meshes, else 0.
  };
  /// Tells the share captured of the surveyed meshes of a pattern too, as `captured()` of vantage/objective.hpp takes
  /// it. Throws Error invalid_argument if no surveyed mesh has such a name. REQUIRES: the simulator of these counts.
  void tell_of(const Simulator& simulator, const std::string& meshes);
  std::span<const OfMeshes> told_of() const noexcept { return told_of_; }  ///< In the order in which they were given.
  /// Point weights of the attainable count of each element, at most goal().
  const std::vector<double>& counts() const noexcept { return counts_; }
  /// Point weights that fill a voxel: the densest goal density times `NetworkCounts::point_weight`.
  double goal() const noexcept { return goal_; }
  /// True if some station fills the voxel of an element, beyond which its count does not rise.
  bool has_goal(std::size_t element) const noexcept { return counts_[element] >= goal_; }

  /// Takes in a station that leaves so many points in each element. REQUIRES: one number for each.
  void raise(std::span<const std::uint32_t> points);
  /// Takes in a station that leaves so many point weights in one element.
  void raise(std::size_t element, double point_weights);

  /// Attainable coverage, with the standard error of the sample.
  Estimate coverage() const;
  /// The share of it that a network with so many points in each element captures; 0 where nothing is attainable.
  /// REQUIRES: one number for each.
  Estimate captured(std::span<const std::uint32_t> points) const;
  /// The same of so many point weights in each element.
  Estimate captured(std::span<const double> point_weights) const;
  /// The share, and that of the meshes of each pattern that was told of; 0 where nothing of them is attainable.
  CapturedShares captured_shares(std::span<const std::uint32_t> points) const;

 private:
  double weighted(std::size_t element, std::uint32_t points) const {
    return static_cast<double>(points) * point_weights_[element];
  }
  Estimate captured(std::span<const double> point_weights, const OfMeshes* of) const;
  template <class Share>
  Estimate ratio(const std::vector<double>& whole, const Share& part) const;

  std::vector<std::uint32_t> voxels_, weights_, point_weights_;
  std::vector<double> counts_;
  std::uint64_t population_ = 0, sample_voxels_ = 0, from_ = 0;
  double goal_ = 1;
  std::vector<OfMeshes> told_of_;
};

/// Traces each active station alone, and takes it in. False if stopped; then some are missing.
bool raise_attainable(AttainableCounts& attainable, Simulator& simulator, std::span<const Station> stations,
                      const Progress& progress = {});

/// The shares of what is attainable that each network captures, traced on the voxels of `attainable`. Empty if stopped.
std::vector<CapturedShares> captured_shares(Simulator& simulator, const AttainableCounts& attainable,
                                            std::span<const Network> networks, const Progress& progress = {});

}  // namespace vantage
