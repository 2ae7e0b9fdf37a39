// SPDX-License-Identifier: Apache-2.0
// Coverage for the eye: surveyed voxels by the cube, coarse enough for a page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/missed.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Cubes of whole voxels, in the order in which their first voxels come. Each stands for a sample of its voxels.
struct CoverageCells {
  Vec3 corner;                         // local frame: the lower corner of cell (0, 0, 0)
  double size_m = 0;                   // their side
  std::vector<std::uint32_t> keys;     // x | y << 11 | z << 22
  std::vector<std::uint32_t> ranks;    // the sample, ascending
  std::vector<std::uint32_t> cell_of;  // of each voxel of the sample, which
  // Cells that touch cell c: neighbours[first[c]] up to neighbours[first[c + 1]].
  std::vector<std::uint32_t> first, neighbours;
  static constexpr std::uint32_t kMostAcross = 2048, kMostUp = 1023;  // cells along an axis; the last key is no cell's

  // Of a voxel of the sample, where it is in it.
  std::size_t place_of(std::uint32_t rank) const;
};

// As many cells as fit into `cells`, of at most `voxels` sampled voxels.
CoverageCells coverage_cells(const Simulator& simulator, std::uint64_t voxels, std::size_t cells);

// Who has points somewhere: 0, nobody; k, the k-th station alone; `several_stations`.
using Seer = std::uint16_t;
inline constexpr Seer several_stations = 0xFFFF;
constexpr Seer together(Seer a, Seer b) { return a == 0 || a == b ? b : b == 0 ? a : several_stations; }
// Of a voxel; 0 where the field has no masks.
Seer seer_of(const VoxelField& field, std::uint32_t rank);

// What a network left in the cells, a byte each.
struct CellColours {
  std::vector<std::uint8_t> coverage;  // mean of min(count / goal, 1) over its voxels, 0 to 254
  std::vector<std::uint8_t>
      only;  // 0: no station has a point in it; k: the k-th alone does, up to 254; 255: several, or another
};
// Of `ranks`, all of them in the sample: points and who left them. Cells without one of them are as the nearest
// is that has one.
CellColours cell_colours(const CoverageCells& cells, std::span<const std::uint32_t> ranks,
                         std::span<const std::uint32_t> counts, std::span<const Seer> seen_by,
                         const Simulator& simulator);

// The commonest reason around each cell, by `WhyMissed`, likewise. REQUIRES: ranks is not empty.
std::vector<std::uint8_t> cell_reasons(const CoverageCells& cells, std::span<const std::uint32_t> ranks,
                                       std::span<const WhyMissed> why);

}  // namespace vantage
