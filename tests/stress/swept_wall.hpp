// SPDX-License-Identifier: Apache-2.0
// A wall swept through one voxel, its faces included.
#pragma once

#include "vantage/simulator.hpp"

namespace vantage::test {

struct SweepFigures {
  double least = 2, most = -1;  // coverage of the wall's own voxels
  double spread() const { return (most - least) / most; }
};
// A room whose walls hold the grid, and in it a wall square to `axis` (2: a slab) that goes from one voxel face to the
// next in `steps` steps, and through the seven floats about either face; the station goes with it, so that only the
// voxels' cut changes.
SweepFigures sweep_wall(const EngineInfo& engine, int axis, int steps);

}  // namespace vantage::test
