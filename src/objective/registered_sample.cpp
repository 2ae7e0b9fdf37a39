// SPDX-License-Identifier: Apache-2.0
#include "objective/registered_sample.hpp"

#include <algorithm>


namespace vantage {
namespace {

constexpr std::uint64_t kLeastVoxels = std::uint64_t{1} << 14, kWeighingVoxels = std::uint64_t{1} << 16;
// Standard error up to which an error is known: a share of it, or a length if that is larger.
constexpr double kKnownShare = 0.02, kKnown_m = 0.02e-3;

bool is_known(const Estimate& rms_m) { return rms_m.standard_error <= std::max(kKnownShare * rms_m.value, kKnown_m); }

}  // namespace

EvaluateOptions count_surveyed(const RequiredInputs& needs, const RegistrationOptions& registration,
                               const Simulator& simulator) {
  EvaluateOptions options{.registration = needs.registration};
  if (needs.surroundings_registration) {
    options.registration_voxels = kWeighingVoxels;
    return options;
  }
  options.registration_voxels = kLeastVoxels;
  options.registration_known = [registration, &simulator](std::size_t, const NetworkCounts& counts) {
    return is_known(registration_estimate(counts, simulator.voxel_count(), registration));
  };
  return options;
}

EvaluateOptions count_surroundings(const RequiredInputs& needs, const RegistrationOptions& registration,
                                   const std::vector<NetworkCounts>& surveyed, const Simulator& simulator,
                                   const Simulator& surroundings) {
  EvaluateOptions options;
  if (!needs.surroundings_registration) return options;
  options.registration = needs.registration;
  options.registration_voxels = kLeastVoxels;
  options.registration_known = [registration, &surveyed, &simulator, &surroundings](std::size_t k,
                                                                                    const NetworkCounts& counts) {
    return is_known(
        registration_estimate(surveyed[k], simulator.voxel_count(), registration, &counts, surroundings.voxel_count()));
  };
  return options;
}

}  // namespace vantage
