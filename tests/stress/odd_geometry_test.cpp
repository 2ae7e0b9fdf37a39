// SPDX-License-Identifier: Apache-2.0
// Geometry that nobody models on purpose but exports contain.
#include <cmath>
#include <limits>
#include <string>

#include "stress/coplanar.hpp"
#include "stress/engine_suite.hpp"
#include "support/glb_builder.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"

namespace vantage::test {
namespace {

using nlohmann::json;
constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();

// A surveyed wall of 4 × 3 m in the plane y = 2 (survey frame), on blocking ground; glTF axes (x, z, −y).
struct Yard {
  GlbBuilder builder;
  Yard() {
    mesh("wall", "surveyed", {-2, 0, -2, 2, 0, -2, 2, 3, -2, -2, 0, -2, 2, 3, -2, -2, 3, -2});
    mesh("ground", "blocking", {-4, 0, 4, 4, 0, 4, 4, 0, -4, -4, 0, 4, 4, 0, -4, -4, 0, -4});
  }
  void mesh(const char* name, const char* role, const std::vector<float>& corners) {
    builder.node({{"name", name},
                  {"mesh", builder.mesh({{"attributes", {{"POSITION", builder.positions(corners)}}}})},
                  {"extras", {{"vantage", {{"role", role}}}}}});
  }
  Scene scene() const {
    const TemporaryFolder folder;
    builder.write_glb(folder / "yard.glb");
    return Scene::load(folder / "yard.glb");
  }
};

bool noted(const Scene& scene, const std::string& words) {
  for (const std::string& note : scene.notes())
    if (note.find(words) != std::string::npos) return true;
  return false;
}

struct Counted {
  NetworkCounts counts;
  VoxelField field;
};
Counted count(const EngineInfo& engine, const Scene& scene) {
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(1);
  Simulator simulator(scene, scanner, {.engine = engine.engine, .device_index = engine.device_index});
  Counted result;
  result.counts = simulator.evaluate({{{0.1, -0.3, 1.5}}, {{1.1, 0.4, 1.7}}}, {.skip = false, .field = &result.field});
  return result;
}

void expect_same(const Counted& got, const Counted& expected) {
  EXPECT_EQ(got.counts.points, expected.counts.points);
  EXPECT_EQ(got.field.count, expected.field.count);
  EXPECT_EQ(got.field.stations, expected.field.stations);
}

using OddGeometry = EngineSuite;

TEST_P(OddGeometry, BrokenFlatAndDoubledTrianglesAreDroppedWithTheirCount) {
  const Counted clean = count(GetParam(), Yard().scene());
  ASSERT_GT(clean.counts.points_on_surveyed[0], 1000u);
  Yard yard;
  yard.mesh("broken", "surveyed",
            {0, 1, 0, nan, 1, 0, 0, 2, 0, 0, infinity, 0, 1, 1, 0, 0, 2, 0, -infinity, 0, 0, 0, 0, 0, 1, 0, 0});
  yard.mesh("flat", "surveyed", {0, 1, 0, 1, 1, 0, 2, 1, 0, 1, 1, 1, 1, 1, 1, 1, 2, 1});
  yard.mesh("twice", "blocking", {-2, 0, -2, 2, 0, -2, 2, 3, -2});
  yard.mesh("twice, turned", "surveyed", {2, 0, -2, -2, 0, -2, 2, 3, -2});
  const Scene scene = yard.scene();
  EXPECT_TRUE(noted(scene, "dropped 3 triangles with a vertex that is not finite"));
  EXPECT_TRUE(noted(scene, "dropped 2 triangles without area"));
  EXPECT_TRUE(noted(scene, "dropped 2 exact duplicates"));
  EXPECT_EQ(scene.triangle_count(), 4u);
  expect_same(count(GetParam(), scene), clean);
}

// A surveyed sheet over blocking triangles with identical corners: the points count, whichever comes first.
TEST_P(OddGeometry, SurveyedOverBlockingWithTheSameCornersCounts) {
  const Counted clean = count(GetParam(), Yard().scene());
  Yard yard;
  yard.mesh("behind", "blocking", {-2, 0, -2, 2, 0, -2, 2, 3, -2, -2, 0, -2, 2, 3, -2, -2, 3, -2});
  const Scene scene = yard.scene();
  EXPECT_TRUE(noted(scene, "dropped 2 exact duplicates"));
  expect_same(count(GetParam(), scene), clean);
}

// In one plane but with other triangles, the part of the blocking surface under the surveyed one is cut away.
TEST_P(OddGeometry, SurveyedInTheVeryPlaneOfBlockingIsWhatIsHit) {
  const auto clean = count(GetParam(), Yard().scene());
  Yard yard;
  yard.mesh("behind", "blocking", {-3, 0, -2, 3, 0, -2, 0, 4, -2});
  yard.mesh("beside", "blocking", {2, 0, -2, 4, 0, -2, 4, 3, -2});  // touches only the first triangle's edge
  const Scene scene = yard.scene();
  EXPECT_TRUE(noted(scene, "1 blocking triangles lies in one plane with 2 surveyed"));
  EXPECT_FALSE(noted(Yard().scene(), "in one plane"));
  const Counted got = count(GetParam(), scene);
  EXPECT_EQ(got.counts.points_on_surveyed, clean.counts.points_on_surveyed);
  EXPECT_EQ(got.field.count, clean.field.count);
  EXPECT_EQ(got.field.stations, clean.field.stations);
  for (const CoplanarFigures& f : measure_coplanar(GetParam(), 1)) {
    EXPECT_GT(f.sheet_rays, 1000u) << f.name;
    EXPECT_EQ(f.missed, 0u) << f.name;
    EXPECT_EQ(f.counted, f.sheet_rays) << f.name;
    EXPECT_EQ(f.strayed, 0u) << f.name;
    EXPECT_LT(f.off_m, 1e-5) << f.name;
    EXPECT_EQ(f.noted, !f.apart) << f.name;
  }
}

// Slivers as thin as float32 resolves do not disturb surfaces behind them: a wall cut into a fan of slivers counts as
// one.
TEST_P(OddGeometry, SliversOfAWallCountAsTheWall) {
  const Counted clean = count(GetParam(), Yard().scene());
  Yard yard;
  yard.builder.json["nodes"].erase(0);
  yard.builder.json["scenes"][0]["nodes"] = {0};
  std::vector<float> fan;
  const auto triangle = [&](float x0, float x1) {
    for (const float c : {-2.0f, 0.0f, -2.0f, x1, 3.0f, -2.0f, x0, 3.0f, -2.0f}) fan.push_back(c);
  };
  float x = 2;
  for (const float c : {-2.0f, 0.0f, -2.0f, 2.0f, 0.0f, -2.0f, 2.0f, 3.0f, -2.0f}) fan.push_back(c);
  for (int k = 0; k < 40; ++k) {  // 3 µm wide
    triangle(x - 3e-6f, x);
    x -= 3e-6f;
  }
  triangle(-2, x);
  yard.mesh("wall", "surveyed", fan);
  const Scene scene = yard.scene();
  EXPECT_EQ(scene.triangle_count(), 2u + 42u);
  const Counted got = count(GetParam(), scene);
  for (const std::size_t s : {0u, 1u}) {
    const auto points = static_cast<double>(clean.counts.points_on_surveyed[s]);
    EXPECT_NEAR(static_cast<double>(got.counts.points_on_surveyed[s]), points, std::ceil(1e-4 * points));
  }
}
VANTAGE_EVERY_ENGINE(OddGeometry);

TEST(OddScenes, WithNothingLeftAreRefusedWithTheCount) {
  GlbBuilder builder;
  builder.node(
      {{"mesh", builder.mesh(
                    {{"attributes",
                      {{"POSITION", builder.positions({0, 0, 0, 1, 1, 1, 2, 2, 2, 0, nan, 0, 1, 0, 0, 0, 1, 0})}}}})}});
  const TemporaryFolder folder;
  builder.write_glb(folder / "flat.glb");
  try {
    Scene::load(folder / "flat.glb");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::malformed_file);
    EXPECT_NE(std::string(e.what()).find("all 2 triangles are without area or not finite"), std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace vantage::test
