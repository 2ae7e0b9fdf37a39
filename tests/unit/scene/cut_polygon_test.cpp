// SPDX-License-Identifier: Apache-2.0
#include "scene/cut_polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr double kSlack = 1e-6;

double twice_area(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
double area(const ConvexPolygon& polygon) {
  double twice = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k) twice += twice_area(polygon[0], polygon[k - 1], polygon[k]);
  return twice / 2;
}
// True if p is left of every edge by more than `margin`, which may be negative.
bool inside(const ConvexPolygon& polygon, const PlanePoint& p, double margin) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const PlanePoint &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (length > 0 && twice_area(a, b, p) <= margin * length) return false;
  }
  return true;
}
bool in_any(const std::vector<ConvexPolygon>& polygons, const PlanePoint& p, double margin) {
  return std::ranges::any_of(polygons, [&](const ConvexPolygon& polygon) { return inside(polygon, p, margin); });
}
double area(const std::vector<ConvexPolygon>& polygons) {
  double sum = 0;
  for (const ConvexPolygon& polygon : polygons) sum += area(polygon);
  return sum;
}

ConvexPolygon random_triangle(std::mt19937& rng, double low, double high, double size) {
  std::uniform_real_distribution<double> place(low, high), offset(-size, size);
  const PlanePoint c{place(rng), place(rng)};
  ConvexPolygon t{{c.x + offset(rng), c.y + offset(rng)}, {c.x + offset(rng), c.y + offset(rng)}, c};
  if (twice_area(t[0], t[1], t[2]) < 0) std::swap(t[1], t[2]);
  return t;
}

std::vector<ConvexPolygon> cut(const ConvexPolygon& polygon, const std::vector<ConvexPolygon>& holes) {
  CutAllowance allowance;
  return cut_away(polygon, holes, kSlack, allowance);
}

TEST(CutPolygon, EveryPointOutsideTheHolesIsLeftAndNoneInside) {
  std::mt19937 rng(5);
  const ConvexPolygon whole{{0, 0}, {4, 0}, {0, 3}};
  for (const std::size_t count : {1u, 2u, 7u, 60u, 400u}) {
    for (int trial = 0; trial < 12; ++trial) {
      std::vector<ConvexPolygon> holes;
      for (std::size_t k = 0; k < count; ++k)
        holes.push_back(random_triangle(rng, -0.5, 4, 3 / std::sqrt(static_cast<double>(count))));
      const std::vector<ConvexPolygon> left = cut(whole, holes);
      std::uniform_real_distribution<double> x(0, 4), y(0, 3);
      for (int i = 0; i < 500; ++i) {
        const PlanePoint p{x(rng), y(rng)};
        if (!inside(whole, p, 2 * kSlack)) {
          if (!inside(whole, p, -2 * kSlack)) {
            EXPECT_FALSE(in_any(left, p, 0)) << "outside";
          }
          continue;
        }
        if (in_any(holes, p, 2 * kSlack)) {
          EXPECT_FALSE(in_any(left, p, 0)) << "covered: " << p.x << ' ' << p.y;
        } else if (!in_any(holes, p, -2 * kSlack)) {
          EXPECT_TRUE(in_any(left, p, 0)) << "not covered: " << p.x << ' ' << p.y;
        }
      }
    }
  }
}

TEST(CutPolygon, AMeshOverAllLeavesNothing) {
  std::vector<ConvexPolygon> mesh;
  constexpr int n = 60;
  for (int i = -12; i < n + 2; ++i)
    for (int j = -2; j < n + 2; ++j) {
      const auto at = [](int a, int b) { return PlanePoint{a * 4.0 / n + 0.01 * b, b * 3.0 / n}; };
      mesh.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  EXPECT_TRUE(cut({{0, 0}, {4, 0}, {0, 3}}, mesh).empty());
}

TEST(CutPolygon, AMeshWithAnOutlineLeavesTheRestInFewParts) {
  std::vector<ConvexPolygon> mesh;
  constexpr int n = 80;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto at = [](int a, int b) { return PlanePoint{1 + a * 1.0 / n, 0.5 + b * 1.0 / n}; };
      mesh.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  const std::vector<ConvexPolygon> left = cut({{0, 0}, {4, 0}, {4, 3}, {0, 3}}, mesh);
  EXPECT_NEAR(area(left), 12 - 1, 1e-3);
  EXPECT_LT(left.size(), 40u * n);  // out of 2 n² triangles
}

TEST(CutPolygon, ManyHolesOnOneAnotherEnd) {
  const std::vector<ConvexPolygon> holes(3000, ConvexPolygon{{0.5, 0.5}, {1, 0.5}, {0.5, 1}});
  const std::vector<ConvexPolygon> left = cut({{0, 0}, {4, 0}, {0, 3}}, holes);
  EXPECT_NEAR(area(left), 6 - 0.125, 1e-4);
  EXPECT_LT(left.size(), 20u);
}

TEST(CutPolygon, NoHolesAndHolesWithoutAreaLeaveIt) {
  const ConvexPolygon whole{{0, 0}, {4, 0}, {0, 3}};
  EXPECT_DOUBLE_EQ(area(cut(whole, {})), 6);
  EXPECT_DOUBLE_EQ(area(cut(whole, {{{1, 1}, {2, 1}, {1.5, 1}}, {{1, 1}, {1, 1}, {1, 1}}})), 6);
  EXPECT_DOUBLE_EQ(area(cut(whole, {{{5, 5}, {6, 5}, {5, 6}}})), 6);
}

// A grid of so many slits a side leaves that many squares, squared.
TEST(CutPolygon, EndsWhereItsAllowanceDoes) {
  std::vector<ConvexPolygon> slits;
  for (int k = 1; k < 40; ++k) {
    const double at = 0.1 * k;
    slits.push_back({{at, -1}, {at + 0.01, -1}, {at + 0.01, 5}, {at, 5}});
    slits.push_back({{-1, at}, {5, at}, {5, at + 0.01}, {-1, at + 0.01}});
  }
  const ConvexPolygon whole{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  EXPECT_GE(cut(whole, slits).size(), 1600u);
  CutAllowance few_parts, few_visits;
  few_parts.parts = 1000, few_visits.visits = 1000;
  for (CutAllowance* allowance : {&few_parts, &few_visits}) try {
      cut_away(whole, slits, kSlack, *allowance);
      ADD_FAILURE() << "it was cut";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Errc::out_of_memory);
    }
}

}  // namespace
}  // namespace vantage
