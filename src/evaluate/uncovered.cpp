// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "vantage/error.hpp"
#include "vantage/evaluate.hpp"
#include "vantage/evaluation.hpp"

namespace vantage {

UncoveredVoxels uncovered(const Simulator& simulator, const Evaluation& evaluation) {
  const std::vector<std::uint32_t>& count = evaluation.field.count;
  if (evaluation.counts.cancelled)
    throw Error(Errc::invalid_argument, "uncovered: the evaluation was stopped; evaluate again");
  if (count.size() != simulator.voxel_count())
    throw Error(Errc::invalid_argument, "uncovered: the evaluation has the points of " + std::to_string(count.size()) +
                                            " voxels, and the simulator " + std::to_string(simulator.voxel_count()) +
                                            "; evaluate on this simulator and keep the field");
  const double full = std::ceil(simulator.goal_density() * evaluation.counts.point_weight);
  UncoveredVoxels found;
  for (std::uint32_t v = 0; v < count.size(); ++v) {
    if (static_cast<double>(std::uint64_t{count[v]} * simulator.point_weight(v)) >= full) continue;
    found.voxels.push_back(v);
    found.centres.push_back(simulator.voxel_centre(v));
    found.points.push_back(count[v]);
  }
  constexpr std::size_t kAtOnce = std::size_t{1} << 20;
  found.meshes.reserve(found.voxels.size());
  for (std::size_t first = 0; first < found.voxels.size(); first += kAtOnce)
    for (const VoxelPatch& patch : simulator.voxel_patches(
             std::span(found.voxels).subspan(first, std::min(kAtOnce, found.voxels.size() - first))))
      found.meshes.push_back(patch.mesh);
  return found;
}

}  // namespace vantage
