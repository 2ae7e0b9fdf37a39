// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <random>

#include "placement_scenes.hpp"
#include "vantage/error.hpp"
#include "vantage/placement.hpp"

namespace vantage {
namespace {

double distance(const Vec3& a, const Vec3& b) { return std::sqrt(dot(a - b, a - b)); }

// Tests random points on random edges: each is found where the edge is, and the position is continuous across it.
void expect_edges_found(const SearchMesh& mesh, int points, unsigned seed) {
  const SearchArea area = SearchArea::from_mesh(mesh);
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  int lost = 0;
  double worst_place = 0, worst_jump = 0;
  for (int i = 0; i < points; ++i) {
    const auto& t = mesh.triangles[rng() % mesh.triangles.size()];
    const std::uint32_t a = t[rng() % 3], b = t[rng() % 3];
    const double x = i % 10 == 0 ? 0 : unit(rng);  // one in ten is a vertex
    const Uv ua = mesh.uvs[a], ub = mesh.uvs[b];
    const Uv p{ua.u + x * (ub.u - ua.u), ua.v + x * (ub.v - ua.v)};
    const auto found = area.locate(p);
    if (!found) {
      ++lost;
      continue;
    }
    const Vec3 expected = mesh.positions[a] * (1 - x) + mesh.positions[b] * x;
    worst_place = std::max(worst_place, distance(*found, expected));
    for (const Uv q : {Uv{p.u + 1e-13, p.v}, Uv{p.u - 1e-13, p.v}, Uv{p.u, p.v + 1e-13}, Uv{p.u, p.v - 1e-13}}) {
      const auto beside = area.locate(q);
      if (!beside)
        ++lost;
      else
        worst_jump = std::max(worst_jump, distance(*found, *beside));
    }
  }
  EXPECT_EQ(lost, 0);
  EXPECT_LT(worst_place, 1e-6);
  EXPECT_LT(worst_jump, 1e-6);
}

TEST(SearchArea, FindsAMillionPointsOnEdges) { expect_edges_found(test::hills(60, 50), 1'000'000, 5); }
TEST(SearchArea, FindsPointsOnTheEdgesOfSlivers) {
  expect_edges_found(test::hills(40, 5, 1e-6), 100'000, 6);
  expect_edges_found(test::hills(3, 3, 1e-9), 100'000, 7);
}
TEST(SearchArea, FindsPointsOnTheEdgesOfCoarseMeshes) { expect_edges_found(test::hills(1, 1), 20'000, 8); }

// The first call builds the tree in its own tasks. While waiting for them it must not take up another task of its
// caller, which would wait for it. Many threads, so that some of them help to build.
TEST(SearchArea, IsAskedForTheFirstTimeFromManyTasks) {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 16);
  const SearchMesh mesh = test::hills(150, 150);
  constexpr int calls = 12;  // fewer than threads
  tbb::task_arena arena(16);
  for (int round = 0; round < 10; ++round) {
    const SearchArea area = SearchArea::from_mesh(mesh);
    std::atomic<int> found = 0;
    const auto call = [&](int k) { found += area.project(mesh.positions[200 * k]).has_value(); };
    arena.execute([&] { tbb::parallel_for(0, calls, call, tbb::simple_partitioner()); });
    EXPECT_EQ(found, calls);
  }
}

TEST(SearchArea, BoundsAreInside) {
  const SearchArea area = SearchArea::from_mesh(test::hills(7, 9));
  const Uv low = area.uv_min(), high = area.uv_max();
  EXPECT_EQ(low, (Uv{0, 0}));
  EXPECT_EQ(high, (Uv{1, 1}));
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 10000; ++i) {
    const double x = i < 2 ? i : unit(rng);
    for (const Uv p : {Uv{low.u, x}, Uv{high.u, x}, Uv{x, low.v}, Uv{x, high.v}}) ASSERT_TRUE(area.locate(p));
  }
  EXPECT_FALSE(area.locate({1.001, 0.5}));
  EXPECT_FALSE(area.locate({0.5, -0.001}));
  EXPECT_FALSE(area.locate({std::nan(""), 0.5}));
}

TEST(SearchArea, HolesAreEmpty) {
  SearchMesh mesh = test::hills(10, 10);
  const auto centre = [&](const auto& t) {
    return Uv{(mesh.uvs[t[0]].u + mesh.uvs[t[1]].u + mesh.uvs[t[2]].u) / 3,
              (mesh.uvs[t[0]].v + mesh.uvs[t[1]].v + mesh.uvs[t[2]].v) / 3};
  };
  const auto removed = mesh.triangles[90];
  mesh.triangles.erase(mesh.triangles.begin() + 90);
  const SearchArea area = SearchArea::from_mesh(mesh);
  EXPECT_FALSE(area.locate(centre(removed)));
  EXPECT_TRUE(area.locate(centre(mesh.triangles[90])));
}

TEST(SearchArea, InterpolatesAsEquationSix) {
  const SearchMesh mesh{{{0, 0, 0}, {4, 0, 1}, {0, 2, 5}}, {{0.1, 0.2}, {0.9, 0.2}, {0.1, 0.7}}, {{0, 1, 2}}};
  const Vec3 p = *SearchArea::from_mesh(mesh).locate({0.1 + 0.8 * 0.25, 0.2 + 0.5 * 0.5});
  EXPECT_NEAR(p.x, 1, 1e-12);
  EXPECT_NEAR(p.y, 1, 1e-12);
  EXPECT_NEAR(p.z, 0.25 + 2.5, 1e-12);
}

TEST(SearchArea, WhereChartsOverlapTheFirstTriangleWins) {
  const SearchMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 9}, {1, 0, 9}, {0, 1, 9}},
                        {{0, 0}, {1, 0}, {0, 1}, {0, 0}, {1, 0}, {0, 1}},
                        {{3, 4, 5}, {0, 1, 2}}};
  const SearchArea area = SearchArea::from_mesh(mesh);
  for (const Uv p : {Uv{0.2, 0.2}, {0, 0}, {0.5, 0.5}, {0.5, 0}}) EXPECT_EQ(area.locate(p)->z, 9);
}

TEST(SearchArea, ProjectsToTheNearestSurfaceAboveOrBelow) {
  const SearchMesh mesh{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 9}, {1, 0, 9}, {0, 1, 9}, {0, 0, 4}, {0, 1, 4}, {0, 0, 8}},
      {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {3, 0}, {2, 1}, {4, 0}, {5, 0}, {5, 1}},
      {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}};  // the last is vertical
  const SearchArea area = SearchArea::from_mesh(mesh);
  EXPECT_EQ(*area.project({0.25, 0.25, 1}), (Uv{0.25, 0.25}));
  EXPECT_EQ(*area.project({0.25, 0.25, 4}), (Uv{0.25, 0.25}));
  EXPECT_EQ(*area.project({0.25, 0.25, 5}), (Uv{2.25, 0.25}));
  EXPECT_EQ(*area.project({0.5, 0.5, 0}), (Uv{0.5, 0.5}));
  EXPECT_FALSE(area.project({0.6, 0.6, 0}));
}

TEST(SearchArea, ProjectUndoesLocate) {
  const SearchArea area = SearchArea::from_mesh(test::hills(30, 20));
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 5000; ++i) {
    const Uv p{unit(rng), unit(rng)};
    const auto back = area.project(*area.locate(p));
    ASSERT_TRUE(back);
    ASSERT_NEAR(back->u, p.u, 1e-9);
    ASSERT_NEAR(back->v, p.v, 1e-9);
  }
}

TEST(SearchArea, TakesTheMarkedAreaWithItsOwnUv) {
  SceneData data = test::Builder().box({0, 0, 0}, {2, 2, 2}).data();
  const SearchMesh mesh = test::hills(4, 4);
  data.search_positions = mesh.positions;
  data.search_uvs = mesh.uvs;
  data.search_triangles = mesh.triangles;
  const SearchArea area = SearchArea::build(Scene(std::make_shared<const SceneData>(data)));
  EXPECT_FALSE(area.derived());
  EXPECT_NE(area.description().find("own (u, v)"), std::string::npos);
  EXPECT_EQ(area.mesh().uvs, mesh.uvs);
  EXPECT_EQ(area.locate(mesh.uvs[7])->z, mesh.positions[7].z);
}

TEST(SearchArea, RefusesMeshesThatGiveNoPlace) {
  const SearchMesh good = test::hills(2, 2);
  SearchMesh no_uv = good, flat = good, wrong_index = good;
  no_uv.uvs.pop_back();
  for (Uv& uv : flat.uvs) uv = {0.5, 0.5};
  wrong_index.triangles[1][2] = 99;
  for (const SearchMesh& mesh : {no_uv, flat, wrong_index, SearchMesh{}}) {
    try {
      SearchArea::from_mesh(mesh);
      FAIL();
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::invalid_argument);
    }
  }
}

TEST(SearchArea, TrianglesWithoutAFinitePositionAreHoles) {
  SearchMesh mesh{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, NAN}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  const SearchArea area = SearchArea::from_mesh(mesh);
  EXPECT_TRUE(area.locate({0.7, 0.3}));
  EXPECT_FALSE(area.locate({0.3, 0.7}));
  EXPECT_FALSE(area.project({0.3, 0.7, 0}));
}

}  // namespace
}  // namespace vantage
