// SPDX-License-Identifier: Apache-2.0
#include "rooms.hpp"

#include <array>
#include <limits>
#include <string>

#include "support/box.hpp"

namespace vantage::test {
namespace {

SceneMesh block(const std::string& name, const Box& box, Role role) {
  SceneMesh mesh;
  mesh.name = name, mesh.role = role;
  mesh.positions = box_corners(box.min, box.max);
  for (const auto& t : box_triangles) mesh.triangles.push_back(t);
  return mesh;
}

}  // namespace

Site site_of(const Rooms& rooms) {
  SceneBuilder builder;
  const auto wall = [&](const Vec3& low, const Vec3& high) { builder.add(block("wall", {low, high}, Role::surveyed)); };
  constexpr double kHigh = 2.8, kThick = 0.2, kLong = 12.2, kDeep = 5;
  builder.add(block("floor", {{-kThick, -kThick, -0.2}, {kLong + kThick, kDeep + kThick, 0}}, Role::surveyed));
  builder.add(block("ceiling", {{-kThick, -kThick, kHigh}, {kLong + kThick, kDeep + kThick, 3}}, Role::surveyed));
  wall({-kThick, -kThick, 0}, {0, kDeep + kThick, kHigh});
  wall({kLong, -kThick, 0}, {kLong + kThick, kDeep + kThick, kHigh});
  wall({0, -kThick, 0}, {kLong, 0, kHigh});
  wall({0, kDeep, 0}, {kLong, kDeep + kThick, kHigh});
  wall({6, 0, 0}, {6.2, 2, kHigh});
  wall({6, 2.9, 0}, {6.2, kDeep, kHigh});
  wall({6, 2, 2.1}, {6.2, 2.9, kHigh});
  for (const Box& thing : rooms.things) builder.add(block("thing", thing, Role::blocking));
  if (rooms.door_closed) {
    SceneMesh leaf = block("door leaf", {{6.08, 2.01, 0.02}, {6.12, 2.89, 2.09}}, Role::blocking);
    leaf.door = true;
    builder.add(leaf);
  }
  SiteOptions options;
  options.engine = Engine::embree;
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(rooms.step_deg);
  if (rooms.noise_m > 0) scanner.noise = {.distances_m = {1}, .reflectivities = {0.5}, .sigma_m = {rooms.noise_m}};
  options.scanners = {scanner};
  options.spacing_m = 0.03;
  options.weigh_ground = false;
  return Site(builder.build(), options, "rooms");
}

TakenScan scan_at(Site& site, const Vec3& head) {
  const ScanPoints points = site.simulator().scan_points({.position = head});
  TakenScan scan{.name = "scan", .head = head, .points = points.position.size()};
  for (const Vec3& p : points.position) {
    const Vec3 offset = p - head;
    scan.thinned.push_back(
        {{static_cast<float>(offset.x), static_cast<float>(offset.y), static_cast<float>(offset.z)}, 1});
  }
  return scan;
}

TakenScan moved(TakenScan scan, const glm::dvec3& turn, const Vec3& shift) {
  const double angle = length(turn);
  const glm::dmat3 rotation = angle > 0 ? glm::mat3_cast(glm::angleAxis(angle, turn / angle)) : glm::dmat3(1);
  for (TakenPoint& point : scan.thinned) {
    const glm::dvec3 p = rotation * glm::dvec3(point.offset[0], point.offset[1], point.offset[2]);
    point.offset = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  }
  scan.head = scan.head + shift;
  return scan;
}

}  // namespace vantage::test
