// SPDX-License-Identifier: Apache-2.0
#include "voxel/triangle_walk.hpp"

#include <algorithm>
#include <cmath>

#include "core/glm.hpp"

namespace vantage {
namespace {

// Large enough to make handing out a piece cheap, small enough that all threads end together.
constexpr double cells_a_piece = 1 << 16;
// Least number of steps, for work of a second or more.
constexpr double steps = 64, least_cells_a_step = 1 << 25;
constexpr double own_cells = 4;  // fixed cost of a triangle, in cells

}  // namespace

TriangleWalk::TriangleWalk(std::span<const Float3> positions, std::span<const std::span<const Triangle>> meshes,
                           const GridTransform& grid)
    : positions_(positions), meshes_(meshes) {
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    Piece open{m, 0, 0, 0};
    const auto close = [&] {
      if (open.end > open.first) pieces_.push_back(open);
      open = {m, open.end, open.end, 0};
    };
    for (std::size_t t = 0; t < meshes[m].size(); ++t) {
      const auto c = grid.corners(positions, meshes[m][t]);
      const glm::dvec3 a = glm::make_vec3(c[0].data());
      const double area = 0.5 * length(cross(glm::make_vec3(c[1].data()) - a, glm::make_vec3(c[2].data()) - a));
      area_ += area;
      if (area > 2 * cells_a_piece) {
        close();
        // Caps the pieces; an excessive area is rejected before it is walked.
        const auto parts = static_cast<std::int64_t>(std::min(std::ceil(area / cells_a_piece), 1e6));
        for (std::int64_t part = 0; part < parts; ++part)
          pieces_.push_back({m, t, t + 1, area / static_cast<double>(parts), part, parts});
        open = {m, t + 1, t + 1, 0};
        continue;
      }
      open.end = t + 1;
      open.area += area + own_cells;
      if (open.area > cells_a_piece) close();
    }
    close();
  }
  for (const Piece& piece : pieces_) total_ += piece.area;
  step_ = std::max(total_ / steps, least_cells_a_step);
}

}  // namespace vantage
