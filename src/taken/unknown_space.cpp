// SPDX-License-Identifier: Apache-2.0
// The edge of what scans saw, where a person can be: the frontier of exploration (Yamauchi: A frontier-based approach
// for autonomous exploration, 1997).

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/parallel.hpp"
#include "scene/changed_scene.hpp"
#include "taken/depth_picture.hpp"
#include "taken/model_surface.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {
namespace {

constexpr double kUnknownCell_m = 0.25;
// Above ground: the space of a person, without what lies on the floor and hangs from the ceiling.
constexpr double kFromGround_m = 0.4, kToHead_m = 1.9;
// A place is free if a scan saw this far beyond it, and known if one saw to within this distance before it.
constexpr double kSeenBeyond_m = 0.1, kSeenBefore_m = 0.2;
// The crew stood around the tripod, where the scanner itself sees nothing.
constexpr double kTripod_m = 1.2;
// Smaller pockets of unknown space, in cells, are shadows of legs and lamps.
constexpr std::size_t kLeastUnknown = 8;

class UnknownFinder {
 public:
  UnknownFinder(Site& site, std::span<const TakenScan> scans)
      : model_(site.scene()), corner_(site.scene().bounds().min), ground_(site.area().mesh()) {
    pictures_.reserve(scans.size());
    for (const TakenScan& scan : scans) pictures_.emplace_back(scan), heads_.push_back(to_glm(scan.head));
  }

  UnknownSpace found() const {
    const std::vector<SolidCell> all = above_ground();
    std::vector<std::vector<SolidCell>> beside(all.size());
    parallel::for_all(std::size_t{0}, all.size(), [&](std::size_t k) {
      const glm::dvec3 here = middle_of(all[k]);
      if (!(most_beyond(here) > kSeenBeyond_m)) return;
      for (const auto& [x, y] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const SolidCell cell{all[k][0] + x, all[k][1] + y, all[k][2]};
        const glm::dvec3 there = middle_of(cell);
        if (most_beyond(there) > -kSeenBefore_m || !model_.passes(here, there) ||
            model_.nearest(there, kUnknownCell_m / 2))
          continue;
        beside[k].push_back(cell);
      }
    });
    std::set<SolidCell> unknown;
    for (const auto& cells : beside) unknown.insert(cells.begin(), cells.end());
    UnknownSpace space{.cell_m = kUnknownCell_m, .corner = corner_};
    drop_pockets(unknown);
    space.cells.assign(unknown.begin(), unknown.end());
    return space;
  }

 private:
  glm::dvec3 middle_of(const SolidCell& cell) const {
    return to_glm(corner_) + kUnknownCell_m * (glm::dvec3(cell[0], cell[1], cell[2]) + 0.5);
  }

  double most_beyond(const glm::dvec3& place) const {
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < pictures_.size(); ++k) {
      const glm::dvec3 from = place - heads_[k];
      if (from.z < 0 && std::hypot(from.x, from.y) < kTripod_m) return std::numeric_limits<double>::infinity();
      most = std::max(most, pictures_[k].beyond(place));
    }
    return most;
  }

  // Cells of a person's space above the ground, ascending.
  std::vector<SolidCell> above_ground() const {
    std::set<SolidCell> cells;
    const auto index = [](double value) { return static_cast<std::int32_t>(std::floor(value / kUnknownCell_m)); };
    for (const auto& triangle : ground_.triangles) {
      std::array<Vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = ground_.positions[triangle[k]] - corner_;
      const double twice = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
      if (twice == 0) continue;
      const auto [west, east] = std::minmax({p[0].x, p[1].x, p[2].x});
      const auto [south, north] = std::minmax({p[0].y, p[1].y, p[2].y});
      for (std::int32_t x = index(west); x <= index(east); ++x)
        for (std::int32_t y = index(south); y <= index(north); ++y) {
          const double u = (x + 0.5) * kUnknownCell_m, v = (y + 0.5) * kUnknownCell_m;
          const double b = ((u - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (v - p[0].y)) / twice;
          const double c = ((p[1].x - p[0].x) * (v - p[0].y) - (u - p[0].x) * (p[1].y - p[0].y)) / twice;
          if (b < 0 || c < 0 || b + c > 1) continue;
          const double z = p[0].z + b * (p[1].z - p[0].z) + c * (p[2].z - p[0].z);
          for (std::int32_t k = index(z + kFromGround_m); k <= index(z + kToHead_m); ++k) cells.insert({x, y, k});
        }
    }
    return {cells.begin(), cells.end()};
  }

  static void drop_pockets(std::set<SolidCell>& cells) {
    std::set<SolidCell> left = cells;
    while (!left.empty()) {
      std::vector<SolidCell> group{*left.begin()};
      left.erase(left.begin());
      for (std::size_t k = 0; k < group.size(); ++k)
        for (int n = 0; n < 27; ++n)
          if (const auto node = left.extract(
                  SolidCell{group[k][0] + n % 3 - 1, group[k][1] + n / 3 % 3 - 1, group[k][2] + n / 9 - 1}))
            group.push_back(node.value());
      if (group.size() < kLeastUnknown)
        for (const SolidCell& cell : group) cells.erase(cell);
    }
  }

  ModelSurface model_;
  Vec3 corner_;
  const SearchMesh& ground_;
  std::vector<DepthPicture> pictures_;  // one for each scan, as its head
  std::vector<glm::dvec3> heads_;
};

}  // namespace

UnknownSpace unknown_space(Site& site, std::span<const TakenScan> scans) { return UnknownFinder(site, scans).found(); }

}  // namespace vantage
