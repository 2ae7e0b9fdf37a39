// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "vantage/candidates.hpp"
#include "vantage/cover.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// A column for what each station sees of a sample of the surroundings: elements are the sides of its voxels, so what
// two columns have in common is what the stations share. A stopped call has columns of the first stations.
CoverageMatrix sample_seen(Simulator& surroundings, std::span<const PlacedStation> stations,
                           std::uint64_t sample_voxels, const Progress& progress);

}  // namespace vantage
