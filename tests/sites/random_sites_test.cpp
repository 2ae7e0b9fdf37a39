// SPDX-License-Identifier: Apache-2.0
// Sites that nobody designed: unit and up axis are right or asked for, no station stands where nobody gets to, and each
// room is reached or told. VANTAGE_SEEDS=first..last chooses the sites.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>
#include <set>

#include "sites/random_site.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/error.hpp"
#include "vantage/placement.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

using test::RandomSite;
using test::Standing;
using test::Surface;

double area_of(const test::Place& place) { return (place.x1 - place.x0) * (place.y1 - place.y0); }

// `whole`: all places are reached.
void stand(const RandomSite& random, const Scene& scene, bool whole) {
  const SearchArea area = SearchArea::build(scene);
  SCOPED_TRACE(area.description());
  EXPECT_FALSE(area.on_plane());
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> unit(0, 1);
  const Uv low = area.uv_min(), high = area.uv_max();
  std::map<std::string, int> ground, wrong;
  std::set<std::string> entered;
  for (int tries = 0, draws = 0; tries < 40'000 && draws < 2000; ++tries) {
    const auto p = area.locate({low.u + unit(rng) * (high.u - low.u), low.v + unit(rng) * (high.v - low.v)});
    if (!p) continue;
    ++draws;
    Standing standing = random.site.at(*p);
    // Surfaces are cut to a few decimetres at what stands on them.
    constexpr double kEdge = 0.25;
    for (const Vec3& aside : {Vec3{kEdge, 0, 0}, {-kEdge, 0, 0}, {0, kEdge, 0}, {0, -kEdge, 0}})
      if (standing.surface != Surface::floor) standing = random.site.at(*p + aside);
    const std::string where = standing.surface != Surface::floor ? to_string(standing.surface) : standing.place;
    // Parts that no path leads to may be planned, and the result then says so.
    const bool shut = random.shut.contains(standing.place);
    if (shut && standing.surface == Surface::floor) entered.insert(standing.place);
    const bool off = standing.surface != Surface::floor || (shut && area.entered().empty());
    if (off && ++wrong[where] <= 2) ADD_FAILURE() << where << " at " << p->x << ", " << p->y << ", " << p->z;
    ++ground[standing.place];
  }
  double unseen = 0, told = 0;
  std::string names;
  for (const test::Place& place : random.site.places)
    if (ground[place.name] == 0) unseen += area_of(place), names += " " + place.name;
  // A part of some size is planned, unless nobody wants it.
  double known = 0, largest = 0;
  for (const ClosedPart& part : area.not_entered()) {
    told += part.area_m2;
    if (part.to_decide() && part.kind != ClosedKind::hollow) largest = std::max(largest, part.share);
  }
  EXPECT_LT(largest, 0.1) << "of all floor is closed";
  for (const ClosedPart& part : area.entered()) told += part.area_m2, known += part.area_m2;
  double shut = 0;
  for (const test::Place& place : random.site.places)
    if (entered.contains(place.name)) shut += area_of(place);
  EXPECT_GE(known, 0.3 * shut) << "planned without a way, and not told";
  EXPECT_GE(told, 0.3 * unseen) << "not reached:" << names;
  EXPECT_TRUE(!whole || unseen == 0) << "not reached:" << names;
  for (const test::Place& place : random.site.places)
    if (!random.shut.contains(place.name) && ground[place.name] == 0)
      std::printf("    %s is not reached, and told\n", place.name.c_str());
}

void walk_all(int first, int last) {
  int right = 0, asked = 0, wrong = 0;
  for (int seed = first; seed <= last; ++seed) {
    const RandomSite random = test::make_random_site(static_cast<std::uint64_t>(seed));
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + random.told);
    const test::TemporaryFolder folder;
    write_site(random, folder / "site.glb");
    const double per_metre = random.variant.per_metre;
    Unit unit = Unit::metre;
    for (const Unit u : {Unit::centimetre, Unit::millimetre, Unit::inch, Unit::foot})
      if (std::abs(per_metre * metres_in(u) - 1) < 1e-6) unit = u;
    const SceneOptions truth{.unit = unit, .up = random.variant.z_up ? UpAxis::z : UpAxis::y};
    const Scene scene = Scene::load(folder / "site.glb", truth);
    std::optional<Scene> found;
    try {
      found = Scene::load(folder / "site.glb");
    } catch (const Error& error) {
      ++asked;
      std::printf("  seed %d, %s: asked\n", seed, random.told.c_str());
      EXPECT_GE(error.details().size(), 2U) << error.what();
    }
    if (found) {
      const bool same = found->fingerprint() == scene.fingerprint();
      (same ? right : wrong) += 1;
      EXPECT_TRUE(same) << (found->notes().empty() ? "" : found->notes().front());
    }
    stand(random, scene, static_cast<std::uint64_t>(seed) >= test::kFirstStrange);
  }
  std::printf("%d right, %d asked, %d wrong\n", right, asked, wrong);
}

TEST(RandomSites, AreRecognisedOrAskedForAndWalkedAsTheyAre) {
  int first = 1, last = 20;
  if (const char* seeds = std::getenv("VANTAGE_SEEDS")) {
    ASSERT_EQ(std::sscanf(seeds, "%d..%d", &first, &last), 2);
  }
  walk_all(first, last);
}

TEST(RandomSites, OfStrangeKindsAreEnteredWhereTheGroundIs) {
  const auto first = static_cast<int>(test::kFirstStrange);
  walk_all(first, first + 17);
}

}  // namespace
}  // namespace vantage
