// SPDX-License-Identifier: Apache-2.0
// Unit and up axis of the reference sites, however they are written.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "sites/site.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"
#include "vantage/placement.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

using test::KnownSite;
using test::Variant;

Box bounds(const KnownSite& site) {
  Box box;
  for (const test::Part& part : site.parts)
    for (const Vec3& p : part.positions) box.extend(p + site.offset);
  return box;
}

void expect_box(const Box& found, const Box& wanted, const std::string& what) {
  const double near = 2e-3;  // floats of millimetres at 60 m
  for (const auto& [a, b] : {std::pair{found.min, wanted.min}, {found.max, wanted.max}}) {
    EXPECT_NEAR(a.x, b.x, near) << what;
    EXPECT_NEAR(a.y, b.y, near) << what;
    EXPECT_NEAR(a.z, b.z, near) << what;
  }
}

std::string text(const Scene& scene) {
  std::string out;
  for (const std::string& note : scene.notes()) out += note + "\n";
  return out;
}

double ground_m2(const SearchArea& area) {
  double sum = 0;
  for (const auto& [a, b, c] : area.mesh().triangles) {
    const auto& p = area.mesh().positions;
    const Vec3 n = cross(p[b] - p[a], p[c] - p[a]);
    sum += std::sqrt(dot(n, n)) / 2;
  }
  return sum;
}

class RecognisedSites : public testing::TestWithParam<const char*> {
 protected:
  Scene load(const Variant& variant, const SceneOptions& options = {}) {
    const test::TemporaryFolder folder;
    write_site(test::make_site(GetParam(), variant), variant, folder / "site.glb");
    return Scene::load(folder / "site.glb", options);
  }
};
INSTANTIATE_TEST_SUITE_P(All, RecognisedSites, testing::ValuesIn(test::site_names().begin(), test::site_names().end()),
                         [](const auto& site) { return std::string(site.param); });

// A street of houses without a door may be one of inches or feet: that is asked for.
TEST_P(RecognisedSites, InEveryVariant) {
  int asked = 0;
  for (const double per_metre : {1.0, 1000.0, 100.0, 1 / 0.0254, 1 / 0.3048})
    for (const bool z_up : {false, true})
      for (const bool utm : {false, true}) {
        const Variant variant{.z_up = z_up, .utm = utm, .per_metre = per_metre};
        const std::string what = std::to_string(per_metre) + (z_up ? " Z up" : " Y up") + (utm ? " UTM: " : ": ");
        std::optional<Scene> read;
        try {
          read = load(variant);
        } catch (const Error& question) {
          ++asked;
          EXPECT_NE(per_metre, 1) << what << question.what();
          EXPECT_GE(question.details().size(), 2U) << what << question.what();
          continue;
        }
        const Scene& scene = *read;
        expect_box(scene.bounds(), bounds(test::make_site(GetParam(), variant)), what + text(scene));
        EXPECT_EQ(text(scene).find("setting unit") != std::string::npos, per_metre != 1) << what << text(scene);
        EXPECT_EQ(text(scene).find("setting up") != std::string::npos, z_up) << what << text(scene);
      }
  EXPECT_LE(asked, std::string(GetParam()) == "street" ? 8 : 0);
}

TEST_P(RecognisedSites, AsAreNamelessOnesThatKeepToGltf) {
  const Variant variant{.nameless = true};
  const Scene scene = load(variant);
  expect_box(scene.bounds(), bounds(test::make_site(GetParam(), variant)), text(scene));
  EXPECT_EQ(text(scene).find("setting u"), std::string::npos) << text(scene);
}

// A sketching tool leaves each face as it was drawn.
TEST_P(RecognisedSites, AsAreThoseWhoseFacesAreWoundEitherWayWithTheirGround) {
  const Scene whole = load({});
  const double ground = ground_m2(SearchArea::build(whole));
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Variant variant{.wound = seed};
    const Scene scene = load(variant);
    expect_box(scene.bounds(), bounds(test::make_site(GetParam(), variant)), text(scene));
    EXPECT_EQ(text(scene).find("setting u"), std::string::npos) << text(scene);
    const SearchArea area = SearchArea::build(scene);
    EXPECT_FALSE(area.on_plane());
    EXPECT_NEAR(ground_m2(area) / ground, 1, 0.02) << seed << area.description();
  }
}

TEST_P(RecognisedSites, AndOptionsSayTheSame) {
  const Variant variant{.millimetres = true, .z_up = true};
  const Scene asked = load(variant), told = load(variant, {.unit = Unit::millimetre, .up = UpAxis::z});
  EXPECT_EQ(asked.fingerprint(), told.fingerprint());
  EXPECT_EQ(text(told).find("setting u"), std::string::npos) << text(told);
}

}  // namespace
}  // namespace vantage
