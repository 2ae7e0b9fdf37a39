// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vantage/measure.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Predicted registration error in each of these voxels: root mean square over the stations that see it, millimetres;
// negative if none does. `field`: with station masks, of the network of `error`.
std::vector<float> voxel_errors_mm(const Simulator& simulator, const VoxelField& field, const RegistrationError& error,
                                   std::span<const std::uint32_t> voxels);

}  // namespace vantage
