// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "vantage/simulator.hpp"

namespace vantage {
namespace {

// Appends the rays of a chunk that hit something.
void append_hits(ScanPoints& points, const ScanChunk& chunk, const Vec3& origin, bool with_range) {
  const auto take = [](auto& to, const auto& from, std::uint64_t k) {
    if (!from.empty()) to.push_back(from[k]);
  };
  for (std::uint64_t k = 0; k < chunk.ray_count; ++k) {
    if (!std::isfinite(chunk.range_m[k])) continue;
    points.ray.push_back(chunk.first_ray + k);
    if (with_range) points.range_m.push_back(chunk.range_m[k]);
    if (!chunk.position.empty()) {
      const auto& [x, y, z] = chunk.position[k];
      points.position.push_back(origin + Vec3{x, y, z});
    }
    take(points.normal, chunk.normal, k);
    take(points.reflectivity, chunk.reflectivity, k);
    take(points.mesh, chunk.mesh, k);
    take(points.primitive, chunk.primitive, k);
    take(points.colour, chunk.colour, k);
    take(points.voxel, chunk.voxel, k);
    take(points.ghost, chunk.ghost, k);
    take(points.returns, chunk.returns, k);
    if (!chunk.returns.empty()) points.return_number.push_back(static_cast<std::uint8_t>(chunk.return_number));
  }
}

}  // namespace

ScanPoints Simulator::scan_points(const Station& station, const ScanOptions& options, const Progress& progress) {
  ScanPoints points;
  ScanOptions with_range = options;
  with_range.outputs |= scan_range;  // says which rays hit
  points.summary = scan(
      station, with_range,
      [&](const ScanChunk& chunk) { append_hits(points, chunk, origin(), (options.outputs & scan_range) != 0); },
      progress);
  return points;
}

}  // namespace vantage
