// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "map/buildings.hpp"
#include "map/plan_levels.hpp"
#include "placement/triangle_parts.hpp"
#include "vantage/summary.hpp"

namespace vantage {
namespace {

// A part of the search area, which is in one floor part or another.
struct GroundPart {
  Vec3 middle;
  double area_m2 = 0;  // in plan
};

// The triangles of a search area, or parts of them: a marked area may have triangles larger than rooms.
std::vector<GroundPart> ground_of(const SearchMesh& mesh, bool in_parts) {
  std::vector<GroundPart> out;
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const double area = std::abs(cross(b - a, c - a).z) / 2;
    if (in_parts)
      for_triangle_parts(a, b, c, [&](const Vec3& middle, double share) { out.push_back({middle, share * area}); });
    else
      out.push_back({(a + b + c) * (1.0 / 3), area});
  }
  return out;
}

// Sums up the ground that a part holds; its place is the ground nearest to the middle of that.
template <class Holds>
void take_ground(FloorPart& part, std::span<const GroundPart> ground, const Holds& holds) {
  Vec3 sum;
  for (const auto& [at, area] : ground)
    if (holds(at)) part.area_m2 += area, sum = sum + at * area;
  if (!(part.area_m2 > 0)) return;
  const Vec3 middle = sum * (1 / part.area_m2);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [at, area] : ground)
    if (const double away = dot(at - middle, at - middle); away < least && holds(at)) least = away, part.place = at;
}

bool in_room(const Room& room, const Vec3& ground) {
  constexpr double kSkin_m = 0.3;  // a floor may lie below its room's box
  return ground.x >= room.box.min.x && ground.x <= room.box.max.x && ground.y >= room.box.min.y &&
         ground.y <= room.box.max.y && ground.z >= room.box.min.z - kSkin_m && ground.z < room.box.max.z;
}

}  // namespace

std::string to_string(FloorPart::Kind kind) {
  return kind == FloorPart::Kind::storey ? "storey" : kind == FloorPart::Kind::building ? "building" : "room";
}

std::vector<FloorPart> floor_parts(const Scene& scene, const SearchArea& area,
                                   std::span<const PlacedStation> stations) {
  const SearchMesh& mesh = area.mesh();
  std::vector<GroundPart> pieces = ground_of(mesh, false);
  std::vector<FloorPart> parts;
  const auto add = [&](FloorPart part, const auto& holds) {
    take_ground(part, pieces, holds);
    part.stations = static_cast<std::size_t>(
        std::ranges::count_if(stations, [&](const PlacedStation& s) { return active(s) && holds(s.ground); }));
    parts.push_back(std::move(part));
  };
  const std::vector<PlanLevel> levels = plan_levels(mesh, stations);
  for (std::size_t k = 0; k < levels.size() && levels.size() > 1; ++k)
    add({.kind = FloorPart::Kind::storey, .name = "storey " + std::to_string(k + 1)},
        [&](const Vec3& ground) { return levels[k].holds(ground.z); });
  if (const BuildingMap buildings = buildings_of(scene, mesh); buildings.count > 1)
    for (std::uint32_t k = 1; k <= buildings.count; ++k)
      add({.kind = FloorPart::Kind::building, .name = "building " + std::to_string(k)},
          [&](const Vec3& ground) { return buildings.at(ground) == k; });
  if (!scene.rooms().empty()) pieces = ground_of(mesh, true);
  for (const Room& room : scene.rooms())
    add({.kind = FloorPart::Kind::room,
         .name = room.name,
         .place = {(room.box.min.x + room.box.max.x) / 2, (room.box.min.y + room.box.max.y) / 2, room.box.min.z}},
        [&](const Vec3& ground) { return in_room(room, ground); });
  return parts;
}

}  // namespace vantage
