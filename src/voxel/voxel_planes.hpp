// SPDX-License-Identifier: Apache-2.0
// The planes of surfaces in each voxel; a place lies on one side of each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene_data.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {

// Planes are of two kinds. Walls, boards, slabs and closed doors, with one face or two, have one in each voxel that
// they touch: flat surfaces of consecutive triangles of a mesh, wide enough to part the space on either side. Any other
// voxel whose surface lies in one direction has the plane of that surface, as on a vault of small triangles. Steps,
// furniture and pipes have no sides where their surfaces meet, since places on either side of one of their planes may
// well see the same surface beside it. Winding does not matter.
class VoxelPlanes {
 public:
  static constexpr std::size_t kMost = 4;  // of a voxel, the largest surfaces; a wall has two

  // Parallel; the result does not depend on the number of threads.
  VoxelPlanes(const SceneData& scene, const VoxelGrid& grid);

  // Returns the side of a voxel's planes on which a place lies (local frame): bit k is set behind its k-th plane.
  std::uint32_t side(std::uint64_t voxel_index, const Float3& place) const {
    std::uint32_t side = 0, bit = 1;
    for (const std::uint32_t p : of(voxel_index)) {
      const Plane& plane = planes_[p];
      const double height = plane.normal.x * static_cast<double>(place.x) +
                            plane.normal.y * static_cast<double>(place.y) +
                            plane.normal.z * static_cast<double>(place.z) - plane.offset;
      side |= height < 0 ? bit : 0;
      bit <<= 1;
    }
    return side;
  }
  // Returns a number above all sides; 1 for a voxel without planes.
  std::uint32_t sides(std::uint64_t voxel_index) const { return std::uint32_t{1} << of(voxel_index).size(); }

  struct Plane {
    Vec3 normal;        // unit
    double offset = 0;  // points p of the plane: dot(normal, p) = offset
  };

 private:
  std::span<const std::uint32_t> of(std::uint64_t voxel_index) const {
    return std::span(plane_of_).subspan(first_[voxel_index], first_[voxel_index + 1] - first_[voxel_index]);
  }

  std::vector<Plane> planes_;
  std::vector<std::uint32_t> first_, plane_of_;  // of each voxel: places in plane_of_, which hold places in planes_
};

}  // namespace vantage
