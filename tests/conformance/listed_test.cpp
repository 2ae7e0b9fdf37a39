// SPDX-License-Identifier: Apache-2.0
// Lists of directions meet the demands on grids, and engines count a grid's directions as the grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include "conformance/agreement.hpp"
#include "conformance/engines_under_test.hpp"
#include "conformance/sites.hpp"
#include "core/philox.hpp"
#include "scan/pattern.hpp"

namespace vantage::test {
namespace {

// A rosette of an asymmetric field, some of it twice, and the poles.
std::shared_ptr<const RayPattern> rosette() {
  Scanner scanner;
  scanner.heading = Angle::degrees(29);
  scanner.min_range_m = 0.4, scanner.max_range_m = 25;
  std::vector<RayAngles> directions{{Angle::degrees(0), Angle::degrees(0)}, {Angle::degrees(180), Angle::degrees(77)}};
  for (int k = 0; k < 30'000; ++k) {
    const double turn = 0.0531 * k;
    directions.push_back(
        {Angle::degrees(80 + 67 * std::sin(0.7243 * turn)), Angle::degrees(110 * std::sin(turn) - 40)});
  }
  directions.insert(directions.end(), directions.begin() + 100, directions.begin() + 700);
  scanner.set_directions(directions);
  return std::make_shared<const RayPattern>(make_pattern(scanner));
}

TraceScene with_pattern(const TestSite& site, bool noisy, std::shared_ptr<const RayPattern> pattern) {
  TraceScene scene = site.trace_scene(noisy);
  scene.scanners.front().pattern = std::move(pattern);
  return scene;
}

std::vector<TraceStation> some_turned(const TestSite& site) {
  std::vector<TraceStation> stations = site.stations;
  stations[1].turn = make_turn({.heading = Angle::degrees(130), .tilt = Angle::degrees(24)});
  stations[3].turn = make_turn({.heading = Angle::degrees(-70), .tilt = Angle::degrees(90)});
  return stations;
}

// Points and masks of each voxel.
PassField sampled_field(Tracer& tracer, const TraceScene& scene, const std::vector<TraceStation>& stations,
                        std::uint64_t& rays) {
  std::vector<std::uint32_t> everything(scene.grid->size());
  std::iota(everything.begin(), everything.end(), 0u);
  PassField field;
  Tracer::SampleJob job{everything, 20, true, 0};
  job.points = [&](std::size_t, std::span<const std::uint32_t> of) { field.count.assign(of.begin(), of.end()); };
  job.station_masks = [&](std::size_t, std::span<const std::uint64_t> of) {
    field.stations.assign(of.begin(), of.end());
  };
  const std::vector<std::vector<TraceStation>> networks{stations};
  const std::vector<std::uint32_t> sizes{static_cast<std::uint32_t>(stations.size())};
  rays = tracer.count_sampled(networks, sizes, job, {}).front().rays;
  return field;
}

class ListedConformance : public testing::TestWithParam<EngineUnderTest> {};

TEST_P(ListedConformance, ScansAndCountsMatchADoublePrecisionReference) {
  const auto pattern = rosette();
  for (const TestSite& site : sites()) {
    for (const bool noisy : {false, true}) {
      SCOPED_TRACE(site.name + (noisy ? ", noise" : ""));
      const TraceScene scene = with_pattern(site, noisy, pattern);
      const auto tracer = GetParam().make(scene);
      const std::vector<TraceStation> stations = some_turned(site);
      const ReferenceTracer reference(scene);
      PassField expected, field;
      expected.count.resize(site.grid->size()), expected.stations.resize(site.grid->size());
      std::size_t undecided = 0, rays = 0, points = 0;
      for (const TraceStation& station : stations) {
        Tracer::RawChunk chunk;
        tracer->scan(station, 0, pattern->rows(), all_outputs, chunk);
        compare_with_reference(*site.scene, reference.scan(station), chunk, undecided);
        if (HasFailure()) return;
        rays += chunk.voxel.size();
        for (const std::uint32_t voxel : chunk.voxel) {
          if (voxel == kNoVoxel) continue;
          ++points;
          ++expected.count[voxel];
          expected.stations[voxel] |= std::uint64_t{1} << station.place;
        }
      }
      EXPECT_LE(static_cast<double>(undecided), most_undecided(rays));
      EXPECT_GT(points, rays / 200);
      const auto many = static_cast<std::uint32_t>(stations.size());
      const NetworkCounts counts = tracer->count(stations, many, {true, true, &field}, {});
      EXPECT_EQ(field.count, expected.count);
      EXPECT_EQ(field.stations, expected.stations);
      EXPECT_EQ(counts.rays, rays);
      std::uint64_t sampled_rays = 0;
      const PassField sampled = sampled_field(*tracer, scene, stations, sampled_rays);
      EXPECT_EQ(sampled.count, expected.count);
      EXPECT_EQ(sampled.stations, expected.stations);
    }
  }
}

// Chunks of any size are parts of the whole scan.
TEST_P(ListedConformance, ChunksAreThoseOfTheWholeScan) {
  const TestSite& site = sites()[2];
  const auto pattern = rosette();
  const auto tracer = GetParam().make(with_pattern(site, true, pattern));
  Tracer::RawChunk whole, part;
  tracer->scan(site.stations[0], 0, pattern->rows(), Tracer::range, whole);
  std::uint64_t first = 0;
  for (const std::uint64_t rays : {1u, 255u, 256u, 300u, 20'000u}) {
    tracer->scan(site.stations[0], first, rays, Tracer::range, part);
    ASSERT_EQ(part.range.size(), rays);
    EXPECT_TRUE(
        std::equal(part.range.begin(), part.range.end(), whole.range.begin() + static_cast<std::ptrdiff_t>(first)))
        << "from ray " << first;
    first += rays;
  }
}

// Rays of a grid in a list, in any order, give the same points in the same voxels.
TEST_P(ListedConformance, DirectionsOfAGridCountAsTheGrid) {
  for (const TestSite& site : sites()) {
    SCOPED_TRACE(site.name);
    const RayPattern& grid = *site.pattern;
    std::vector<std::uint32_t> order(site.rays());
    std::iota(order.begin(), order.end(), 0u);
    RandomStream random(9);
    for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random.bits() % k]);
    auto listed = std::make_shared<RayPattern>();
    std::vector<double> zeniths, azimuths;
    for (const std::uint32_t ray : order) {
      const std::uint32_t row = ray / grid.columns(), column = ray % grid.columns();
      zeniths.push_back(grid.first_zenith + row * grid.zenith_step);
      azimuths.push_back(grid.first_azimuth + column * grid.azimuth_step);
      listed->sin_zenith.push_back(grid.sin_zenith[row]), listed->cos_zenith.push_back(grid.cos_zenith[row]);
    }
    listed->list = std::make_shared<const DirectionList>(zeniths, azimuths);
    listed->sin_azimuth = {0}, listed->cos_azimuth = {1};
    listed->min_range = grid.min_range, listed->max_range = grid.max_range;
    const TraceScene scene = with_pattern(site, false, listed), of_grid = site.trace_scene(false);
    const auto tracer = GetParam().make(scene), grid_tracer = GetParam().make(of_grid);
    const auto many = static_cast<std::uint32_t>(site.stations.size());
    PassField expected, field;
    const NetworkCounts exact = grid_tracer->count(site.stations, many, {true, false, &expected}, {});
    const NetworkCounts counts = tracer->count(site.stations, many, {true, false, &field}, {});
    EXPECT_EQ(field.count, expected.count);
    EXPECT_EQ(field.stations, expected.stations);
    EXPECT_EQ(counts.points, exact.points);
    std::uint64_t rays = 0, grid_rays = 0;
    EXPECT_EQ(sampled_field(*tracer, scene, site.stations, rays).count, expected.count);
    EXPECT_EQ(sampled_field(*grid_tracer, of_grid, site.stations, grid_rays).count, expected.count);
    RecordProperty(site.name, std::to_string(rays) + " rays sampled of the list, " + std::to_string(grid_rays) +
                                  " of the grid, of " + std::to_string(exact.rays));
    EXPECT_LT(static_cast<double>(rays), 1.05 * static_cast<double>(grid_rays))
        << "a voxel needs the rays near it alone";
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, ListedConformance, testing::ValuesIn(engines_under_test()),
                         [](const auto& engine) { return engine.param.name; });

}  // namespace
}  // namespace vantage::test
