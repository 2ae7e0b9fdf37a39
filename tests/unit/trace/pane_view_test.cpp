// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/pane_view.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "core/philox.hpp"
#include "support/quad_scene.hpp"
#include "trace/embree/glass_panes.hpp"

namespace vantage {
namespace {

// Panes of all sizes at random places; slivers, panes seen edge-on from the origin, coincident ones, and one around it.
std::shared_ptr<const SceneData> glasshouse() {
  test::QuadScene scene;
  RandomStream random(3);
  const auto any = [&](double size) { return static_cast<float>(size * (2 * random.uniform() - 1)); };
  scene.quad({50, -90, -90}, {0, 180, 0}, {0, 0, 180});
  for (int k = 0; k < 150; ++k) {
    const double size = std::exp(-4 * random.uniform());
    scene.quad({any(6), any(6), any(6)}, {any(size), any(size), any(size)}, {any(size), any(size), any(size)},
               Role::blocking);
  }
  for (int k = 0; k < 10; ++k)
    scene.quad({any(4), any(4), any(4)}, {any(2), any(2), any(2)}, {any(1e-4), any(1e-4), any(1e-4)}, Role::blocking);
  scene.quad({1, 0, -1}, {3, 0, 0}, {0, 0, 2}, Role::blocking);  // in a plane with the origin
  scene.quad({2, -3, -3}, {0, 6, 0}, {0, 0, 6}, Role::blocking);
  scene.quad({2, -3, -3}, {0, 6, 0}, {0, 0, 6}, Role::blocking);
  scene.quad({-1e-3f, -5, -5}, {0, 10, 0}, {0, 0, 10}, Role::blocking);
  for (std::size_t m = 1; m < scene.data().meshes.size(); ++m) scene.data().meshes[m].glass = true;
  return std::make_shared<const SceneData>(scene.data());
}

TEST(PaneView, FindsWhatTheTreeFinds) {
  const auto scene = glasshouse();
  const auto planes = std::make_shared<Planes>(scene);
  const GlassPanes glass(scene, planes);
  RandomStream random(4);
  for (const Float3 head : {Float3{0, 0, 0}, Float3{1.3f, -0.7f, 0.4f}, Float3{2, 0.1f, 0}}) {
    const auto view = glass.view(head);
    ASSERT_TRUE(view);
    std::size_t behind = 0, several = 0, unsure = 0, rays = 0;
    for (int bundle = 0; bundle < 400; ++bundle) {
      // Narrow and wide bundles, and directions along the axes and towards corners of triangles.
      Hits hits;
      hits.size = 1 + static_cast<std::uint32_t>(random.uniform() * 255);
      const double wide = std::exp(-5 * random.uniform()) * 3;
      const Vec3 middle{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
      for (std::uint32_t k = 0; k < hits.size; ++k) {
        Vec3 d = middle * (1 / std::sqrt(dot(middle, middle))) +
                 Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5} * wide;
        if (bundle % 10 == 0) {
          const auto corner = static_cast<std::size_t>(random.uniform() * static_cast<double>(scene->positions.size()));
          d = widen(scene->positions[corner]) - widen(head);
        }
        if (bundle % 37 == 0) d = {k % 3 == 0 ? 1.0 : 0.0, k % 3 == 1 ? 1.0 : 0.0, k % 3 == 2 ? -1.0 : 0.0};
        const Float3 unit = narrow(d * (1 / std::sqrt(dot(d, d))));
        hits.x[k] = unit.x, hits.y[k] = unit.y, hits.z[k] = unit.z;
        hits.t[k] = static_cast<float>(12 * random.uniform());
      }
      std::array<Passed, RayBundle::kCapacity> expected{}, found{};
      const bool by_tree = glass.follow(head, hits, nullptr, expected),
                 by_view = glass.follow(head, hits, view.get(), found);
      PaneView::Crossings crossings;
      view->find(hits, hits.t, crossings);
      for (std::uint32_t k = 0; k < hits.size; ++k) {
        const Passed none{1, RayBundle::kNoHit, 0}, a = by_tree ? expected[k] : none, b = by_view ? found[k] : none;
        EXPECT_EQ(a.share, b.share);
        EXPECT_EQ(a.pane, b.pane);
        EXPECT_EQ(a.t, b.t);
        behind += a.share < 1 ? 1 : 0;
        several += crossings.count[k] > 1 && crossings.count[k] <= PaneView::Crossings::kMost ? 1 : 0;
        unsure += crossings.count[k] == PaneView::Crossings::kUnsure ? 1 : 0;
        ++rays;
      }
    }
    EXPECT_GT(behind, rays / 5);
    EXPECT_GT(unsure, 10u);
    if (head.x == 1.3f) {  // the others lie in a pane, or a millimetre before one
      EXPECT_GT(several, rays / 50);
      EXPECT_LT(unsure, rays / 3) << "the view would be of no use";
    }
  }
}

TEST(PaneView, IsNotMadeOfTooManyFaces) {
  test::QuadScene scene;
  scene.quad({50, -90, -90}, {0, 180, 0}, {0, 0, 180});
  for (std::size_t k = 0; k <= PaneView::kMostFaces / 2; ++k)
    scene.quad({3, static_cast<float>(k), 0}, {0, 1, 0}, {0, 0, 1}, Role::blocking);
  for (std::size_t m = 1; m < scene.data().meshes.size(); ++m) scene.data().meshes[m].glass = true;
  const auto data = std::make_shared<const SceneData>(scene.data());
  EXPECT_EQ(GlassPanes(data, std::make_shared<Planes>(data)).view({0, 0, 0}), nullptr);
}

}  // namespace
}  // namespace vantage
