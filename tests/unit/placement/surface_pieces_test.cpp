// SPDX-License-Identifier: Apache-2.0
#include "placement/surface_pieces.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace vantage {
namespace {

const std::vector<glm::dvec3> square{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
const std::vector<Triangle> halves{{0, 1, 2}, {0, 2, 3}};

double total_area(const SurfacePieces& pieces) {
  double sum = 0;
  for (std::uint32_t i = 0; i < pieces.triangles.size(); ++i) sum += piece_area(pieces, i);
  return sum;
}

TEST(SurfacePieces, WhatIsAllClearStaysWhole) {
  const SurfacePieces pieces = clear_pieces(square, halves, 0.1, [](const glm::dvec3&) { return true; });
  EXPECT_EQ(pieces.triangles, halves);
  EXPECT_EQ(pieces.points.size(), square.size());
}

TEST(SurfacePieces, NothingClearGivesNothing) {
  EXPECT_TRUE(clear_pieces(square, halves, 0.1, [](const glm::dvec3&) { return false; }).triangles.empty());
}

TEST(SurfacePieces, CutsOutAHoleToTheSpacing) {
  const auto outside_disc = [](const glm::dvec3& p) { return std::hypot(p.x - 4, p.y - 5) > 2; };
  for (const double spacing : {1.0, 0.25, 0.1}) {
    const SurfacePieces pieces = clear_pieces(square, halves, spacing, outside_disc);
    EXPECT_NEAR(total_area(pieces), 100 - M_PI * 4, 4 * M_PI * 0.35 * spacing + 1e-9) << spacing;
    EXPECT_LT(pieces.triangles.size(), 60 / spacing);  // pieces accumulate only along the rim
    for (std::uint32_t i = 0; i < pieces.triangles.size(); ++i) {
      const Triangle& t = pieces.triangles[i];
      EXPECT_TRUE(outside_disc((pieces.points[t[0]] + pieces.points[t[1]] + pieces.points[t[2]]) * (1.0 / 3)) ||
                  piece_area(pieces, i) < spacing);
    }
  }
}

TEST(SurfacePieces, DoNotDependOnTheNumberOfThreads) {
  std::vector<glm::dvec3> points;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const double x = i % 50, y = i / 50;
    points.insert(points.end(), {{x, y, 0}, {x + 1, y, 0}, {x, y + 1, 0}});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const auto clear = [](const glm::dvec3& p) { return std::fmod(p.x * 1.7 + p.y * 0.9, 1.0) < 0.6; };
  const SurfacePieces all = clear_pieces(points, triangles, 0.2, clear);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const SurfacePieces alone = clear_pieces(points, triangles, 0.2, clear);
  EXPECT_EQ(all.points, alone.points);
  EXPECT_EQ(all.triangles, alone.triangles);
  EXPECT_EQ(all.source, alone.source);
}

}  // namespace
}  // namespace vantage
