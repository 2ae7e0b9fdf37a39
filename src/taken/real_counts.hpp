// SPDX-License-Identifier: Apache-2.0
// Counts the points of scans that were taken, in surveyed voxels.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/glm.hpp"
#include "taken/model_surface.hpp"
#include "vantage/simulator.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {

// Counts as the simulator counts its own points: those on surveyed surfaces, and not at too flat an angle. A point near
// a surface counts at the surface, so that a wall built some centimetres off is captured as well.
class RealCounts {
 public:
  // `voxels`: those that are counted. Borrows the simulator.
  RealCounts(const Simulator& simulator, std::span<const std::uint32_t> voxels, double tolerance_m);

  // Returns the points in each of these voxels.
  std::vector<std::uint32_t> of(const TakenScan& scan) const;

 private:
  std::uint64_t key_of(const glm::dvec3& p) const;

  const Simulator& simulator_;
  ModelSurface model_;
  double tolerance_m_, size_m_;
  glm::dvec3 first_;  // middle of a voxel
  std::unordered_map<std::uint64_t, std::uint32_t> places_;
  std::size_t voxels_;
};

}  // namespace vantage
