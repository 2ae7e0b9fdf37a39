// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "stress/search_area_points.hpp"
#include "vantage/placement.hpp"

namespace vantage::test {
namespace {

TEST(SearchAreaPoints, OnEdgesAreFoundWhereTheEdgeIs) {
  for (const EdgePoints& edges : locate_edge_points(250'000)) {
    EXPECT_EQ(edges.lost, 0u) << edges.name;
    EXPECT_LT(edges.farthest_m, 1e-6) << edges.name;
    EXPECT_LT(edges.jump_m, 1e-6) << edges.name;
  }
}

// Two overlapping charts: the first triangle of the mesh wins everywhere, also on the edges of either.
TEST(SearchAreaPoints, OverlappingChartsGiveTheFirst) {
  SearchMesh mesh;
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0.2, 0.1}, {0.9, 0.1}, {0.9, 0.7}, {0, 0}, {1, 1}, {0, 1}};
  for (const Uv& uv : mesh.uvs) mesh.positions.push_back({10 * uv.u, 10 * uv.v, 0});
  for (std::size_t v = 3; v < 6; ++v) mesh.positions[v].z = 5;
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  const SearchArea area = SearchArea::from_mesh(mesh);
  for (int i = 0; i <= 100; ++i) {
    const double x = i / 100.0;
    for (const Uv uv : {Uv{0.2 + 0.7 * x, 0.1}, Uv{0.9, 0.1 + 0.6 * x}, Uv{0.2 + 0.7 * x, 0.1 + 0.6 * x}, Uv{x, x}}) {
      const auto found = area.locate(uv);
      ASSERT_TRUE(found) << uv.u << ", " << uv.v;
      EXPECT_EQ(found->z, 0) << uv.u << ", " << uv.v;
    }
  }
}

}  // namespace
}  // namespace vantage::test
