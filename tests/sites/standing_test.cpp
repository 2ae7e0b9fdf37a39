// SPDX-License-Identifier: Apache-2.0
// Compares the derived search area of each reference site with its truth: no inaccessible place, and a place in every
// accessible room.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>

#include "sites/site.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/placement.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

using test::KnownSite;
using test::Standing;
using test::Surface;

struct Case {
  const char* name;
  test::Variant variant;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const char* name : test::site_names())
    for (const test::Variant variant :
         {test::Variant{}, test::Variant{.utm = true}, test::Variant{.millimetres = true}, test::Variant{.z_up = true}})
      all.push_back({name, variant});
  return all;
}

class StandingOnSites : public testing::TestWithParam<Case> {
 protected:
  KnownSite site = make_site(GetParam().name, GetParam().variant);
  Scene load() const {
    const test::TemporaryFolder folder;
    write_site(site, GetParam().variant, folder / "site.glb");
    return Scene::load(folder / "site.glb");
  }
};
INSTANTIATE_TEST_SUITE_P(All, StandingOnSites, testing::ValuesIn(cases()), [](const auto& site) {
  const test::Variant& variant = site.param.variant;
  return std::string(site.param.name) + (variant.utm           ? "_utm"
                                         : variant.millimetres ? "_mm"
                                         : variant.z_up        ? "_z_up"
                                                               : "");
});

TEST_P(StandingOnSites, EveryPlaceIsAFloorThatIsReachedAndEveryRoomHasSome) {
  const Scene scene = load();
  const SearchArea area = SearchArea::build(scene);
  EXPECT_TRUE(area.derived());
  SCOPED_TRACE(area.description());
  const ClashChecker clash(scene);
  std::mt19937 rng(500);
  std::uniform_real_distribution<double> unit(0, 1);
  const Uv low = area.uv_min(), high = area.uv_max();
  std::map<std::string, int> ground, stations;
  std::map<Surface, int> wrong;
  int draws = 0;
  for (int tries = 0; tries < 200'000 && draws < 5000; ++tries) {
    const auto p = area.locate({low.u + unit(rng) * (high.u - low.u), low.v + unit(rng) * (high.v - low.v)});
    if (!p) continue;
    ++draws;
    const Standing standing = site.at(*p);
    if (standing.surface != Surface::floor && ++wrong[standing.surface] <= 3)
      ADD_FAILURE() << to_string(standing.surface) << " (" << standing.place << ") at " << p->x << ", " << p->y << ", "
                    << p->z;
    ++ground[standing.place];
    stations[standing.place] += !clash.clashes(*p, 1.85);
  }
  EXPECT_EQ(draws, 5000);
  for (const test::Place& place : site.places) {
    EXPECT_GT(ground[place.name], 0) << place.name;
    EXPECT_GT(stations[place.name], 0) << "no station stands in " << place.name;
  }
}

TEST_P(StandingOnSites, WhatIsLeftOutIsToldByReason) {
  const SearchArea area = SearchArea::build(load());
  std::map<Surface, double> unreachable, sealed;
  double told = 0;
  for (const LeftOut& out : area.left_out()) {
    double sum = 0;
    for (const auto& t : out.triangles) {
      const Vec3 &a = out.positions[t[0]], &b = out.positions[t[1]], &c = out.positions[t[2]];
      const Vec3 n = cross(b - a, c - a);
      const double size = 0.5 * std::sqrt(dot(n, n));
      sum += size;
      const Surface surface = site.at((a + b + c) * (1.0 / 3)).surface;
      if (out.reason == LeftOutReason::unreachable) unreachable[surface] += size;
      if (out.reason == LeftOutReason::sealed) sealed[surface] += size;
    }
    EXPECT_NEAR(sum, out.area_m2, 1e-6 * sum + 1e-9) << to_string(out.reason);
    told += sum;
  }
  EXPECT_GT(told, 1);
  EXPECT_LT(unreachable[Surface::floor] + sealed[Surface::floor], 1) << "a floor that is reached is told as left out";
  const std::string name = GetParam().name;
  if (name == "office") {
    EXPECT_GT(unreachable[Surface::roof], 250);
  }
  if (name == "house") {
    EXPECT_GT(sealed[Surface::sealed], 5);
  }
  if (name == "street") {
    EXPECT_GT(sealed[Surface::sealed], 6 * 40);
  }
}

}  // namespace
}  // namespace vantage
