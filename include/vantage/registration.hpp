// SPDX-License-Identifier: Apache-2.0
/// The registration error of a network from its counts. Evaluations tell it as `Evaluation::registration`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/measure.hpp"
#include "vantage/trace.hpp"
#include "vantage/types.hpp"

namespace vantage {

/// A point that scans measure one by one, such as the centre of a target. It ties scans together where surfaces do not.
struct RegistrationTarget {
  Vec3 centre;           ///< Local frame (survey frame less `Simulator::origin()`).
  double control_m = 0;  ///< Standard deviation of known coordinates, in each axis; 0: they are not known.
  /// One scan that measures it.
  struct Sighting {
    std::size_t station;  ///< Its place in the network.
    /// Standard deviation of the centre in that scan, above 0: in each axis across the line from the head, and along
    /// it.
    double across_m, along_m;
  };
  std::vector<Sighting> seen_by = {};  ///< A station at most once.
};

/// Covariance of a least-squares adjustment of all scans, planes against planes (Gelfand et al. 2003; Censi 2007),
/// without the best-fitting motion of the whole. That motion is the survey's own frame and no error of the
/// registration. A sample of a site of `voxels` voxels gives the error that the whole site would give. Components that
/// share nothing keep their prior error. If nothing is covered, the result is the error of a position.
/// `surroundings` are the same network's counts by `surroundings_of()`, of a site of `surroundings_voxels`; used if
/// `options.surfaces` is `all`. `targets` tie stations in all three axes, besides surfaces.
/// Throws Error invalid_argument unless `registration` was filled in all counts used.
/// REQUIRES: with `options.model`.
RegistrationError registration_error(const NetworkCounts& counts, std::uint64_t voxels,
                                     const RegistrationOptions& options = {},
                                     const NetworkCounts* surroundings = nullptr, std::uint64_t surroundings_voxels = 0,
                                     std::span<const RegistrationTarget> targets = {});
/// `registration_error(…).rms_m`, less its bias for a sample, and the standard error, by the jackknife over its groups.
Estimate registration_estimate(const NetworkCounts& counts, std::uint64_t voxels,
                               const RegistrationOptions& options = {}, const NetworkCounts* surroundings = nullptr,
                               std::uint64_t surroundings_voxels = 0, std::span<const RegistrationTarget> targets = {});

}  // namespace vantage
