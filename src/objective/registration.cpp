// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "objective/registration_adjustment.hpp"
#include "objective/whole_counts.hpp"
#include "vantage/error.hpp"
#include "vantage/measure.hpp"
#include "vantage/scanner.hpp"

namespace vantage {

RegistrationOptions levelled_by(RegistrationOptions options, std::span<const Scanner> scanners) {
  if (!options.tilt_of_scanner) return options;
  options.tilt_of_scanner = false;
  options.tilt = Angle();
  for (const Scanner& scanner : scanners) {
    if (!(scanner.tilt_accuracy.in_radians() > 0))
      throw Error(Errc::invalid_argument,
                  "registration-tilt: the scanner " + scanner.name + " states no accuracy of its tilts; give degrees");
    options.tilt = Angle::radians(std::max(options.tilt.in_radians(), scanner.tilt_accuracy.in_radians()));
  }
  return options;
}

// E |shift + turn × q|² = tr D + 2 q · E[shift × turn] + |q|² tr A − qᵀ A q, with A the covariance of the turn and D
// that of the shift. Written out, since a map evaluates it at millions of points.
double RegistrationError::at(std::size_t station, const Vec3& local) const {
  const std::array<double, 36>& pose = poses[station];
  const auto c = [&](std::size_t row, std::size_t column) { return pose[6 * row + column]; };
  const Vec3 q = (local - centre) * (1 / scale_m);
  const Vec3 shift_by_turn{c(2, 4) - c(1, 5), c(0, 5) - c(2, 3), c(1, 3) - c(0, 4)};
  const Vec3 turned{c(0, 0) * q.x + c(0, 1) * q.y + c(0, 2) * q.z, c(1, 0) * q.x + c(1, 1) * q.y + c(1, 2) * q.z,
                    c(2, 0) * q.x + c(2, 1) * q.y + c(2, 2) * q.z};
  const double square = c(3, 3) + c(4, 4) + c(5, 5) + 2 * dot(q, shift_by_turn) +
                        (c(0, 0) + c(1, 1) + c(2, 2)) * dot(q, q) - dot(q, turned);
  return std::sqrt(std::max(square, 0.0));
}

RegistrationInputs registration_inputs(const NetworkCounts& counts, std::uint64_t voxels,
                                       const RegistrationOptions& options, const NetworkCounts* surroundings,
                                       std::uint64_t surroundings_voxels) {
  check(options);
  if (options.tilt_of_scanner)
    throw Error(Errc::invalid_argument, "registration: the tilt of a scanner is asked for; see levelled_by()");
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
  const RegistrationSums& sums = held_by.registration;
  return {sums, sums.voxels > 0 ? static_cast<double>(of) / static_cast<double>(sums.voxels) : 1, counts.registration};
}

RegistrationError registration_error(const NetworkCounts& counts, std::uint64_t voxels,
                                     const RegistrationOptions& options, const NetworkCounts* surroundings,
                                     std::uint64_t surroundings_voxels, std::span<const RegistrationTarget> targets) {
  const RegistrationInputs inputs = registration_inputs(counts, voxels, options, surroundings, surroundings_voxels);
  return RegistrationAdjustment(inputs.held_by, inputs.share, inputs.covered, options, targets).error();
}

}  // namespace vantage
