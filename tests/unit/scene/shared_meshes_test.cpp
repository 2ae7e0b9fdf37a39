// SPDX-License-Identifier: Apache-2.0
// A mesh that several nodes place gives the same scene whether it is stored once or at each of its places.
#include "scene/shared_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "placement/mesh_tree.hpp"
#include "scene/sound_triangle.hpp"
#include "scene/surface_colour.hpp"
#include "support/boxes_on_ground.hpp"
#include "support/glb_builder.hpp"
#include "vantage/error.hpp"
#include "vantage/objective.hpp"
#include "vantage/placement.hpp"
#include "vantage/simulator.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {
namespace {

using nlohmann::json;
using test::GlbBuilder;
using test::load;

constexpr int kUnsignedShort = 5123;

// A bumpy plate of quads with normals, texture coordinates and colours, in glTF axes.
int bumpy_plate(GlbBuilder& builder, int quads) {
  std::vector<float> positions, normals, texcoords, colours;
  std::vector<std::uint16_t> indices;
  for (int j = 0; j <= quads; ++j)
    for (int i = 0; i <= quads; ++i) {
      const double u = static_cast<double>(i) / quads, v = static_cast<double>(j) / quads;
      for (const double p : {1.37 * u - 0.5, 0.21 * std::sin(7 * u) * std::cos(5 * v) + 0.4, 1.19 * v - 0.6})
        positions.push_back(static_cast<float>(p));
      for (const double n : {-0.3 * std::cos(7 * u), 1.0, 0.2 * std::sin(5 * v)})
        normals.push_back(static_cast<float>(n));
      for (const double t : {u, v}) texcoords.push_back(static_cast<float>(t));
      for (const double c : {u, 0.5, v}) colours.push_back(static_cast<float>(c));
    }
  for (int j = 0; j < quads; ++j)
    for (int i = 0; i < quads; ++i) {
      const auto at = [&](int a, int b) { return static_cast<std::uint16_t>(b * (quads + 1) + a); };
      for (const std::uint16_t v : {at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)})
        indices.push_back(v);
    }
  return builder.mesh({{"attributes",
                        {{"POSITION", builder.positions(positions)},
                         {"NORMAL", builder.accessor(normals, 5126, "VEC3")},
                         {"TEXCOORD_0", builder.accessor(texcoords, 5126, "VEC2")},
                         {"COLOR_0", builder.accessor(colours, 5126, "VEC3")}}},
                       {"indices", builder.accessor(indices, kUnsignedShort, "SCALAR")}});
}

// Far from the origin, with two meshes of which one is placed turned, scaled, mirrored and by instancing; and a ground.
GlbBuilder site() {
  GlbBuilder builder;
  builder.json["asset"]["extras"]["vantage"] = json::object();  // in metres, Y up
  const int plate = bumpy_plate(builder, 9), single = bumpy_plate(builder, 4);
  const int site = builder.node({{"name", "site"}, {"translation", {4123.7, 31.2, -887.4}}});
  builder.child(site, {{"name", "first"}, {"mesh", plate}, {"translation", {0.3, 1, 0.2}}});
  builder.child(site, {{"name", "turned"},
                       {"mesh", plate},
                       {"translation", {3.1, 1.3, 2.2}},
                       {"rotation", {0.182574, 0.365148, 0.547723, 0.730297}}});
  builder.child(site, {{"name", "alone"}, {"mesh", single}, {"translation", {-2.2, 1.1, 0.7}}});
  builder.child(site,
                {{"name", "mirrored"}, {"mesh", plate}, {"translation", {-1, 2, -3}}, {"scale", {-1.1, 0.9, 1.4}}});
  json row{{"name", "row"}, {"mesh", plate}, {"translation", {0, 0.7, 5}}};
  const int places = builder.accessor(std::vector<float>{0, 0, 0, 1.9F, 0.1F, 0.3F, 3.7F, 0.2F, -0.4F}, 5126, "VEC3");
  row["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", places}};
  builder.child(site, row);
  const int ground =
      builder.mesh({{"attributes",
                     {{"POSITION", builder.positions({-8, 0, -8, -8, 0, 9, 9, 0, -8, 9, 0, -8, -8, 0, 9, 9, 0, 9})}}}});
  builder.child(site, {{"name", "ground"}, {"mesh", ground}});
  return builder;
}

Scene loaded(const GlbBuilder& builder, SharedMeshes shared) { return load(builder, {.shared_meshes = shared}); }

TEST(SharedMeshes, EveryCornerHasTheSameBits) {
  const Scene once = loaded(site(), SharedMeshes::always), each = loaded(site(), SharedMeshes::never);
  const SceneData &a = once.data(), &b = each.data();
  ASSERT_TRUE(a.shares());
  ASSERT_FALSE(b.shares());
  EXPECT_LT(a.triangles.size(), b.triangles.size() / 2);
  ASSERT_EQ(a.triangle_count(), b.triangle_count());
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.local_bounds.min, b.local_bounds.min);
  EXPECT_EQ(a.local_bounds.max, b.local_bounds.max);
  ASSERT_EQ(a.ranges.size(), b.ranges.size());
  for (std::size_t m = 0; m < a.ranges.size(); ++m) {
    EXPECT_EQ(a.ranges[m].first_triangle, b.ranges[m].first_triangle);
    EXPECT_EQ(a.ranges[m].triangle_count, b.ranges[m].triangle_count);
    EXPECT_EQ(a.meshes[m].triangle_count, b.meshes[m].triangle_count);
    EXPECT_EQ(a.meshes[m].name, b.meshes[m].name);
  }
  for (std::uint32_t t = 0; t < a.triangle_count(); ++t) {
    ASSERT_EQ(a.corners(t), b.corners(t)) << "triangle " << t;
    ASSERT_EQ(a.corner_normals(t), b.corner_normals(t)) << "triangle " << t;
    const std::uint32_t mesh = a.mesh_of(t);
    ASSERT_EQ(surface_colour(a, mesh, t, {0.2F, 0.3F}), surface_colour(b, mesh, t, {0.2F, 0.3F})) << "triangle " << t;
  }
  EXPECT_EQ(std::vector(once.notes().begin(), once.notes().end()),
            std::vector(each.notes().begin(), each.notes().end()));
}

TEST(SharedMeshes, FlattenedIsWhatNothingShared) {
  const Scene once = loaded(site(), SharedMeshes::always), each = loaded(site(), SharedMeshes::never);
  const auto flat = flattened(std::make_shared<const SceneData>(once.data()));
  ASSERT_FALSE(flat->shares());
  ASSERT_EQ(flat->triangles.size(), each.data().triangles.size());
  for (std::uint32_t t = 0; t < flat->triangle_count(); ++t) {
    ASSERT_EQ(flat->corners(t), each.data().corners(t));
    ASSERT_EQ(flat->corner_normals(t), each.data().corner_normals(t));
    ASSERT_EQ(surface_colour(*flat, flat->mesh_of(t), t, {0.1F, 0.6F}),
              surface_colour(each.data(), flat->mesh_of(t), t, {0.1F, 0.6F}));
  }
  EXPECT_EQ(flat->normals.size(), flat->positions.size());
}

// Glass is stored where it stands, and its triangles have numbers behind those of all places.
TEST(SharedMeshes, StandBehindGlass) {
  GlbBuilder builder = site();
  const int pane = builder.mesh(
      {{"attributes",
        {{"POSITION", builder.positions({-6, 0, 1.5, 6, 0, 1.5, 6, 3, 1.5, -6, 0, 1.5, 6, 3, 1.5, -6, 3, 1.5})}}}});
  builder.node({{"name", "pane"}, {"mesh", pane}, {"translation", {4123.7, 31.2, -887.4}}});
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(0.5);
  scanner.min_range_m = 0.1;
  scanner.detection_range_m = 5;
  scanner.detection_reflectivity = 0.5;
  const Network network{{{4124.7, 884.4, 32.8}}, {{4123.1, 889.2, 33.1}}};
  for (const Engine engine : {Engine::embree, Engine::compute_bvh, Engine::ray_query}) {
    std::vector<NetworkCounts> counts;
    for (const SharedMeshes shared : {SharedMeshes::always, SharedMeshes::never}) {
      const Scene scene = load(builder, {.glass = {"pane"}, .shared_meshes = shared});
      ASSERT_EQ(scene.data().shares(), shared == SharedMeshes::always);
      ASSERT_TRUE(scene.data().has_glass());
      Simulator simulator(scene, scanner, {.engine = engine, .user_size_m = 0.1});
      counts.push_back(simulator.evaluate(network));
    }
    ASSERT_EQ(counts[0].dropped.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_GT(counts[0].dropped[k].echo, 100u) << to_string(engine);
      EXPECT_NEAR(static_cast<double>(counts[0].dropped[k].echo), static_cast<double>(counts[1].dropped[k].echo), 3);
      EXPECT_NEAR(static_cast<double>(counts[0].points_on_surveyed[k]),
                  static_cast<double>(counts[1].points_on_surveyed[k]), 3);
    }
    EXPECT_NEAR(coverage(counts[0], 1), coverage(counts[1], 1), 1e-4);
  }
}

TEST(SharedMeshes, SmallScenesShareNothingUnasked) { EXPECT_FALSE(load(site()).data().shares()); }

TEST(SharedMeshes, VoxelsAreTheSame) {
  const Scene once = loaded(site(), SharedMeshes::always), each = loaded(site(), SharedMeshes::never);
  const VoxelGrid a = VoxelGrid::build(once.data(), 0.11), b = VoxelGrid::build(each.data(), 0.11);
  EXPECT_EQ(a.min(), b.min());
  ASSERT_EQ(a.size(), b.size());
  for (std::uint64_t v = 0; v < a.size(); ++v) ASSERT_EQ(a.key(v), b.key(v));
}

TEST(SharedMeshes, DistancesAndClashesAreTheSame) {
  const Scene once = loaded(site(), SharedMeshes::always), each = loaded(site(), SharedMeshes::never);
  const MeshTree a(once.data()), b(each.data());
  const Box& box = each.data().local_bounds;
  std::size_t near = 0;
  for (int k = 0; k < 4000; ++k) {
    const auto share = [&](double step) { return std::fmod(0.5 + k * step, 1.0); };
    const glm::dvec3 p{box.min.x + box.size().x * share(0.754877666), box.min.y + box.size().y * share(0.569840291),
                       box.min.z - 0.5 + (box.size().z + 1) * share(0.419716041)};
    ASSERT_EQ(a.distance(p, 2), b.distance(p, 2)) << "point " << k;
    ASSERT_EQ(a.within(p, 0.4), b.within(p, 0.4)) << "point " << k;
    const auto found = a.nearest(p, 0.7), wanted = b.nearest(p, 0.7);
    ASSERT_EQ(found.has_value(), wanted.has_value());
    near += found.has_value();
    ASSERT_EQ(a.within_of_segment(p, p + glm::dvec3{0.3, 0.2, 1}, 0.2),
              b.within_of_segment(p, p + glm::dvec3{0.3, 0.2, 1}, 0.2));
    const auto down = a.drop(p), down_too = b.drop(p);
    ASSERT_EQ(down.has_value(), down_too.has_value()) << "point " << k;
    if (down) {
      ASSERT_NEAR(*down, *down_too, 1e-4) << "point " << k;
    }
  }
  EXPECT_GT(near, 500u);
}

// A ball around a point is as large in the frame of a mesh as its scale makes it.
TEST(SharedMeshes, DistancesToScaledMeshesAreTheSame) {
  GlbBuilder builder = site();
  const auto add = [&](const char* name, const std::vector<double>& at, const std::vector<double>& scale) {
    builder.child(0, {{"name", name},
                      {"mesh", 0},
                      {"translation", at},
                      {"rotation", {0.182574, 0.365148, 0.547723, 0.730297}},
                      {"scale", scale}});
  };
  add("in centimetres", {1, 4, 3}, {0.01, 0.01, 0.01});
  add("in millimetres", {-2, 4, 1}, {0.001, 0.001, 0.001});
  add("uneven", {2, 5, -3}, {0.002, 0.3, 0.05});
  add("large", {0, 30, 0}, {40, 40, 40});
  const Scene once = loaded(builder, SharedMeshes::always), each = loaded(builder, SharedMeshes::never);
  const MeshTree a(once.data()), b(each.data());
  std::size_t near = 0;
  for (const glm::dvec3& glTF :
       {glm::dvec3{1, 4, 3}, glm::dvec3{-2, 4, 1}, glm::dvec3{2, 5, -3}, glm::dvec3{0, 30, 0}}) {
    const glm::dvec3 survey(4123.7 + glTF.x, 887.4 - glTF.z, 31.2 + glTF.y);
    const glm::dvec3 middle = survey - to_glm(each.data().origin);
    for (int k = 0; k < 300; ++k) {
      const auto share = [&](double step) { return std::fmod(0.5 + k * step, 1.0) - 0.5; };
      const glm::dvec3 p = middle + 2.0 * glm::dvec3(share(0.754877666), share(0.569840291), share(0.419716041));
      ASSERT_EQ(a.distance(p, 2), b.distance(p, 2)) << "point " << k;
      ASSERT_EQ(a.within(p, 0.3), b.within(p, 0.3)) << "point " << k;
      ASSERT_EQ(a.within_of_segment(p, p + glm::dvec3{0.3, 0.2, 1}, 0.2),
                b.within_of_segment(p, p + glm::dvec3{0.3, 0.2, 1}, 0.2));
      near += a.within(p, 0.3);
    }
  }
  EXPECT_GT(near, 10u) << "points near a mesh, and far from all";
}

TEST(SharedMeshes, AGroundIsTheSame) {
  const Scene once = loaded(site(), SharedMeshes::always), each = loaded(site(), SharedMeshes::never);
  const auto area = [](const Scene& scene) {
    const SearchArea ground = SearchArea::build(scene);
    double sum = 0;
    for (const auto& t : ground.mesh().triangles) {
      const auto p = [&](std::size_t k) { return ground.mesh().positions[t[k]]; };
      const Vec3 n = cross(p(1) - p(0), p(2) - p(0));
      sum += 0.5 * std::sqrt(dot(n, n));
    }
    return sum;
  };
  const double wanted = area(each);
  EXPECT_GT(wanted, 50);
  EXPECT_NEAR(area(once), wanted, 1e-6 * wanted);
}

TEST(SharedMeshes, BrokenTrianglesGoEverywhere) {
  GlbBuilder builder;
  builder.json["asset"]["extras"]["vantage"] = json::object();
  const float nan = std::nanf("");
  // Sound, without area, not finite, and the first once more.
  const int mesh = builder.mesh(
      {{"attributes", {{"POSITION", builder.positions({0, 0, 0, 1,   0, 0, 0, 1, 0,  //
                                                       0, 0, 0, 1,   0, 0, 2, 0, 0,  //
                                                       0, 0, 0, nan, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0})}}}});
  for (const double x : {0.0, 5.0, 5.0}) builder.node({{"mesh", mesh}, {"translation", {x, 0, 0}}});
  const Scene once = loaded(builder, SharedMeshes::always), each = loaded(builder, SharedMeshes::never);
  EXPECT_EQ(once.triangle_count(), 2u);
  ASSERT_EQ(each.triangle_count(), 2u);
  for (std::uint32_t t = 0; t < 2; ++t) EXPECT_EQ(once.data().corners(t), each.data().corners(t));
  EXPECT_EQ(once.meshes().size(), each.meshes().size());
  const auto has = [](const Scene& scene, const char* text) {
    return std::ranges::any_of(scene.notes(),
                               [&](const std::string& note) { return note.find(text) != std::string::npos; });
  };
  for (const Scene* scene : {&once, &each})
    for (const char* text :
         {"3 triangles with a vertex that is not finite", "3 triangles without area", "exact duplicates"})
      EXPECT_TRUE(has(*scene, text)) << text;
}

TEST(SharedMeshes, AMeshBeyondWhatIsSoundIsStoredThere) {
  GlbBuilder builder;
  builder.json["asset"]["extras"]["vantage"] = json::object();
  const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.positions({0, 0, 0, 1, 0, 0, 0, 1, 0})}}}});
  for (const double x : {0.0, 5.0, 2e9}) builder.node({{"mesh", mesh}, {"translation", {x, 0, 0}}});
  const Scene once = loaded(builder, SharedMeshes::always);
  EXPECT_EQ(once.triangle_count(), 2u);
  EXPECT_LT(once.bounds().max.x, 10);
}

TEST(SharedMeshes, AMeshIsStoredWhereRaysCannotBeMovedIntoItsFrame) {
  GlbBuilder builder;
  builder.json["asset"]["extras"]["vantage"] = json::object();
  const int plate = bumpy_plate(builder, 9);
  // The third is flattened, the fourth much longer than wide; the last two are as unequal as may be, and in
  // millimetres.
  const std::vector<std::vector<double>> scales{{1, 1, 1},  {-1, 1, 1}, {1, 1, 0},
                                                {30, 1, 1}, {1, 15, 1}, {1e-3, 1e-3, 1e-3}};
  for (std::size_t k = 0; k < scales.size(); ++k)
    builder.node({{"mesh", plate}, {"translation", {3.0 * static_cast<double>(k), 0, 0}}, {"scale", scales[k]}});
  const Scene once = loaded(builder, SharedMeshes::always), each = loaded(builder, SharedMeshes::never);
  ASSERT_EQ(once.triangle_count(), each.triangle_count());
  EXPECT_EQ(once.data().places.size(), 4u);
  for (std::uint32_t m = 0; m < scales.size(); ++m) {
    const std::uint32_t first = once.data().ranges[m].first_triangle;
    EXPECT_EQ(once.data().instance_of(first).place == MeshInstance::kNoPlace, m == 2 || m == 3) << "node " << m;
  }
  for (std::uint32_t t = 0; t < once.triangle_count(); ++t)
    ASSERT_EQ(once.data().corners(t), each.data().corners(t)) << "triangle " << t;
}

TEST(SharedMeshes, UnitsAndAxesAreTheSame) {
  GlbBuilder builder = site();
  builder.json["asset"].erase("extras");
  for (const auto& [unit, up] : {std::pair(Unit::metre, UpAxis::z), std::pair(Unit::foot, UpAxis::x)}) {
    const Scene once = load(builder, {.unit = unit, .up = up, .shared_meshes = SharedMeshes::always}),
                each = load(builder, {.unit = unit, .up = up, .shared_meshes = SharedMeshes::never});
    ASSERT_TRUE(once.data().shares());
    ASSERT_EQ(once.triangle_count(), each.triangle_count());
    for (std::uint32_t t = 0; t < once.triangle_count(); ++t) {
      const auto a = once.data().corners(t), b = each.data().corners(t);
      for (std::size_t k = 0; k < 3; ++k) {  // a product more or less may round otherwise, in double
        ASSERT_NEAR(a[k].x, b[k].x, 1e-6);
        ASSERT_NEAR(a[k].y, b[k].y, 1e-6);
        ASSERT_NEAR(a[k].z, b[k].z, 1e-6);
      }
    }
  }
}

TEST(SharedMeshes, DoorsAreOpenedAtEachPlace) {
  GlbBuilder builder;
  const int plate = bumpy_plate(builder, 6);
  for (const double x : {0.0, 5.0}) builder.node({{"name", "plate"}, {"mesh", plate}, {"translation", {x, -0.5, 0}}});
  std::vector<float> leaf;
  for (const float z : {0.0F, 0.05F})
    for (const float corner : {0.0F, 0.0F, 0.9F, 0.0F, 0.9F, 2.0F, 0.0F, 0.0F, 0.9F, 2.0F, 0.0F, 2.0F}) {
      leaf.push_back(corner);
      if (leaf.size() % 3 == 2) leaf.push_back(z);
    }
  const int door = builder.mesh({{"attributes", {{"POSITION", builder.positions(leaf)}}}});
  for (const int k : {1, 2, 3})
    builder.node({{"name", "door " + std::to_string(k)}, {"mesh", door}, {"translation", {16 + 4 * k, 0, 0}}});
  const SceneOptions once{.unit = Unit::metre, .up = UpAxis::y, .shared_meshes = SharedMeshes::always};
  const Scene scene = load(builder, once);
  EXPECT_TRUE(scene.data().shares());
  EXPECT_EQ(scene.triangle_count(), 2u * 72);
  ASSERT_FALSE(scene.notes().empty());
  EXPECT_NE(scene.notes().back().find("3 doors are taken as open"), std::string::npos) << scene.notes().back();
}

// Corners of all triangles of a mesh in ascending order, whatever the order of the triangles.
std::vector<std::array<Float3, 3>> sorted_triangles(const Scene& scene, std::size_t mesh) {
  const SceneData& data = scene.data();
  std::vector<std::array<Float3, 3>> all;
  for (std::uint32_t k = 0; k < data.ranges[mesh].triangle_count; ++k) {
    const auto corners = data.corners(data.ranges[mesh].first_triangle + k);
    all.push_back(sorted_corners(corners, {0, 1, 2}));
  }
  std::ranges::sort(all, [](const auto& a, const auto& b) {
    for (std::size_t k = 0; k < 3; ++k)
      if (a[k] != b[k]) return comes_before(a[k], b[k]);
    return false;
  });
  return all;
}

// Patterns of surveyed meshes; all others block.
const std::vector<std::vector<std::string>> kSurveyed{{"ground"}, {"box *"}, {"box 0", "box 4"}, {"ground", "box 1"}};

TEST(SharedMeshes, SurfacesOfBothRolesInOnePlaneAreCutAtEachPlace) {
  for (const auto& surveyed : kSurveyed) {
    SCOPED_TRACE(surveyed.back());
    SceneOptions options{.surveyed = surveyed, .shared_meshes = SharedMeshes::always};
    const Scene once = load(test::boxes_on_ground(), options);
    options.shared_meshes = SharedMeshes::never;
    const Scene each = load(test::boxes_on_ground(), options);
    ASSERT_TRUE(once.data().shares());
    EXPECT_EQ(once.data().places.size(), 6u) << "what is not cut is shared still";
    ASSERT_EQ(once.meshes().size(), each.meshes().size());
    std::size_t cut = 0;
    for (std::size_t m = 0; m < each.meshes().size(); ++m) {
      const auto wanted = sorted_triangles(each, m);
      EXPECT_EQ(sorted_triangles(once, m), wanted) << "mesh " << each.meshes()[m].name;
      cut += wanted.size() != (each.meshes()[m].name == "ground" ? 2u : 12u);
    }
    EXPECT_GT(cut, 0u);
    for (std::size_t m = 0; surveyed == kSurveyed[0] && m < once.meshes().size(); ++m) {
      if (once.meshes()[m].name != "box 5") continue;
      EXPECT_EQ(once.data().instance_of(once.data().ranges[m].first_triangle).triangle_count, 12u) << "nothing is cut";
    }
    EXPECT_EQ(std::vector(once.notes().begin(), once.notes().end()),
              std::vector(each.notes().begin(), each.notes().end()));
  }
}

TEST(SharedMeshes, BothRolesAreCountedAsWhereNothingIsShared) {
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(0.5);
  scanner.min_range_m = 0.1;
  const Network network{{{2.03, 1.11, 1.62}}, {{-1.94, -2.07, 1.71}}};
  for (const auto& surveyed : kSurveyed)
    for (const Engine engine : {Engine::embree, Engine::compute_bvh, Engine::ray_query}) {
      SCOPED_TRACE(surveyed.back() + ", " + std::string(to_string(engine)));
      std::vector<NetworkCounts> counts;
      for (const SharedMeshes shared : {SharedMeshes::always, SharedMeshes::never}) {
        const Scene scene = load(test::boxes_on_ground(), {.surveyed = surveyed, .shared_meshes = shared});
        Simulator simulator(scene, scanner, {.engine = engine, .user_size_m = 0.1});
        counts.push_back(simulator.evaluate(network));
      }
      EXPECT_GT(counts[0].points_on_surveyed[0], 1000u);
      EXPECT_EQ(counts[0].points_on_surveyed, counts[1].points_on_surveyed);
      EXPECT_EQ(counts[0].seen, counts[1].seen);
      EXPECT_EQ(counts[0].saturated, counts[1].saturated);
      EXPECT_EQ(counts[0].partial_points, counts[1].partial_points);
    }
}

TEST(SharedMeshes, WhatDoesNotFitIsNotStoredAtEachPlace) {
  GlbBuilder builder;
  builder.json["asset"]["extras"]["vantage"] = json::object();
  json row{{"name", "row"}, {"mesh", bumpy_plate(builder, 9)}};
  std::vector<float> places;
  for (int k = 0; k < 20000; ++k)
    for (const float c : {static_cast<float>(2 * (k % 150)), 0.0F, static_cast<float>(2 * (k / 150))})
      places.push_back(c);
  row["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", builder.accessor(places, 5126, "VEC3")}};
  builder.node(row);
  const SceneOptions options{.shared_meshes = SharedMeshes::always, .max_memory_bytes = std::uint64_t{64} << 20};
  const Scene scene = load(builder, options);
  EXPECT_EQ(scene.triangle_count(), 20000u * 162);
  try {
    flattened(std::make_shared<const SceneData>(scene.data()));
    FAIL() << "no limit";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Errc::out_of_memory);
    const std::string text = error.what();
    for (const char* part : {"3240000 triangles on 2000000 vertices", "the limit is 64 MiB", "Make the scene smaller"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

TEST(SharedMeshes, AreNamedInFull) {
  for (const SharedMeshes shared : {SharedMeshes::automatic, SharedMeshes::always, SharedMeshes::never})
    EXPECT_EQ(shared_meshes_from_string(to_string(shared)), shared);
  EXPECT_THROW(shared_meshes_from_string("sometimes"), Error);
}

}  // namespace
}  // namespace vantage
