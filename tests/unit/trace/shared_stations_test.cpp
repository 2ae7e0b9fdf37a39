// SPDX-License-Identifier: Apache-2.0
#include "trace/embree/shared_stations.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "support/trace_scenes.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t full = std::numeric_limits<std::uint32_t>::max();

TEST(StationPoints, AreAddedAsTheyWereCounted) {
  RandomStream random(3);
  std::vector<std::uint32_t> counts(200'003);
  for (std::uint32_t& n : counts) n = random.uniform() < 0.3 ? static_cast<std::uint32_t>(300 * random.uniform()) : 0;
  counts.front() = 254;
  counts[1] = 255;
  counts[65'536] = 256;
  counts.back() = full;
  const StationPoints points(counts, {.rays = 7});
  EXPECT_EQ(points.totals().rays, 7u);
  PassField field{std::vector<std::uint32_t>(counts.size(), 2), std::vector<std::uint64_t>(counts.size(), 1)};
  points.add_to(field, 8);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    ASSERT_EQ(field.count[k], counts[k] == full ? full : counts[k] + 2) << k;
    ASSERT_EQ(field.stations[k], counts[k] > 0 ? 9u : 1u) << k;
  }
  PassField unmasked{std::vector<std::uint32_t>(counts.size()), {}};
  points.add_to(unmasked, 1);
  EXPECT_EQ(unmasked.count, counts);
  EXPECT_LT(points.bytes(), counts.size());
  const std::vector<std::uint32_t> none(1);
  EXPECT_EQ(StationPoints(none, {}).bytes(), sizeof(std::uint64_t));
}

struct Stations {
  TraceScene scene;
  std::vector<StationRays> scanners;
  explicit Stations(const Scanner& scanner)
      : scene(test::trace_scene(
            test::SceneBuilder().mesh(Role::surveyed, test::quad({-1, 1, 0}, {2, 0, 0}, {0, 0, 2})).finish(), scanner,
            0.5)) {
    scanners.emplace_back(std::make_shared<const EmbreeScene>(scene), scene.scanners[0]);
  }
};

const Turn quarter{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
const std::vector<std::uint32_t> one_voxel{1};
const std::size_t size_of_one = StationPoints(one_voxel, {}).bytes();

// Goes through the networks as an engine does and returns the number of stations it had to trace. Kept points are the
// station's own.
std::size_t traced(const std::vector<StationRays>& scanners, const std::vector<std::vector<TraceStation>>& networks,
                   std::size_t room) {
  SharedStations shared(scanners, networks, room * size_of_one);
  std::size_t count = 0;
  for (const std::size_t n : shared.order()) {
    for (std::size_t s = 0; s < networks[n].size(); ++s) {
      const SharedStations::Use use = shared.next(n, s);
      const auto name = static_cast<std::uint64_t>(networks[n][s].origin.x);
      if (use.points) {
        EXPECT_EQ(use.points->totals().rays, name);
        continue;
      }
      ++count;
      if (use.again) shared.keep(use.id, StationPoints(one_voxel, {.rays = name}));
    }
  }
  EXPECT_LE(shared.different(), count);
  return count;
}

TEST(SharedStations, AreTracedOnceWhereThereIsRoom) {
  const Stations quiet{Scanner()};
  const TraceStation a{{1, 0, 0}, 0}, b{{2, 0, 0}, 1}, c{{3, 0, 0}, 2};
  // The order is {a, b}, {a, b, b}, {a, c}, {b, c}, {}.
  const std::vector<std::vector<TraceStation>> networks{{a, b}, {a, c}, {b, c}, {}, {a, b, b}};
  EXPECT_EQ(traced(quiet.scanners, networks, 3), 3u);
  EXPECT_EQ(traced(quiet.scanners, networks, 0), 9u);
  // With room for one, the cache keeps the station needed next: a for the second network, then b for its own other
  // place and for the fourth.
  EXPECT_EQ(traced(quiet.scanners, networks, 1), 6u);
  const SharedStations shared(quiet.scanners, networks, 0);
  EXPECT_EQ(std::vector<std::size_t>(shared.order().begin(), shared.order().end()),
            (std::vector<std::size_t>{0, 4, 1, 2, 3}));
}

TEST(SharedStations, AreThoseWhoseRaysGiveTheSamePoints) {
  const auto different = [](const Stations& site, const std::vector<TraceStation>& stations) {
    const std::vector<std::vector<TraceStation>> one{stations};
    return SharedStations(site.scanners, one, 0).different();
  };
  Stations quiet{Scanner()}, noisy{{.noise = rtc360_noise()}};
  const TraceStation a{{1, 0, 0}, 0};
  TraceStation elsewhere = a, behind = a, turned = a, other = a;
  elsewhere.place = 5, behind.origin.x = -1, turned.turn = quarter, other.scanner = 1;
  quiet.scanners.push_back(quiet.scanners.front());
  EXPECT_EQ(different(quiet, {a, a, elsewhere}), 1u);
  EXPECT_EQ(different(quiet, {a, behind, turned, other}), 4u);
  EXPECT_EQ(different(noisy, {a, a, elsewhere}), 2u) << "the place keys the noise";
}

}  // namespace
}  // namespace vantage
