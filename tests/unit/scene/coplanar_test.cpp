// SPDX-License-Identifier: Apache-2.0
#include "scene/coplanar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "vantage/error.hpp"

namespace vantage {
namespace {

struct Meshes {
  std::vector<Float3> positions;
  std::vector<Triangle> triangles;
  std::vector<MeshRange> ranges;
  std::vector<MeshInfo> meshes;

  void add(Role role, const std::vector<Vec3>& corners) {
    const auto count = static_cast<std::uint32_t>(corners.size() / 3),
               base = static_cast<std::uint32_t>(positions.size());
    ranges.push_back({static_cast<std::uint32_t>(triangles.size()), count, 0});
    meshes.push_back({"mesh", role, 0.5, count});
    for (const Vec3& p : corners)
      positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    for (std::uint32_t t = 0; t < count; ++t) triangles.push_back({base + 3 * t, base + 3 * t + 1, base + 3 * t + 2});
  }
  std::vector<CoplanarPair> pairs() const { return find_coplanar(positions, triangles, ranges, meshes).pairs; }
  std::size_t count() const { return pairs().size(); }
};

// A plane with a random place and tilt, or perpendicular to an axis.
struct Plane {
  Vec3 corner, along, up, normal;
  explicit Plane(std::mt19937& rng, bool square) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const double a = square ? 0 : 3 * unit(rng), b = square ? 0 : 1.5 * unit(rng);
    corner = {5 * unit(rng), 5 * unit(rng), 5 * unit(rng)};
    along = {std::cos(a), std::sin(a), 0};
    up = {-std::sin(a) * std::sin(b), std::cos(a) * std::sin(b), std::cos(b)};
    normal = cross(along, up);
  }
  std::vector<Vec3> triangle(double x0, double y0, double x1, double y1, double x2, double y2, double lift = 0) const {
    const auto at = [&](double x, double y) { return corner + along * x + up * y + normal * lift; };
    return {at(x0, y0), at(x1, y1), at(x2, y2)};
  }
};

TEST(Coplanar, OnlyOverlapInOnePlaneCounts) {
  std::mt19937 rng(41);
  for (int k = 0; k < 200; ++k) {
    const Plane plane(rng, k % 4 == 0);
    const auto against_wall = [&](const std::vector<Vec3>& sheet) {
      Meshes scene;
      scene.add(Role::blocking, plane.triangle(0, 0, 4, 0, 0, 4));
      scene.add(Role::surveyed, sheet);
      return scene.count();
    };
    EXPECT_EQ(against_wall(plane.triangle(0.5, 0.5, 1, 0.6, 0.7, 1.3)), 1u) << "inside";
    EXPECT_EQ(against_wall(plane.triangle(-9, -7, 19, -3, 1, 18)), 1u) << "around";
    EXPECT_EQ(against_wall(plane.triangle(-1, 1, 5, 1, 5, 1.1)), 1u) << "across, without a corner in either";
    EXPECT_EQ(against_wall(plane.triangle(0.7, 1.3, 1, 0.6, 0.5, 0.5)), 1u) << "the other way round";
    EXPECT_EQ(against_wall(plane.triangle(0, 0, 4, 0, 2, -3)), 0u) << "touching along an edge";
    EXPECT_EQ(against_wall(plane.triangle(4, 0, 5, 0, 5, 1)), 0u) << "touching at a corner";
    EXPECT_EQ(against_wall(plane.triangle(3, 3, 4, 3, 3, 4)), 0u) << "beside, within the other's box";
    EXPECT_EQ(against_wall(plane.triangle(0.5, 0.5, 1, 0.6, 0.7, 1.3, 1e-4)), 0u) << "0.1 mm before it";
    std::vector<Vec3> standing = plane.triangle(0.5, 0.5, 1, 0.6, 0.7, 1.3);
    standing[2] = standing[0] + plane.normal;
    EXPECT_EQ(against_wall(standing), 0u) << "standing on it";
  }
}

TEST(Coplanar, PairsAreASurveyedAndABlockingTriangle) {
  std::mt19937 rng(43);
  const Plane plane(rng, false);
  Meshes scene;
  std::vector<Vec3> sheet;
  for (int i = 0; i < 50; ++i)
    for (const Vec3& p : plane.triangle(0.02 * i, 0.1, 0.02 * i + 0.01, 0.1, 0.02 * i, 0.2)) sheet.push_back(p);
  scene.add(Role::surveyed, sheet);
  EXPECT_EQ(scene.count(), 0u) << "nothing blocks";
  scene.add(Role::blocking, plane.triangle(-1, -1, 4, -1, -1, 4));
  scene.add(Role::blocking, plane.triangle(-1, -1, 5, -1, -1, 5));
  scene.add(Role::surveyed, plane.triangle(-3, -3, -2, -3, -3, -2));
  std::vector<CoplanarPair> expected;
  for (const std::uint32_t wall : {50u, 51u})
    for (std::uint32_t k = 0; k < 50; ++k) expected.push_back({wall, k});
  EXPECT_EQ(scene.pairs(), expected);
}

TEST(Coplanar, MorePairsThanAllowedAreRefused) {
  Meshes scene;
  for (const Role role : {Role::surveyed, Role::blocking})
    for (int k = 0; k < 10; ++k) scene.add(role, {{0, 0, 0}, {4.0 + k, 0, 0}, {0, 4, 0}});
  const auto pairs_of_at_most = [&](std::uint64_t most) {
    return find_coplanar(scene.positions, scene.triangles, scene.ranges, scene.meshes, most).pairs.size();
  };
  EXPECT_EQ(pairs_of_at_most(100), 100u);
  EXPECT_THROW(pairs_of_at_most(99), Error);
}

}  // namespace
}  // namespace vantage
