// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vantage/measure.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Throws Error invalid_argument for a field without the stations of every voxel.
void require_stations_of(const Simulator& simulator, const VoxelField& field);
// Predicted registration error in each of these voxels: root mean square over the stations that see it, millimetres;
// negative if none does. `field`: with station masks, of the network of `error`.
std::vector<float> voxel_errors_mm(const Simulator& simulator, const VoxelField& field, const RegistrationError& error,
                                   std::span<const std::uint32_t> voxels);
// The largest of them, or 1 where no station sees a voxel, so that it scales colours.
double largest_error_mm(std::span<const float> errors);

}  // namespace vantage
