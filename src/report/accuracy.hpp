// SPDX-License-Identifier: Apache-2.0
// How accurate the registered survey is, and where.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/evaluation.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Errors at 95 %, metres.
struct PlaceAccuracy {
  std::string name;    // of a room or mesh
  double mean_m = 0;   // root mean square over its seen surface
  double worst_m = 0;  // at its worst place
  double beyond = 0;   // share of its seen surface that misses the class
};
struct Accuracy {
  bool by_room = false;                    // rooms, and meshes outside of them; else meshes
  std::vector<PlaceAccuracy> places = {};  // the worst first
};

// Counts the voxels that a station sees. Empty without a registration error, or a field with its station masks.
std::optional<Accuracy> accuracy_of(const Evaluation& network, const VoxelField* field, const Simulator& simulator);

}  // namespace vantage
