// SPDX-License-Identifier: Apache-2.0
#include "scan/memory_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "core/free_memory.hpp"
#include "core/glm.hpp"
#include "core/text.hpp"
#include "vantage/error.hpp"
#include "voxel/voxel_bricks.hpp"

namespace vantage {
namespace {

// By processes measured (docs/benchmarks.md, "How cost grows"). Of a voxel: its count, its share of a brick, and the
// words of its mask. Of a triangle: vertices, trees and planes.
constexpr double kProgram = 100 * 1048576.0, kTriangle = 150, kVoxel = 6, kMaskWord = 8;

struct Surface {
  double cells_m2 = 0;  // an infinite plane with the normal n meets |nx| + |ny| + |nz| cells for each face of a cell
  double extent_m = 0;
};

Surface surface_of(const SceneData& scene) {
  Surface surface;
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const auto& mesh : surveyed_triangles(scene))
    for (const Triangle& t : mesh) {
      const auto corner = [&](int k) {
        const Float3& p = scene.positions[t[static_cast<std::size_t>(k)]];
        return glm::dvec3(p.x, p.y, p.z);
      };
      const glm::dvec3 a = corner(0), b = corner(1), c = corner(2), normal = cross(b - a, c - a);
      surface.cells_m2 += 0.5 * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
      low = glm::min(low, glm::min(a, glm::min(b, c))), high = glm::max(high, glm::max(a, glm::max(b, c)));
    }
  if (surface.cells_m2 > 0) surface.extent_m = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  return surface;
}

// Equation 2: the side of a voxel.
double voxel_size(double extent_m, double user_size_m) {
  if (!(extent_m > 0)) return user_size_m;
  return extent_m / std::exp2(std::max(0.0, std::ceil(std::log2(extent_m / user_size_m))));
}

double bytes(double triangles, double voxels, std::size_t stations) {
  return kProgram + kTriangle * triangles + voxels * (kVoxel + kMaskWord * static_cast<double>(mask_words(stations)));
}

}  // namespace

MemoryEstimate estimate_memory(const Scene& scene, double user_size_m, std::size_t stations) {
  if (!(user_size_m > 0 && std::isfinite(user_size_m))) return {};
  const Surface surface = surface_of(scene.data());
  const double side = voxel_size(surface.extent_m, user_size_m), voxels = surface.cells_m2 / (side * side);
  return {.voxels = static_cast<std::uint64_t>(std::min(voxels, 1e18)),
          .bytes = static_cast<std::uint64_t>(
              std::min(bytes(static_cast<double>(scene.data().triangles.size()), voxels, stations), 1e18))};
}

void require_memory(const Scene& scene, const SimulatorConfig& config) {
  const auto free = free_memory();
  if (config.max_memory_bytes == 0 && !free) return;
  const std::uint64_t budget = config.max_memory_bytes > 0 ? config.max_memory_bytes : *free / 2;
  const MemoryEstimate wanted = estimate_memory(scene, config.user_size_m, mask_bits);
  if (wanted.bytes <= budget) return;
  std::string what =
      "this takes about " + bytes_text(wanted.bytes) + " of memory, for " + number(scene.data().triangles.size()) +
      " triangles and some " + number(wanted.voxels) + " surveyed voxels; " +
      (config.max_memory_bytes > 0 ? "it may take " + bytes_text(budget)
                                   : "half of what is free is " + bytes_text(budget) + " (max_memory_bytes, --memory)");
  for (double size = config.user_size_m; size < 1e9; size *= 2)
    if (estimate_memory(scene, size, mask_bits).bytes <= budget) {
      what += "; a user size of " + number(size) + " m would fit";
      break;
    }
  throw Error(Errc::out_of_memory, what);
}

}  // namespace vantage
