// SPDX-License-Identifier: Apache-2.0
#include "placement/mesh_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "placement_scenes.hpp"

namespace vantage {
namespace {

// Least distance to a triangle by nested golden-section search over its barycentric coordinates; the distance is
// convex.
double searched_distance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const auto at = [&](double s, double t) {
    const glm::dvec3 d = a + (b - a) * s + (c - a) * t - p;
    return dot(d, d);
  };
  const auto minimise = [](double low, double high, auto&& f) {
    const double golden = 0.5 * (std::sqrt(5.0) - 1);
    for (int i = 0; i < 80; ++i) {
      const double width = golden * (high - low);
      if (f(high - width) < f(low + width))
        high = low + width;
      else
        low = high - width;
    }
    return std::min({f(low), f(high), f(0.5 * (low + high))});
  };
  return std::sqrt(
      minimise(0.0, 1.0, [&](double s) { return minimise(0.0, 1 - s, [&](double t) { return at(s, t); }); }));
}

TEST(DistanceToTriangle, EqualsASearchForTheMinimum) {
  std::mt19937 rng(12);
  std::normal_distribution<double> normal;
  const auto any = [&] { return glm::dvec3{normal(rng), normal(rng), normal(rng)}; };
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 p = any(), a = any(), b = any();
    const glm::dvec3 c = i % 4 == 0 ? (a + b) * 0.5 + any() * 1e-6 : any();
    EXPECT_NEAR(distance_to_triangle(p, a, b, c), searched_distance(p, a, b, c), 1e-6);
  }
}

TEST(DistanceToTriangle, HandlesSegmentsAndPoints) {
  EXPECT_NEAR(distance_to_triangle({0, 3, 0}, {-1, 0, 0}, {0, 0, 0}, {1, 0, 0}), 3, 1e-12);
  EXPECT_NEAR(distance_to_triangle({0, 3, 4}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}), 5, 1e-12);
}

// The distance to a triangle is convex along a segment.
double searched_along(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a, const glm::dvec3& b,
                      const glm::dvec3& c) {
  double low = 0, high = 1;
  const auto at = [&](double s) { return distance_to_triangle(p + (q - p) * s, a, b, c); };
  for (int i = 0; i < 100; ++i) {
    const double third = (high - low) / 3;
    (at(low + third) < at(high - third) ? high : low) += at(low + third) < at(high - third) ? -third : third;
  }
  return std::min({at(low), at(high), at(0), at(1)});
}

TEST(DistanceToTriangle, OfASegmentEqualsASearchAlongIt) {
  std::mt19937 rng(13);
  std::normal_distribution<double> normal;
  const auto any = [&] { return glm::dvec3{normal(rng), normal(rng), normal(rng)}; };
  int crossing = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 p = any(), q = i % 10 == 0 ? p : any(), a = any(), b = any();
    const glm::dvec3 c = i % 7 == 0 ? (a + b) * 0.5 : any();
    const double distance = distance_to_triangle(p, q, a, b, c);
    EXPECT_NEAR(distance, searched_along(p, q, a, b, c), 1e-6);
    crossing += distance == 0;
  }
  EXPECT_GT(crossing, 50);
}

SceneData random_scene(std::mt19937& rng, int triangles) {
  std::uniform_real_distribution<float> unit(-20, 20), near(-1, 1);
  SceneData scene;
  for (std::uint32_t t = 0; t < static_cast<std::uint32_t>(triangles); ++t) {
    const Float3 c{unit(rng), unit(rng), unit(rng)};
    for (int k = 0; k < 3; ++k) scene.positions.push_back({c.x + near(rng), c.y + near(rng), c.z + near(rng)});
    scene.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return scene;
}

TEST(MeshTree, DistancesEqualBruteForceInDouble) {
  std::mt19937 rng(21);
  const SceneData scene = random_scene(rng, 3000);
  const MeshTree tree(scene);
  std::uniform_real_distribution<double> unit(-22, 22);
  const auto wide = [&](std::uint32_t v) {
    return glm::dvec3{scene.positions[v].x, scene.positions[v].y, scene.positions[v].z};
  };
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 p{unit(rng), unit(rng), unit(rng)};
    double expected = std::numeric_limits<double>::infinity();
    for (const Triangle& t : scene.triangles)
      expected = std::min(expected, distance_to_triangle(p, wide(t[0]), wide(t[1]), wide(t[2])));
    EXPECT_EQ(tree.distance(p, std::numeric_limits<double>::infinity()), expected);
    EXPECT_EQ(tree.distance(p, expected * 2), expected);
    EXPECT_EQ(tree.distance(p, expected * 0.5), expected * 0.5);
    EXPECT_TRUE(tree.within(p, expected * (1 + 1e-12)));
    EXPECT_FALSE(tree.within(p, expected));
  }
}

TEST(MeshTree, FindsWhatComesNearASegment) {
  std::mt19937 rng(22);
  const SceneData scene = random_scene(rng, 1000);
  const MeshTree tree(scene);
  std::uniform_real_distribution<double> unit(-22, 22), up(0, 3);
  const auto wide = [&](std::uint32_t v) {
    return glm::dvec3{scene.positions[v].x, scene.positions[v].y, scene.positions[v].z};
  };
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 p{unit(rng), unit(rng), unit(rng)}, q = p + glm::dvec3{0, 0, up(rng)};
    double nearest = std::numeric_limits<double>::infinity();
    for (const Triangle& t : scene.triangles)
      nearest = std::min(nearest, distance_to_triangle(p, q, wide(t[0]), wide(t[1]), wide(t[2])));
    EXPECT_FALSE(tree.within_of_segment(p, q, nearest));
    EXPECT_TRUE(tree.within_of_segment(p, q, nearest * (1 + 1e-9) + 1e-12));
  }
}

TEST(MeshTree, MeasuresTheDropToWhatIsBelow) {
  const MeshTree tree(test::Builder().floor(-1, -1, 1, 1, 3).floor(-1, -1, 1, 1, 1).data());
  EXPECT_NEAR(tree.drop({0.2, 0.1, 5}).value(), 2, 1e-12);
  EXPECT_NEAR(tree.drop({0.2, 0.1, 2.5}).value(), 1.5, 1e-12);
  EXPECT_FALSE(tree.drop({0.2, 0.1, 0.5}));
  EXPECT_FALSE(tree.drop({2, 0, 5}));
}

TEST(MeshTree, SeesWhatIsStraightAbove) {
  const MeshTree tree(test::Builder().floor(-1, -1, 1, 1, 3).data());
  EXPECT_TRUE(tree.covered({0, 0, 0}, 0.1, 4));
  EXPECT_FALSE(tree.covered({0, 0, 0}, 0.1, 2));
  EXPECT_FALSE(tree.covered({0, 0, 0}, 3.5, 9));
  EXPECT_FALSE(tree.covered({2, 0, 0}, 0.1, 4));
}

TEST(MeshTree, TellsSolidsFromRoomsAndRoofs) {
  const MeshTree tank(test::Builder().box({-1, -1, 0}, {1, 1, 5}).data());
  EXPECT_TRUE(tank.inside_solid({0.3, 0.2, 0.1}));
  EXPECT_FALSE(tank.inside_solid({3, 0, 0.1}));
  // A room of four thick walls and a thick ceiling.
  const MeshTree room(test::Builder()
                          .box({-3, -3, 0}, {-2, 3, 3})
                          .box({2, -3, 0}, {3, 3, 3})
                          .box({-2, -3, 0}, {2, -2, 3})
                          .box({-2, 2, 0}, {2, 3, 3})
                          .box({-3, -3, 3}, {3, 3, 3.2})
                          .data());
  EXPECT_FALSE(room.inside_solid({0, 0, 1}));
  EXPECT_TRUE(room.inside_solid({2.5, 0.1, 1}));
  EXPECT_FALSE(MeshTree(test::Builder().floor(-1, -1, 1, 1, 3).data()).inside_solid({0, 0, 0}));
}

TEST(MeshTree, OfNothingIsFarFromEverything) {
  const MeshTree tree{SceneData{}};
  EXPECT_EQ(tree.distance({0, 0, 0}, 7), 7);
  EXPECT_FALSE(tree.covered({0, 0, 0}, 0, 10));
}

}  // namespace
}  // namespace vantage
