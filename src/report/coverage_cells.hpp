// SPDX-License-Identifier: Apache-2.0
// Coverage for display: cubes of surveyed voxels, coarse enough for a page.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/missed.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Cubes of whole voxels, in the order of their first voxels. Each stands for a sample of its voxels.
struct CoverageCells {
  Vec3 corner;                         // local frame: the lower corner of cell (0, 0, 0)
  double size_m = 0;                   // of the cubes
  std::vector<std::uint32_t> keys;     // x | y << 11 | z << 22
  std::vector<std::uint32_t> voxels;   // the sample, ascending
  std::vector<std::uint32_t> cell_of;  // cell of each voxel of the sample
  // Cells that touch cell c: neighbours[first[c]] up to neighbours[first[c + 1]].
  std::vector<std::uint32_t> first, neighbours;
  static constexpr std::uint32_t kMostAcross = 2048, kMostUp = 1023;  // cells along an axis; the last key is unused

  // Index of a voxel within the sample.
  std::size_t place_of(std::uint32_t voxel) const;
};

// Makes as many cells as fit into `cells`, from at most `voxels` sampled voxels.
CoverageCells coverage_cells(const Simulator& simulator, std::uint64_t voxels, std::size_t cells);

// Stations with points somewhere: 0, none; k, the k-th station alone; `kSeveralStations`.
using Seer = std::uint16_t;
inline constexpr Seer kSeveralStations = 0xFFFF;
constexpr Seer together(Seer a, Seer b) { return a == 0 || a == b ? b : b == 0 ? a : kSeveralStations; }
// The same for a voxel; 0 if the field has no masks.
Seer seer_of(const VoxelField& field, std::uint32_t voxel);

// Colours of a network in the cells, a byte each.
struct CellColours {
  std::vector<std::uint8_t> coverage;  // mean of min(count / goal, 1) over its voxels, 0 to 254
  std::vector<std::uint8_t>
      only;  // 0: no station has a point in it; k: the k-th alone does, up to 254; 255: several, or another
};
// Returns colours by `voxel_indices` of the sample, with their points and the stations that left them. Cells without
// such a voxel copy the nearest one that has some.
CellColours cell_colours(const CoverageCells& cells, std::span<const std::uint32_t> voxel_indices,
                         std::span<const std::uint32_t> counts, std::span<const Seer> seen_by,
                         const Simulator& simulator);

// Returns the most common reason around each cell, by `WhyMissed`, likewise. REQUIRES: voxel_indices is not empty.
std::vector<std::uint8_t> cell_reasons(const CoverageCells& cells, std::span<const std::uint32_t> voxel_indices,
                                       std::span<const VoxelStatus> status);

}  // namespace vantage
