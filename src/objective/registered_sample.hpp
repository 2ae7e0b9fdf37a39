// SPDX-License-Identifier: Apache-2.0
// The voxels from which registration is predicted if every voxel is counted. Planes of all voxels cost more than their
// counts, and a sample estimates the error well.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/objective.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Returns options that count the surveyed voxels with every ray. Their sums of registration grow until they determine
// the error. If all surfaces register the scans, they only weigh it, and come from one sample.
EveryRayOptions count_surveyed(const RequiredInputs& needs, const RegistrationOptions& registration,
                               const Simulator& simulator);
// Does the same for the surroundings of networks whose surveyed voxels were counted. Borrows all but `registration`.
EveryRayOptions count_surroundings(const RequiredInputs& needs, const RegistrationOptions& registration,
                                   const std::vector<NetworkCounts>& surveyed, const Simulator& simulator,
                                   const Simulator& surroundings);

}  // namespace vantage
