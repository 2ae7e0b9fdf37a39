// SPDX-License-Identifier: Apache-2.0
// A wall swept through one voxel, including its faces.
#pragma once

#include "vantage/simulator.hpp"

namespace vantage::test {

struct SweepFigures {
  double least = 2, most = -1;  // coverage of the wall's own voxels
  double spread() const { return (most - least) / most; }
};
// A room whose walls fix the grid, with a wall in it perpendicular to `axis` (2: a slab). The wall moves from one voxel
// face to the next in `steps` steps, and through the seven floats around either face. The station moves along, so that
// only the voxels' cut changes.
SweepFigures sweep_wall(const EngineInfo& engine, int axis, int steps);

}  // namespace vantage::test
