// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/glass_panes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "support/box.hpp"
#include "support/trace_scenes.hpp"
#include "trace/glass_faces.hpp"

namespace vantage {
namespace {

constexpr double pi = 3.141592653589793, index = 1.5;

// Transmission of a pane by adding up the beams that are reflected within it 0, 2, 4, … times, for each polarisation.
double summed(double angle) {
  const double inner = std::asin(std::sin(angle) / index);
  const double n1 = std::cos(angle), n2 = std::cos(inner);
  double all = 0;
  for (const double r : {(n1 - index * n2) / (n1 + index * n2), (index * n1 - n2) / (index * n1 + n2)}) {
    double beam = (1 - r * r) * (1 - r * r);
    for (int k = 0; k < 400; ++k, beam *= r * r * r * r) all += beam / 2;
  }
  return all;
}

TEST(GlassPanes, FollowFresnel) {
  EXPECT_NEAR(passed_of_pane(1), std::pow(2 * index / (index * index + 1), 2), 1e-12);
  EXPECT_EQ(passed_of_pane(0), 0);
  for (int degrees = 0; degrees < 89; ++degrees) {
    const double angle = degrees * pi / 180;
    EXPECT_NEAR(passed_of_pane(std::cos(angle)), std::pow(summed(angle), 2), 1e-9) << degrees;
  }
  // At Brewster's angle the one polarisation passes whole; of the other, a face reflects ((n² - 1)/(n² + 1))².
  const double brewster = std::atan(index), face = std::pow((index * index - 1) / (index * index + 1), 2);
  EXPECT_NEAR(passed_of_pane(std::cos(brewster)), std::pow((1 + (1 - face) / (1 + face)) / 2, 2), 1e-12);
}

// The mean over a hemisphere of diffuse light, 2 ∫ T cos α sin α dα.
TEST(GlassPanes, TheMeanOverAHemisphereIsFresnelsIntegral) {
  constexpr int steps = 20000;
  double own = 0, expected = 0;
  for (int k = 0; k < steps; ++k) {
    const double angle = (k + 0.5) * pi / 2 / steps, weight = std::sin(2 * angle) * pi / 2 / steps;
    own += weight * std::sqrt(passed_of_pane(std::cos(angle)));
    const double inner = std::asin(std::sin(angle) / index), n1 = std::cos(angle), n2 = std::cos(inner);
    for (const double r : {(n1 - index * n2) / (n1 + index * n2), (index * n1 - n2) / (index * n1 + n2)})
      expected += weight * (1 - r * r) / (1 + r * r) / 2;
  }
  EXPECT_NEAR(own, expected, 1e-9);
  EXPECT_GT(own, 0.8);
  EXPECT_LT(own, 0.9231);
}

// A blocking wall, then glass.
std::shared_ptr<const SceneData> behind(const std::vector<std::vector<Float3>>& panes) {
  test::SceneBuilder builder;
  builder.mesh(Role::surveyed, test::quad({5, -9, -9}, {0, 18, 0}, {0, 0, 18}));
  for (const std::vector<Float3>& pane : panes) builder.mesh(Role::blocking, pane);
  SceneData scene = *builder.finish();
  for (std::size_t m = 1; m < scene.meshes.size(); ++m) scene.meshes[m].glass = true;
  return std::make_shared<const SceneData>(std::move(scene));
}

std::vector<Float3> sheet(float x) { return test::quad({x, -8, -8}, {0, 16, 0}, {0, 0, 16}); }
std::vector<Float3> block(double x, double thick) {
  const auto corners = test::box_corners({x, -8, -8}, {x + thick, 8, 8});
  std::vector<Float3> triangles;
  for (const Triangle& t : test::box_triangles)
    for (const std::uint32_t corner : t) triangles.push_back(narrow(corners[corner]));
  return triangles;
}

double share(const std::vector<std::vector<Float3>>& panes, double angle, float t = 100) {
  const auto scene = behind(panes);
  return GlassPanes(scene, std::make_shared<Planes>(scene))
      .share({}, narrow({std::cos(angle), std::sin(angle), 0}), 0, t);
}

TEST(GlassPanes, APaneIsASheetOrASolid) {
  EXPECT_EQ(faces_of_solids(*behind({sheet(3), block(2, 0.01)})), [] {
    std::vector<bool> of_solid(14, true);
    of_solid[0] = of_solid[1] = false;
    return of_solid;
  }());
  for (const double degrees : {10.0, 40.0, 60.0}) {
    const double angle = degrees * pi / 180, pane = std::pow(summed(angle), 2);
    EXPECT_NEAR(share({sheet(3)}, angle), pane, 1e-6) << degrees;
    EXPECT_NEAR(share({block(2, 0.01)}, angle), pane, 1e-6) << degrees;
    EXPECT_NEAR(share({sheet(3), block(2, 0.01), sheet(1)}, angle), pane * pane * pane, 1e-6) << degrees;
  }
}

TEST(GlassPanes, AnEdgeOfTrianglesIsOneFaceAndCoincidentPanesAreOne) {
  const double angle = 30 * pi / 180, pane = std::pow(summed(angle), 2);
  // The ray goes through the diagonal of the sheet: level, from the middle of its height.
  const std::vector<Float3> diagonal = test::quad({3, -8, 0}, {0, 16, 0}, {0, 0, 8});
  EXPECT_NEAR(share({diagonal, test::quad({3, -8, 0}, {0, 16, 0}, {0, 0, -8})}, angle), pane, 1e-6);
  EXPECT_NEAR(share({sheet(3), sheet(3)}, angle), pane, 1e-6);
}

TEST(GlassPanes, OnlyWhatLiesBeforeTheHitCounts) {
  const double angle = 30 * pi / 180, at = 3 / std::cos(angle);
  EXPECT_EQ(share({sheet(3)}, angle, static_cast<float>(at - 1e-3)), 1);
  EXPECT_EQ(share({sheet(3)}, angle, static_cast<float>(at)), 1) << "a film on the surface";
  EXPECT_LT(share({sheet(3)}, angle, static_cast<float>(at + 1e-3)), 1);
  EXPECT_EQ(share({sheet(-3)}, angle), 1);
}

TEST(GlassPanes, APaneReturnsTheBeamNearItsNormal) {
  EXPECT_EQ(share({sheet(3)}, 0.99 * pi / 180), 0);
  EXPECT_NEAR(share({sheet(3)}, 1.01 * pi / 180), passed_of_pane(1), 1e-4);
}

}  // namespace
}  // namespace vantage
