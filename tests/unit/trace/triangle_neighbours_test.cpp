// SPDX-License-Identifier: Apache-2.0
#include "trace/triangle_neighbours.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "shared/trace_types.h"

namespace vantage {
namespace {

constexpr Float3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{0, 0, 1}, e{0, 0, -1};

// Triangles with separate vertices.
std::vector<std::uint32_t> neighbours_of(const std::vector<std::array<Float3, 3>>& corners) {
  std::vector<Float3> positions;
  std::vector<Triangle> triangles;
  for (const auto& of_triangle : corners) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    positions.insert(positions.end(), of_triangle.begin(), of_triangle.end());
    triangles.push_back({first, first + 1, first + 2});
  }
  return triangle_neighbours(positions, triangles);
}

TEST(TriangleNeighbours, OfATetrahedronAreTheOtherThree) {
  EXPECT_EQ(neighbours_of({{a, b, c}, {b, a, d}, {c, b, d}, {a, c, d}}),
            (std::vector<std::uint32_t>{1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1}));
}

TEST(TriangleNeighbours, AreNoneAtOpenEdgesAndWhereThreeMeet) {
  constexpr std::uint32_t none = no_primitive;
  EXPECT_EQ(neighbours_of({{a, b, c}}), std::vector<std::uint32_t>(3, none));
  EXPECT_EQ(neighbours_of({{a, b, c}, {a, b, d}, {a, b, e}}), std::vector<std::uint32_t>(9, none));
  EXPECT_EQ(neighbours_of({{a, b, c}, {a, b, d}}), (std::vector<std::uint32_t>{1, none, none, 0, none, none}));
}

TEST(TriangleNeighbours, DoNotLinkATriangleToItself) {
  EXPECT_EQ(neighbours_of({{a, b, a}, {b, c, d}})[0], no_primitive) << "the edge is had twice, by one triangle";
}

}  // namespace
}  // namespace vantage
