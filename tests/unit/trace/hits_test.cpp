// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/hits.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

// Triangles of consecutive hits: single ones, and runs that end anywhere in a vector.
std::vector<std::uint32_t> in_runs(RandomStream& random, std::uint32_t size, std::uint32_t triangles) {
  std::vector<std::uint32_t> of;
  while (of.size() < size) {
    const std::uint32_t run = 1 + random.bits() % 20, triangle = random.bits() % triangles;
    for (std::uint32_t k = 0; k < run && of.size() < size; ++k) of.push_back(triangle);
  }
  return of;
}

void expect_ranges_as_one_by_one(const SceneData& made) {
  const auto scene = std::make_shared<const SceneData>(made);
  const Surface surface(scene, std::make_shared<Planes>(scene));
  Scanner scanner;
  scanner.noise = rtc360_noise();
  const RangeNoise noise(std::make_shared<const NoiseModel>(make_noise_model(scanner, 3)));
  const Float3 origin{0.3f, -2, 1};
  RandomStream random(5);
  const auto hits = std::make_unique<Hits>();
  const auto rays = std::make_unique<RayBundle>();
  for (const std::uint32_t size : {0u, 1u, 7u, 8u, 9u, 100u, RayBundle::kCapacity}) {
    hits->size = 0;
    const std::vector<std::uint32_t> triangles =
        in_runs(random, size, static_cast<std::uint32_t>(scene->triangles.size()));
    const std::uint64_t first = std::uint64_t{random.bits()} << 4;  // beyond 32 bits
    for (std::uint32_t k = 0; k < size; ++k) {
      const Vec3 d{test::between(random, -1, 1), test::between(random, 0.1, 1), test::between(random, -1, 1)};
      const Float3 unit = narrow(d * (1 / std::sqrt(dot(d, d))));
      rays->x[k] = unit.x;
      rays->y[k] = unit.y;
      rays->z[k] = unit.z;
      rays->t[k] = test::between(random, 0.5, 40);
      rays->primitive[k] = triangles[k];
      hits->add(*rays, k, first + k);
    }
    find_ranges(surface, noise, origin, 4, *hits);
    for (std::uint32_t k = 0; k < size; ++k) {
      const Facet facet = surface.facet(triangles[k]);
      const Float3 d{rays->x[k], rays->y[k], rays->z[k]};
      const Vec3 normal = facet.normal(d, facet.weights(origin, d, rays->t[k]));
      const float expected = noise.displaced(rays->t[k], facet.reflectivity(d, normal), first + k, 4);
      ASSERT_EQ(std::bit_cast<std::uint32_t>(hits->range[k]), std::bit_cast<std::uint32_t>(expected))
          << k << " of " << size;
    }
  }
}

TEST(Hits, RangesOfManyAreThoseOfEach) {
  SceneData scene = *test::SceneBuilder()
                         .mesh(Role::surveyed, test::quad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}), 0.8)
                         .mesh(Role::surveyed, test::quad({-4, 1, -1}, {1, 3, 0.2f}, {0, 0.4f, 3}), 0.3)
                         .mesh(Role::surveyed, test::quad({2, 2, 0}, {0.1f, 0, 0}, {0, 1e-3f, 1}), 1.0)
                         .finish();
  expect_ranges_as_one_by_one(scene);
  RandomStream random(6);
  for (std::size_t k = 0; k < scene.positions.size(); ++k)
    scene.normals.push_back({test::between(random, -1, 1), test::between(random, -1, 1), test::between(random, -1, 1)});
  expect_ranges_as_one_by_one(scene);
  scene.normals.assign(scene.positions.size(), Float3{});  // as in a file with some normals: here those of the planes
                                                           // are used
  expect_ranges_as_one_by_one(scene);
}

TEST(Hits, RangesForVoxelsLeadToTheVoxelsOfAllRanges) {
  const auto scene = test::SceneBuilder().mesh(Role::surveyed, test::quad({-3, 3, -3}, {6, 1, 0}, {0, 2, 6})).finish();
  const VoxelGrid grid = VoxelGrid::build(*scene, 0.06);
  const Surface surface(scene, std::make_shared<Planes>(scene));
  Scanner scanner;
  scanner.noise = rtc360_noise();
  const RangeNoise noise(std::make_shared<const NoiseModel>(make_noise_model(scanner, 3)));
  const Float3 origin{0.3f, -2, 1};
  const Vec3 head = widen(origin), normal = cross(Vec3{6, 1, 0}, Vec3{0, 2, 6}), corner{-3, 3, -3};
  const double height = dot(corner - head, normal);
  RandomStream random(8);
  const auto rays = std::make_unique<RayBundle>();
  const auto some = std::make_unique<Hits>(), all = std::make_unique<Hits>();
  int moved = 0, stayed = 0;
  for (int round = 0; round < 200; ++round) {
    some->size = all->size = 0;
    // Neighbours in a row, beyond the edges of the plane too, some of which the grid does not hold.
    const double up = static_cast<double>(test::between(random, -0.8, 0.8)), from = test::between(random, -1, 0.9);
    for (std::uint32_t k = 0; k < RayBundle::kCapacity; ++k) {
      const Vec3 d{from + 4e-4 * k, 1, up};
      const Float3 unit = narrow(d * (1 / std::sqrt(dot(d, d))));
      rays->x[k] = unit.x, rays->y[k] = unit.y, rays->z[k] = unit.z;
      rays->t[k] = static_cast<float>(height / dot(widen(unit), normal));
      rays->primitive[k] = k % 2;
      some->add(*rays, k, k), all->add(*rays, k, k);
    }
    find_ranges(surface, noise, origin, 4, *some, &grid);
    find_ranges(surface, noise, origin, 4, *all);
    for (std::uint32_t k = 0; k < RayBundle::kCapacity; ++k) {
      ASSERT_EQ(grid.cell_of(some->point(origin, k)), grid.cell_of(all->point(origin, k))) << round << ", " << k;
      ++(some->range[k] == all->range[k] ? moved : stayed);
    }
  }
  EXPECT_GT(stayed, moved / 4);
  EXPECT_GT(moved, stayed / 4);
}

TEST(Hits, WithoutNoiseARangeIsTheDistance) {
  const auto scene = test::SceneBuilder().mesh(Role::surveyed, test::quad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2})).finish();
  const auto rays = std::make_unique<RayBundle>();
  const auto hits = std::make_unique<Hits>();
  rays->x[0] = rays->z[0] = 0;
  rays->y[0] = 1;
  rays->t[0] = 3;
  rays->primitive[0] = 0;
  hits->add(*rays, 0, 17);
  find_ranges(Surface(scene, std::make_shared<Planes>(scene)), RangeNoise(nullptr), {1, 0, 0}, 0, *hits);
  EXPECT_EQ(hits->range[0], 3);
  EXPECT_EQ(hits->point({1, 0, 0}, 0), (Float3{1, 3, 0}));
}

}  // namespace
}  // namespace vantage
