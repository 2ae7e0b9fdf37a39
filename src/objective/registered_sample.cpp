// SPDX-License-Identifier: Apache-2.0
#include "objective/registered_sample.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "vantage/registration.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t kLeastVoxels = std::uint64_t{1} << 13, kWeighingVoxels = std::uint64_t{1} << 16;
// A registration error is known if its standard error is at most this share of it, or this length if larger.
constexpr double kKnownShare = 0.02, kKnown_m = 0.02e-3;
// A larger sample must agree with the smaller one within this many standard errors of the smaller. A sample without a
// voxel of surfaces that hold the scans together, such as a facade's reveals, underestimates its own error.
constexpr double kAgree = 2;

// Decides for each network if its error is known, sample by sample.
class Known {
 public:
  bool operator()(std::size_t network, const Estimate& rms_m) {
    const double enough = std::max(kKnownShare * rms_m.value, kKnown_m);
    const auto before = before_.find(network);
    const bool agree = before != before_.end() && std::abs(rms_m.value - before->second.value) <=
                                                      kAgree * before->second.standard_error + enough / 2;
    before_[network] = rms_m;
    return agree && rms_m.standard_error <= enough;
  }

 private:
  std::map<std::size_t, Estimate> before_;
};

}  // namespace

EveryRayOptions count_surveyed(const RequiredInputs& needs, const RegistrationOptions& registration,
                               const Simulator& simulator) {
  EveryRayOptions options{.registration = needs.registration};
  if (needs.surroundings_registration) {
    options.registration_voxels = kWeighingVoxels;
    return options;
  }
  options.registration_voxels = kLeastVoxels;
  options.registration_known = [known = Known(), registration, &simulator](std::size_t k,
                                                                           const NetworkCounts& counts) mutable {
    return known(k, registration_estimate(counts, simulator.voxel_count(), registration));
  };
  return options;
}

EveryRayOptions count_surroundings(const RequiredInputs& needs, const RegistrationOptions& registration,
                                   const std::vector<NetworkCounts>& surveyed, const Simulator& simulator,
                                   const Simulator& surroundings) {
  EveryRayOptions options;
  if (!needs.surroundings_registration) return options;
  options.registration = needs.registration;
  options.registration_voxels = kLeastVoxels;
  options.registration_known = [known = Known(), registration, &surveyed, &simulator, &surroundings](
                                   std::size_t k, const NetworkCounts& counts) mutable {
    return known(k, registration_estimate(surveyed[k], simulator.voxel_count(), registration, &counts,
                                          surroundings.voxel_count()));
  };
  return options;
}

}  // namespace vantage
