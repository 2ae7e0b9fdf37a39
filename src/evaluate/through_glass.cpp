// SPDX-License-Identifier: Apache-2.0
#include "evaluate/through_glass.hpp"

#include <algorithm>

#include "vantage/error.hpp"

namespace vantage {

void look_through_glass(Evaluation& evaluation, const Simulator& simulator, const Progress& progress) {
  constexpr std::uint64_t kVoxels = 20'000;
  if (evaluation.scan_overlap_matrix.size() == 0) return;
  if (std::ranges::none_of(simulator.scene().meshes(), &MeshInfo::glass)) return;
  if (evaluation.links()->gaps.empty() || progress.stopped()) return;
  try {
    Simulator around = surroundings_of(simulator, true);
    const Network network = to_network(evaluation.stations);
    const NetworkCounts counts = around.evaluate_sampled(
        {&network, 1}, {.voxels = kVoxels, .count_to = CountTo::one, .groups = false}, {.stop = progress.stop})[0];
    if (!counts.cancelled) evaluation.through_glass = scan_overlap_matrix(counts);
  } catch (const Error& error) {
    if (error.code() != Errc::out_of_memory) throw;
  }
}

}  // namespace vantage
