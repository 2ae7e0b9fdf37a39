// SPDX-License-Identifier: Apache-2.0
// Stations of several scanners, turned and tilted, meet the demands on upright ones, and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>

#include "conformance/agreement.hpp"
#include "conformance/engines_under_test.hpp"
#include "conformance/sites.hpp"
#include "core/philox.hpp"
#include "scan/noise_model.hpp"
#include "scan/pattern.hpp"
#include "support/expect_counts.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {
namespace {

constexpr double goal_density = 12.5;

std::optional<Turn> turned(double heading_deg, double tilt_deg) {
  return make_turn({.heading = Angle::degrees(heading_deg), .tilt = Angle::degrees(tilt_deg)});
}

// Another scanner: coarser, less than a full turn, shorter range, with its own noise.
TraceScanner second_scanner(bool noisy) {
  Scanner scanner;
  scanner.horizontal_angle = Angle::degrees(250);
  scanner.vertical_angle = Angle::degrees(220);
  scanner.zenith_start = Angle::degrees(25);
  scanner.azimuth_step = Angle::degrees(0.9);
  scanner.zenith_step = Angle::degrees(0.7);
  scanner.heading = Angle::degrees(-40);
  scanner.min_range_m = 0.3;
  scanner.max_range_m = 9;
  if (noisy) scanner.noise = {.distances_m = {5}, .reflectivities = {0.5}, .sigma_m = {0.011}};
  return {std::make_shared<const RayPattern>(make_pattern(scanner)),
          std::make_shared<const NoiseModel>(make_noise_model(scanner, 4711))};
}

// Uneven rows, one alone far above, several within a step of the others, and an asymmetric field.
TraceScanner uneven_scanner(bool noisy) {
  TraceScanner scanner = second_scanner(noisy);
  Scanner rows;
  rows.horizontal_angle = Angle::degrees(311);
  rows.azimuth_step = Angle::degrees(0.9);
  rows.heading = Angle::degrees(75);
  rows.min_range_m = 0.3, rows.max_range_m = 9;
  std::vector<Angle> zeniths{Angle::degrees(4.5)};
  for (double zenith = 41; zenith < 161; zenith += 0.3 + 1.3 * std::abs(std::sin(zenith)))
    zeniths.push_back(Angle::degrees(zenith));
  rows.set_row_zeniths(zeniths);
  scanner.pattern = std::make_shared<const RayPattern>(make_pattern(rows));
  return scanner;
}

TraceScene scene_of(const TestSite& site, bool noisy) {
  TraceScene scene = site.trace_scene(noisy);
  scene.scanners.push_back(second_scanner(noisy));
  scene.scanners.push_back(uneven_scanner(noisy));
  return scene;
}

// Upright and turned stations of all scanners.
std::vector<TraceStation> stations_of(const TestSite& site) {
  std::vector<TraceStation> stations = site.stations;
  stations.resize(4);
  stations[0].turn = turned(-20, 90);
  stations[1].scanner = 2;
  stations[2].turn = turned(37, 0);
  stations[3].scanner = 1;
  stations[3].turn = turned(200, 31);
  return stations;
}

// Random places and turns.
std::vector<TraceStation> random_stations(const TestSite& site, std::uint32_t n, std::uint64_t seed) {
  RandomStream random(seed);
  const Box box = site.scene->local_bounds;
  const auto within = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * (1.2 * random.uniform() - 0.1));
  };
  std::vector<TraceStation> stations;
  for (std::uint32_t i = 0; i < n; ++i) {
    TraceStation station{
        {within(box.min.x, box.max.x), within(box.min.y, box.max.y), within(box.min.z, box.max.z)}, i, i % 3};
    if (i % 5 != 4) station.turn = turned(360 * random.uniform(), 180 * random.uniform());
    stations.push_back(station);
  }
  return stations;
}

class TurnedConformance : public testing::TestWithParam<EngineUnderTest> {
 protected:
  static std::unique_ptr<Tracer> make(const TraceScene& scene) {
    auto tracer = GetParam().make(scene);
    tracer->set_goal_density(goal_density);
    return tracer;
  }

  using Tracers = std::map<std::tuple<std::string, std::string, bool>, std::unique_ptr<Tracer>>;
  static Tracers& tracers() {
    static Tracers made;
    return made;
  }
  static void TearDownTestSuite() { tracers().clear(); }

  // Kept from test to test: building an engine costs more than most tests.
  static Tracer* of(const TestSite& site, bool noisy) {
    auto& kept = tracers()[{GetParam().name, site.name, noisy}];
    if (!kept) kept = make(scene_of(site, noisy));
    return kept.get();
  }
  static std::uint64_t rays_of(const TraceScene& scene, const TraceStation& station) {
    const RayPattern& pattern = *scene.scanners[station.scanner].pattern;
    return std::uint64_t{pattern.rows()} * pattern.columns();
  }
};

TEST_P(TurnedConformance, ScansMatchADoublePrecisionReference) {
  for (const TestSite& site : sites()) {
    for (const bool noisy : {false, true}) {
      // shared by all engines
      static std::map<std::tuple<std::string, std::size_t, bool>, std::vector<ReferenceHit>> made;
      const TraceScene scene = scene_of(site, noisy);
      Tracer* const tracer = of(site, noisy);
      const std::vector<TraceStation> stations = stations_of(site);
      std::size_t undecided = 0, rays = 0;
      for (std::size_t s = 0; s < stations.size(); ++s) {
        SCOPED_TRACE(site.name + ", station " + std::to_string(s) + (noisy ? ", noise" : ""));
        std::vector<ReferenceHit>& reference = made[{site.name, s, noisy}];
        if (reference.empty()) reference = ReferenceTracer(scene).scan(stations[s]);
        Tracer::RawChunk chunk;
        tracer->scan(stations[s], 0, rays_of(scene, stations[s]), all_outputs, chunk);
        compare_with_reference(*site.scene, reference, chunk, undecided);
        rays += reference.size();
        if (HasFailure()) return;
      }
      EXPECT_LE(static_cast<double>(undecided), most_undecided(rays)) << site.name;
    }
  }
}

// Every engine turns a direction into the same bits.
TEST_P(TurnedConformance, PositionsAreRangeTimesTurnedDirectionToTheBit) {
  const TestSite& site = sites()[2];
  const TraceScene scene = scene_of(site, true);
  Tracer* const tracer = of(site, true);
  for (const TraceStation& station : stations_of(site)) {
    const RayPattern& pattern = *scene.scanners[station.scanner].pattern;
    Tracer::RawChunk chunk;
    tracer->scan(station, 0, rays_of(scene, station), Tracer::range | Tracer::position, chunk);
    std::size_t apart = 0, hits = 0;
    for (std::size_t k = 0; k < chunk.range.size(); ++k) {
      if (!std::isfinite(chunk.range[k])) continue;
      ++hits;
      const std::size_t i = k / pattern.columns(), j = k % pattern.columns();
      Float3 d{pattern.sin_zenith[i] * pattern.cos_azimuth[j], pattern.sin_zenith[i] * pattern.sin_azimuth[j],
               pattern.cos_zenith[i]};
      if (station.turn) d = (*station.turn)(d);
      const Float3& o = station.origin;
      const float t = chunk.range[k];
      apart += chunk.position[k].x != o.x + t * d.x || chunk.position[k].y != o.y + t * d.y ||
               chunk.position[k].z != o.z + t * d.z;
    }
    EXPECT_EQ(apart, 0u) << "station " << station.place;
    EXPECT_GT(hits, rays_of(scene, station) / 40);
  }
}

TEST_P(TurnedConformance, CountsAreThePointsOfTheScans) {
  for (const TestSite& site : sites()) {
    for (const bool noisy : {false, true}) {
      SCOPED_TRACE(site.name + (noisy ? ", noise" : ""));
      const TraceScene scene = scene_of(site, noisy);
      Tracer* const tracer = of(site, noisy);
      const std::vector<TraceStation> stations = stations_of(site);
      PassField expected, field;
      expected.count.resize(site.grid->size());
      expected.stations.resize(site.grid->size());
      std::uint64_t rays = 0;
      for (const TraceStation& station : stations) {
        Tracer::RawChunk chunk;
        tracer->scan(station, 0, rays_of(scene, station), Tracer::voxel, chunk);
        rays += chunk.voxel.size();
        for (const std::uint32_t voxel : chunk.voxel) {
          if (voxel == kNoVoxel) continue;
          ++expected.count[voxel];
          expected.stations[voxel] |= std::uint64_t{1} << station.place;
        }
      }
      const NetworkCounts counts = tracer->count(stations, 4, {true, false, &field}, {});
      EXPECT_EQ(field.count, expected.count);
      EXPECT_EQ(field.stations, expected.stations);
      EXPECT_EQ(counts.rays, rays);
    }
  }
}

TEST_P(TurnedConformance, SkippingChangesNoVoxel) {
  for (const TestSite& site : sites()) {
    const std::vector<TraceStation> stations = random_stations(site, 20, 5);
    for (const bool noisy : {false, true}) {
      SCOPED_TRACE(site.name + (noisy ? ", noise" : ""));
      Tracer* const tracer = of(site, noisy);
      PassField all, skipped;
      const NetworkCounts expected = tracer->count(stations, 20, {true, false, &all}, {});
      const NetworkCounts counts = tracer->count(stations, 20, {true, true, &skipped}, {});
      EXPECT_EQ(skipped.count, all.count);
      EXPECT_EQ(skipped.stations, all.stations);
      EXPECT_EQ(counts.points_on_surveyed, expected.points_on_surveyed);
      EXPECT_LT(counts.rays, expected.rays);
    }
  }
}

TEST_P(TurnedConformance, ASampleOfAllVoxelsIsTheExactEvaluation) {
  for (const TestSite& site : sites()) {
    std::vector<std::uint32_t> everything(site.grid->size());
    std::iota(everything.begin(), everything.end(), 0u);
    const std::vector<std::vector<TraceStation>> networks{stations_of(site), random_stations(site, 10, 17),
                                                          site.stations};
    const std::vector<std::uint32_t> sizes{4, 10, 4};
    for (const bool noisy : {false, true}) {
      SCOPED_TRACE(site.name + (noisy ? ", noise" : ""));
      Tracer* const tracer = of(site, noisy);
      std::vector<std::vector<std::uint32_t>> points(networks.size());
      std::vector<std::vector<std::uint64_t>> masks(networks.size());
      Tracer::SampleJob job{everything, 20, true, 0};
      job.points = [&](std::size_t n, std::span<const std::uint32_t> of) { points[n].assign(of.begin(), of.end()); };
      job.station_masks = [&](std::size_t first, std::span<const std::uint64_t> of) {
        for (std::size_t k = 0; k < of.size() / everything.size(); ++k) {
          const auto own = of.subspan(k * everything.size(), everything.size());
          masks[first + k].assign(own.begin(), own.end());
        }
      };
      const auto sampled = tracer->count_sampled(networks, sizes, job, {});
      for (std::size_t n = 0; n < networks.size(); ++n) {
        PassField field;
        const NetworkCounts exact = tracer->count(networks[n], sizes[n], {true, true, &field}, {});
        EXPECT_EQ(points[n], field.count) << "network " << n;
        EXPECT_EQ(masks[n], field.stations) << "network " << n;
        EXPECT_EQ(sampled[n].saturated, exact.saturated);
        EXPECT_EQ(sampled[n].shared, exact.shared);
        EXPECT_GT(exact.saturated + exact.partial_points, 0u);
      }
    }
  }
}

// Networks of one front share stations, which need not be traced again for each.
TEST_P(TurnedConformance, NetworksWithStationsInCommonAreCountedAsEachAlone) {
  const TestSite& site = sites()[1];
  const std::vector<TraceStation> all = stations_of(site);
  std::vector<TraceStation> others = all, moved = all, upright = all;
  for (TraceStation& station : others) station.place = (station.place + 1) % 4;
  moved[2].origin.x += 0.25f;
  upright[0].turn.reset();
  const std::vector<std::vector<TraceStation>> networks{all, others, moved, {all[0], all[3]}, upright, all};
  const std::vector<std::uint32_t> sizes(networks.size(), 4);
  for (const bool noisy : {false, true}) {
    Tracer* const tracer = of(site, noisy);
    for (const Tracer::CountOptions options : {Tracer::CountOptions{true, true, nullptr}, {false, false, nullptr}}) {
      const std::vector<NetworkCounts> each = tracer->count_each(networks, sizes, options, {});
      ASSERT_EQ(each.size(), networks.size());
      for (std::size_t k = 0; k < networks.size(); ++k) {
        SCOPED_TRACE(k);
        const NetworkCounts alone = tracer->count(networks[k], sizes[k], options, {});
        expect_equal_counts(each[k], alone);
        EXPECT_EQ(each[k].points, alone.points);
        EXPECT_EQ(each[k].points_on_surveyed, alone.points_on_surveyed);
        EXPECT_EQ(each[k].dropped, alone.dropped);
        EXPECT_FALSE(each[k].cancelled);
      }
    }
  }
}

// Closed forms.

// A quarter turn maps a full circle of rays onto itself, to the bit if its columns divide by four.
TEST_P(TurnedConformance, AQuarterTurnOfAFullCircleChangesNoCount) {
  const TestSite& site = sites()[2];
  ASSERT_EQ(site.pattern->columns() % 4, 0u);
  Tracer* const tracer = of(site, false);
  std::vector<TraceStation> stations = site.stations;
  PassField upright, quarter;
  tracer->count(stations, 4, {true, true, &upright}, {});
  for (TraceStation& station : stations) station.turn = turned(90 * (1 + station.place % 3), 0);
  tracer->count(stations, 4, {true, true, &quarter}, {});
  EXPECT_EQ(quarter.count, upright.count);
  EXPECT_EQ(quarter.stations, upright.stations);
}

// The same holds for any other multiple of its step, except for rounding: ray (i, j) goes where (i, j + k) went.
TEST_P(TurnedConformance, AMultipleOfTheStepMovesColumns) {
  const TestSite& site = sites()[2];
  Tracer* const tracer = of(site, false);
  const std::uint32_t columns = site.pattern->columns(), moved = 77;
  TraceStation station = site.stations[0];
  Tracer::RawChunk upright, turned_scan;
  tracer->scan(station, 0, site.rays(), Tracer::range, upright);
  station.turn = turned(moved * site.pattern->azimuth_step * 180 / std::numbers::pi, 0);
  tracer->scan(station, 0, site.rays(), Tracer::range, turned_scan);
  const std::vector<ReferenceHit>& reference = site.reference(0, false);
  std::size_t undecided = 0;
  for (std::size_t k = 0; k < site.rays(); ++k) {
    const std::size_t before = k / columns * columns + (k % columns + moved) % columns;
    const float a = turned_scan.range[k], b = upright.range[before];
    const bool same = std::isfinite(a) == std::isfinite(b) && (!std::isfinite(a) || std::abs(a - b) < 1e-3);
    undecided += !same;
    if (!same) {
      EXPECT_LT(reference[before].edge_distance, undecided_m) << "ray " << k;
    }
  }
  EXPECT_LE(undecided, 20u);
}

// The axes of a cube are equivalent: a lying head in its middle sees on the wall ahead what a standing one sees on the
// ceiling.
TEST_P(TurnedConformance, AHeadThatLiesInACubeSeesItAsOneThatStands) {
  constexpr double half = 2.5;
  const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<Vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {  // −x, +x, −y, +y, −z, +z
      const Vec3 n = axes[axis] * (side * half), u = axes[(axis + 1) % 3] * half, v = axes[(axis + 2) % 3] * half;
      const auto first = static_cast<std::uint32_t>(corners.size());
      for (const Vec3& corner : {n - u - v, n + u - v, n + u + v, n - u + v}) corners.push_back(corner);
      triangles.push_back({first, first + 1, first + 2});
      triangles.push_back({first, first + 2, first + 3});
    }
  }
  const Scene cube = Scene::from_triangles(corners, triangles);
  const auto scene = std::make_shared<const SceneData>(cube.data());
  ASSERT_EQ(scene->origin, Vec3{});
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(0.7);
  TraceScene traced{.scene = scene,
                    .grid = std::make_shared<const VoxelGrid>(VoxelGrid::build(*scene, 0.1)),
                    .scanners = {{std::make_shared<const RayPattern>(make_pattern(scanner)), nullptr}}};
  const auto tracer = make(traced);
  const auto walls = [&](const std::optional<Turn>& turn) {
    const TraceStation station{{0, 0, 0}, 0, 0, turn};
    Tracer::RawChunk chunk;
    tracer->scan(station, 0, rays_of(traced, station), Tracer::primitive, chunk);
    std::array<int, 6> points{};
    for (const std::uint32_t triangle : chunk.primitive) ++points[triangle / 2];
    return points;
  };
  const std::array<int, 6> stands = walls(std::nullopt);
  EXPECT_GT(stands[5], stands[4]) << "it sees all of the ceiling, and not all of the floor below it";
  // Its axis points to +x, its x to −z.
  const std::array<int, 6> lies = walls(turned(0, 90));
  EXPECT_EQ(lies, (std::array<int, 6>{stands[4], stands[5], stands[2], stands[3], stands[1], stands[0]}));
  // Its axis points to +y, its x to −z, its y to −x.
  const std::array<int, 6> aside = walls(turned(90, 90));
  EXPECT_EQ(aside, (std::array<int, 6>{stands[3], stands[2], stands[4], stands[5], stands[1], stands[0]}));
}

INSTANTIATE_TEST_SUITE_P(Engines, TurnedConformance, testing::ValuesIn(engines_under_test()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace vantage::test
