// SPDX-License-Identifier: Apache-2.0
// The voxels that registration is predicted from where every voxel is counted. Planes of all voxels cost more than
// their counts, and a sample tells the error as well.
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/objective.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Options that count the surveyed voxels with every ray. Their sums of registration grow until these tell the error; if
// all surfaces register the scans, they only weigh it, and are of one sample.
EveryRayOptions count_surveyed(const RequiredInputs& needs, const RegistrationOptions& registration,
                               const Simulator& simulator);
// The same for the surroundings of networks whose surveyed voxels were counted. Borrows all but `registration`.
EveryRayOptions count_surroundings(const RequiredInputs& needs, const RegistrationOptions& registration,
                                   const std::vector<NetworkCounts>& surveyed, const Simulator& simulator,
                                   const Simulator& surroundings);

}  // namespace vantage
