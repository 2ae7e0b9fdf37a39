// SPDX-License-Identifier: Apache-2.0
#include "taken/real_counts.hpp"

#include <cmath>

#include "core/add_saturating.hpp"
#include "core/parallel.hpp"

namespace vantage {

RealCounts::RealCounts(const Simulator& simulator, std::span<const std::uint32_t> voxels, double tolerance_m)
    : simulator_(simulator),
      model_(simulator.scene()),
      tolerance_m_(tolerance_m),
      size_m_(simulator.voxel_size_m()),
      first_(voxels.empty() ? glm::dvec3{} : to_glm(simulator.voxel_centre(voxels.front()))),
      voxels_(voxels.size()) {
  for (std::uint32_t k = 0; k < voxels.size(); ++k)
    places_.emplace(key_of(to_glm(simulator.voxel_centre(voxels[k]))), k);
}

std::uint64_t RealCounts::key_of(const glm::dvec3& p) const {
  constexpr int kBits = 21;  // grids have no more cells a side
  std::uint64_t key = 0;
  const glm::dvec3 cell = floor((p - first_) / size_m_ + 0.5);
  for (const double c : {cell.x, cell.y, cell.z})
    key = key << kBits | (static_cast<std::uint64_t>(static_cast<std::int64_t>(c)) & ((1U << kBits) - 1));
  return key;
}

std::vector<std::uint32_t> RealCounts::of(const TakenScan& scan) const {
  constexpr std::uint32_t kNowhere = ~0U;
  const glm::dvec3 head = to_glm(scan.head);
  const std::optional<Angle> limit = simulator_.max_incidence();
  std::vector<std::uint32_t> places(scan.thinned.size(), kNowhere);
  parallel::for_all(std::size_t{0}, places.size(), [&](std::size_t k) {
    const auto& o = scan.thinned[k].offset;
    const glm::dvec3 offset(o[0], o[1], o[2]), p = head + offset;
    const auto near = model_.nearest(p, tolerance_m_);
    if (!near || simulator_.scene().meshes()[near->mesh].role != Role::surveyed) return;
    if (limit && std::abs(dot(near->normal, offset)) < std::cos(limit->in_radians()) * length(offset)) return;
    if (const auto found = places_.find(key_of(near->foot(p))); found != places_.end()) places[k] = found->second;
  });
  std::vector<std::uint32_t> points(voxels_);
  for (std::size_t k = 0; k < places.size(); ++k)
    if (places[k] != kNowhere) add_saturating(points[places[k]], scan.thinned[k].points);
  return points;
}

}  // namespace vantage
