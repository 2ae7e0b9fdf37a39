// SPDX-License-Identifier: Apache-2.0
#include "vantage/simulator.hpp"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <tuple>
#include <utility>

#include "support/quad_scene.hpp"
#include "trace/pass_field.hpp"
#include "trace/tracer_maker.hpp"
#include "vantage/error.hpp"
#include "vantage/objective.hpp"
#include "vantage/registration.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {
namespace {

using test::coarse_scanner;
using test::QuadScene;
using test::wall_and_floor;
using test::walls_of_two_details;

constexpr std::uint32_t everything =
    scan_range | scan_position | scan_normal | scan_reflectivity | scan_ids | scan_colour | scan_voxel;

SimulatorConfig config(double user_size = 0.5, double spacing = 0.2) {
  SimulatorConfig c;
  c.engine = Engine::embree;
  c.user_size_m = user_size;
  c.point_spacing_m = spacing;
  return c;
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::invalid_argument) << e.what();
    return e.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

// All chunks of a scan, joined.
ScanChunk whole_scan(Simulator& simulator, const Station& station, std::uint32_t place, std::uint32_t outputs,
                     ScanSummary* summary = nullptr) {
  ScanChunk all;
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  const ScanSummary sums = simulator.scan(station, {.outputs = outputs, .place = place}, [&](const ScanChunk& chunk) {
    EXPECT_EQ(chunk.first_ray, all.ray_count);  // in order, without gaps
    all.ray_count += chunk.ray_count;
    append(all.range_m, chunk.range_m);
    append(all.position, chunk.position);
    append(all.normal, chunk.normal);
    append(all.reflectivity, chunk.reflectivity);
    append(all.mesh, chunk.mesh);
    append(all.primitive, chunk.primitive);
    append(all.colour, chunk.colour);
    append(all.voxel, chunk.voxel);
  });
  if (summary) *summary = sums;
  return all;
}

TEST(Simulator, DescribesItself) {
  const Vec3 origin{500'000, 4'500'000, 120};
  const Scene scene = wall_and_floor(origin).scene();
  const Simulator simulator(scene, coarse_scanner(), config());
  EXPECT_EQ(simulator.engine().engine, Engine::embree);
  EXPECT_EQ(simulator.origin(), origin);
  EXPECT_EQ(simulator.scene().meshes().size(), 2u);
  EXPECT_EQ(simulator.scanner().columns(), 360u);
  EXPECT_EQ(simulator.config().user_size_m, 0.5);
  // Equation 2: the cube of the surveyed wall, 6 m × 1.002, halved four times.
  EXPECT_NEAR(simulator.voxel_size_m(), 6.012 / 16, 1e-5);
  EXPECT_NEAR(simulator.goal_density(), std::pow(6.012 / 16 / 0.2, 2), 1e-3);
  EXPECT_GE(simulator.voxel_count(), 16u * 10u);
  for (std::uint64_t voxel_index = 0; voxel_index < simulator.voxel_count(); ++voxel_index) {
    const Vec3 centre = simulator.voxel_centre(voxel_index) - origin;
    EXPECT_NEAR(centre.x, 5, 0.51 * simulator.voxel_size_m());
    EXPECT_LT(std::abs(centre.y), 3.2);
    EXPECT_GT(centre.z, -1.7);
    EXPECT_LT(centre.z, 2.7);
  }
}

// Building a large site takes minutes.
TEST(Simulator, IsBuiltWithProgressAndNotWhereItIsStopped) {
  const Scene scene = wall_and_floor().scene();
  const Scanner scanner = coarse_scanner();
  SimulatorConfig fine = config();
  fine.user_size_m = 0.05, fine.point_spacing_m = 0.02;
  std::vector<double> told;
  const auto report = [&](double done) { told.push_back(done); };
  const auto built = Simulator::build(scene, {&scanner, 1}, fine, {.report = report, .stop = {}});
  ASSERT_TRUE(built);
  EXPECT_EQ(built->voxel_count(), Simulator(scene, scanner, fine).voxel_count());
  ASSERT_FALSE(told.empty());
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_GE(told.front(), 0);
  EXPECT_LE(told.back(), 1);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(Simulator::build(scene, {&scanner, 1}, fine, {.stop = stop.get_token()}));
}

TEST(Simulator, RefusesGoalDensitiesBelowOneAndNamesWhatWorks) {
  const Scene scene = wall_and_floor().scene();
  for (const double user_size : {0.3, 0.09, 0.001}) {
    const std::string says = message_of([&] { Simulator(scene, coarse_scanner(), config(user_size, 0.2)); });
    EXPECT_NE(says.find("goal density is below 1"), std::string::npos) << says;
    const std::string before = "at least ";
    const double named = std::atof(says.substr(says.find(before) + before.size()).c_str());
    EXPECT_NEAR(named, 6.012 / 16, 1e-4) << says;
    const Simulator works(scene, coarse_scanner(), config(named, 0.2));
    EXPECT_GE(works.goal_density(), 1.0);
    EXPECT_NEAR(works.voxel_size_m(), named, 1e-4);
    message_of([&] { Simulator(scene, coarse_scanner(), config(named * 0.999, 0.2)); });  // nothing smaller does
  }
  EXPECT_NE(message_of([&] { Simulator(scene, coarse_scanner(), config(10, 7)); }).find("choose a point spacing below"),
            std::string::npos);
}

TEST(Simulator, RefusesBadConfigurations) {
  const Scene scene = wall_and_floor().scene();
  EXPECT_NE(message_of([&] { Simulator(scene, coarse_scanner(), config(0.5, 0)); }).find("spacing"), std::string::npos);
  EXPECT_NE(message_of([&] { Simulator(scene, coarse_scanner(), config(-1)); }).find("user size"), std::string::npos);
  EXPECT_NE(message_of([&] { Simulator(scene, coarse_scanner(-1), config()); }).find("azimuth_step"),
            std::string::npos);
}

TEST(Scan, FindsTheWallWhereItIs) {
  const Vec3 origin{1000, -2000, 50};
  Simulator simulator(wall_and_floor(origin).scene(), coarse_scanner(), config());
  ScanSummary summary;
  const ScanChunk all = whole_scan(simulator, {origin}, 0, everything, &summary);
  ASSERT_EQ(all.ray_count, 360u * 150u);
  EXPECT_EQ(summary.rays, all.ray_count);
  std::uint64_t points = 0, on_wall = 0, counted = 0;
  for (std::size_t k = 0; k < all.ray_count; ++k) {
    const RayAngles angles = simulator.scanner().angles(k);
    const double zenith = angles.zenith.in_radians(), azimuth = angles.azimuth.in_radians();
    const Vec3 d{std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)};
    const double to_wall = 5 / d.x, to_floor = -1.5 / d.z;
    const bool wall = to_wall > 0 && std::abs(to_wall * d.y) < 3 && to_wall * d.z < 2.5 && to_wall * d.z > -1.5;
    const bool floor = to_floor > 0 && std::abs(to_floor * d.x) < 10 && std::abs(to_floor * d.y) < 10;
    if (!wall && !floor) {
      EXPECT_TRUE(std::isinf(all.range_m[k]));
      EXPECT_EQ(all.mesh[k], -1);
      EXPECT_EQ(all.primitive[k], 0xFFFFFFFFu);
      EXPECT_EQ(all.colour[k], 0u);
      EXPECT_EQ(all.voxel[k], 0xFFFFFFFFu);
      continue;
    }
    const double range = wall ? to_wall : to_floor;
    ++points;
    on_wall += wall;
    counted += all.voxel[k] != 0xFFFFFFFFu;
    ASSERT_NEAR(all.range_m[k], range, 2e-5) << k;
    EXPECT_EQ(all.mesh[k], wall ? 0 : 1) << k;
    EXPECT_EQ(all.primitive[k] / 2, wall ? 0u : 1u);
    EXPECT_NEAR(all.position[k][0], range * d.x, 2e-5);
    EXPECT_NEAR(all.position[k][1], range * d.y, 2e-5);
    EXPECT_NEAR(all.position[k][2], range * d.z, 2e-5);
    EXPECT_NEAR(all.normal[k][wall ? 0 : 2], wall ? -1 : 1, 1e-6);
    EXPECT_NEAR(all.reflectivity[k], wall ? 0.5 * d.x : -0.2 * d.z, 1e-5);
    EXPECT_EQ(all.colour[k], 0xFFFFFFFFu);
    EXPECT_TRUE(wall || all.voxel[k] == 0xFFFFFFFFu);  // a blocking mesh's points do not count
    if (all.voxel[k] != 0xFFFFFFFFu) {
      const Vec3 off = simulator.voxel_centre(all.voxel[k]) - origin - d * range;
      EXPECT_LT(std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}), 0.501 * simulator.voxel_size_m());
    }
  }
  EXPECT_GT(on_wall, 1000u);
  EXPECT_EQ(summary.points, points);
  EXPECT_EQ(summary.hits_on_surveyed, on_wall);
  EXPECT_EQ(summary.points_on_surveyed, counted);
  EXPECT_EQ(counted, on_wall);  // without noise no point leaves its voxel
  EXPECT_FALSE(summary.cancelled);
}

TEST(Scan, GivesOnlyWhatWasAskedFor) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(3), config());
  const ScanChunk all = whole_scan(simulator, {{0, 0, 0}}, 0, everything);
  const auto check = [&](std::uint32_t outputs) {
    const ScanChunk some = whole_scan(simulator, {{0, 0, 0}}, 0, outputs);
    const auto is = [&](const auto& part, const auto& full, std::uint32_t bit) {
      if (outputs & bit)
        EXPECT_EQ(part, full) << bit;
      else
        EXPECT_TRUE(part.empty()) << bit;
    };
    is(some.range_m, all.range_m, scan_range);
    is(some.mesh, all.mesh, scan_ids);
    is(some.primitive, all.primitive, scan_ids);
    is(some.colour, all.colour, scan_colour);
    is(some.reflectivity, all.reflectivity, scan_reflectivity);
    is(some.voxel, all.voxel, scan_voxel);
    EXPECT_EQ(some.position.size(), outputs & scan_position ? all.position.size() : 0);
    EXPECT_EQ(some.normal.size(), outputs & scan_normal ? all.normal.size() : 0);
  };
  for (std::uint32_t bit = 1; bit <= scan_voxel; bit <<= 1) check(bit);
  check(0);
  check(scan_range | scan_colour);
  EXPECT_NE(message_of([&] {
              simulator.scan({{0, 0, 0}}, {.outputs = 1u << 20}, {});
            }).find("unknown output"),
            std::string::npos);
}

// A room so far from the survey frame's origin that floats have steps of half a metre there.
TEST(ScanPoints, AreTheHitsOfAScanInTheSurveyFrame) {
  const Vec3 far{4'500'000, 5'300'000, 100};
  Simulator simulator(wall_and_floor(far).scene(), coarse_scanner(2), config());
  const Station station{far + Vec3{0.25, 0.125, 0}};
  const ScanPoints points = simulator.scan_points(station, {.outputs = everything});
  const ScanChunk all = whole_scan(simulator, station, 0, everything);
  ASSERT_EQ(points.ray.size(), points.summary.points);
  EXPECT_LT(points.summary.points, points.summary.rays);
  EXPECT_EQ(points.summary.rays, all.ray_count);
  std::size_t hit = 0;
  for (std::uint64_t ray = 0; ray < all.ray_count; ++ray) {
    if (all.mesh[ray] < 0) continue;
    ASSERT_EQ(points.ray[hit], ray);
    EXPECT_EQ(points.range_m[hit], all.range_m[ray]);
    const auto& [x, y, z] = all.position[ray];
    EXPECT_EQ(points.position[hit], (simulator.origin() + Vec3{x, y, z}));
    const Vec3 from_head = points.position[hit] - station.position;
    EXPECT_NEAR(std::sqrt(dot(from_head, from_head)), points.range_m[hit], 1e-4);
    EXPECT_EQ(points.normal[hit], all.normal[ray]);
    EXPECT_EQ(points.reflectivity[hit], all.reflectivity[ray]);
    EXPECT_EQ(points.mesh[hit], all.mesh[ray]);
    EXPECT_EQ(points.primitive[hit], all.primitive[ray]);
    EXPECT_EQ(points.colour[hit], all.colour[ray]);
    EXPECT_EQ(points.voxel[hit], all.voxel[ray]);
    ++hit;
  }
  EXPECT_EQ(hit, points.ray.size());

  const ScanPoints positions = simulator.scan_points(station);
  EXPECT_EQ(positions.position, points.position);
  EXPECT_TRUE(positions.range_m.empty() && positions.normal.empty() && positions.mesh.empty());
  EXPECT_TRUE(simulator.scan_points({station.position, false}).ray.empty());
  EXPECT_THROW(simulator.scan_points(station, {.outputs = 1024}), Error);
}

TEST(Scan, NoiseIsKeyedBySeedPlaceAndRay) {
  Scanner scanner = coarse_scanner(2);
  scanner.noise = {.distances_m = {10}, .reflectivities = {0.5}, .sigma_m = {0.01}};
  const Scene scene = wall_and_floor().scene();
  SimulatorConfig c = config();
  Simulator simulator(scene, scanner, c), again(scene, scanner, c);
  c.seed = 2;
  Simulator other_seed(scene, scanner, c);
  c.noise = false;
  Simulator clean(scene, scanner, c);
  const Station station{{0.3, 0.1, 0}};
  const auto noisy = whole_scan(simulator, station, 0, scan_range).range_m;
  const auto exact = whole_scan(clean, station, 0, scan_range).range_m;
  EXPECT_EQ(noisy, whole_scan(again, station, 0, scan_range).range_m);
  EXPECT_NE(noisy, whole_scan(simulator, station, 1, scan_range).range_m);
  EXPECT_NE(noisy, whole_scan(other_seed, station, 0, scan_range).range_m);
  double squares = 0, hits = 0;
  for (std::size_t k = 0; k < noisy.size(); ++k) {
    ASSERT_EQ(std::isinf(noisy[k]), std::isinf(exact[k]));
    if (std::isinf(exact[k])) continue;
    EXPECT_LE(std::abs(noisy[k] - exact[k]), 0.0501);
    squares += std::pow(static_cast<double>(noisy[k] - exact[k]), 2);
    ++hits;
  }
  EXPECT_NEAR(std::sqrt(squares / hits), 0.01, 4 * 0.01 / std::sqrt(2 * hits));
}

TEST(Scan, ColoursByDirectionWhereASourceIsGiven) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(3), config());
  const auto degrees = [](Angle zenith, Angle azimuth) {
    return static_cast<std::uint32_t>(std::lround(zenith.in_degrees() * 10) << 16 |
                                      std::lround(azimuth.in_degrees() * 10 + 3600));
  };
  std::uint64_t points = 0;
  simulator.scan({{0, 0, 0}}, {.outputs = scan_colour | scan_ids, .colour = degrees}, [&](const ScanChunk& chunk) {
    for (std::size_t k = 0; k < chunk.ray_count; ++k) {
      const RayAngles angles = simulator.scanner().angles(chunk.first_ray + k);
      EXPECT_EQ(chunk.colour[k], chunk.mesh[k] < 0 ? 0u : degrees(angles.zenith, angles.azimuth));
      points += chunk.mesh[k] >= 0;
    }
  });
  EXPECT_GT(points, 100u);
}

// A camera turns with its scanner.
TEST(Scan, ColoursTurnedStationsByTheScannersOwnAngles) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(3), config());
  const Station station{{0, 0, 0}, true, {.heading = Angle::degrees(20), .tilt = Angle::degrees(70)}};
  const auto tenths = [](Angle zenith, Angle azimuth) {
    return static_cast<std::uint32_t>(std::lround(zenith.in_degrees() * 10) << 16 |
                                      std::lround(azimuth.in_degrees() * 10 + 3600));
  };
  // Back from the survey's frame: Ry(-70°) · Rz(-20°), written out.
  const auto own = [](const Vec3& d) {
    const double h = 20 * M_PI / 180, t = 70 * M_PI / 180;
    const double x = std::cos(h) * d.x + std::sin(h) * d.y, y = -std::sin(h) * d.x + std::cos(h) * d.y;
    return Vec3{std::cos(t) * x - std::sin(t) * d.z, y, std::sin(t) * x + std::cos(t) * d.z};
  };
  std::uint64_t points = 0;
  simulator.scan(station, {.outputs = scan_colour | scan_position, .colour = tenths}, [&](const ScanChunk& chunk) {
    for (std::size_t k = 0; k < chunk.ray_count; ++k) {
      const auto& p = chunk.position[k];
      if (!std::isfinite(p[0])) continue;
      const Vec3 d = own(simulator.origin() + Vec3{p[0], p[1], p[2]} - station.position);
      const auto rounded = [](double degrees) { return std::lround(degrees * 10); };
      EXPECT_LE(std::abs(rounded(std::atan2(std::hypot(d.x, d.y), d.z) * 180 / M_PI) - (chunk.colour[k] >> 16)), 1);
      EXPECT_LE(std::abs(rounded(std::atan2(d.y, d.x) * 180 / M_PI) + 3600 - (chunk.colour[k] & 0xFFFF)), 1);
      ++points;
    }
  });
  EXPECT_GT(points, 100u);
}

TEST(Simulator, HasScannersThatStationsChooseFrom) {
  const std::vector<Scanner> scanners{coarse_scanner(3), coarse_scanner(1)};
  Simulator simulator(wall_and_floor().scene(), scanners, config());
  EXPECT_EQ(simulator.scanner().azimuth_step, scanners[0].azimuth_step);
  ASSERT_EQ(simulator.scanners().size(), 2u);
  EXPECT_EQ(simulator.scanners()[1].azimuth_step, scanners[1].azimuth_step);
  // Each station counts as in a simulator with its scanner alone.
  const Network network{{{0, 0, 0}}, {{0.3, -0.2, 0.1}, true, {.scanner = 1}}};
  VoxelField together;
  const NetworkCounts counts = simulator.evaluate(network, {.field = &together});
  for (std::size_t k = 0; k < 2; ++k) {
    Simulator alone(wall_and_floor().scene(), scanners[k], config());
    VoxelField field;
    const NetworkCounts own = alone.evaluate({{network[k].position}}, {.field = &field});
    EXPECT_EQ(own.points_on_surveyed[0], counts.points_on_surveyed[k]);
    std::size_t differing = 0;
    for (std::size_t v = 0; v < field.count.size(); ++v)
      differing += (field.count[v] > 0) != ((together.stations.word(0, v) >> k & 1) != 0);
    EXPECT_EQ(differing, 0u);
  }
  const auto refusal = [&](const StationSetup& setup) {
    return message_of([&] { simulator.evaluate({{{0, 0, 0}, true, setup}}); });
  };
  EXPECT_NE(refusal({.scanner = 2}).find("scanner number 2"), std::string::npos);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal({.tilt = Angle::degrees(nan)}).find("not finite"), std::string::npos);
  EXPECT_NE(message_of([&] {
              Simulator(wall_and_floor().scene(), std::span<const Scanner>(), config());
            }).find("no scanner given"),
            std::string::npos);
}

TEST(Scan, StopsWhenTold) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(0.1), config());
  std::stop_source stop;
  std::uint64_t chunks = 0;
  double done = 0;
  const Progress progress{[&](double share) { done = share; }, stop.get_token()};
  const ScanSummary summary = simulator.scan(
      {{0, 0, 0}}, {.outputs = scan_range},
      [&](const ScanChunk&) {
        if (++chunks == 2) stop.request_stop();
      },
      progress);
  EXPECT_TRUE(summary.cancelled);
  EXPECT_EQ(chunks, 2u);
  EXPECT_LT(summary.rays, simulator.scanner().rays());
  EXPECT_NEAR(done, static_cast<double>(summary.rays) / static_cast<double>(simulator.scanner().rays()), 1e-12);
}

// A station is traced in pieces, between which it may be stopped.
TEST(Evaluate, TellsHowFarItIsWithinAStation) {
  tbb::task_arena(1).execute([] {
    Simulator simulator(wall_and_floor().scene(), coarse_scanner(0.1), config());
    std::vector<double> told;
    const Network network{{{0, 0, 0}}};
    simulator.evaluate(network, {.skip = false}, {.report = [&](double done) { told.push_back(done); }, .stop = {}});
    EXPECT_GT(told.size(), 5u);
    EXPECT_TRUE(std::ranges::is_sorted(told));
    EXPECT_LT(told.front(), 0.3);
    EXPECT_EQ(told.back(), 1);
  });
}

TEST(Evaluate, StoppedLargeNetworksAreAllSaidToBe) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(), config());
  const std::vector<Network> networks(3, Network(mask_bits + 1, Station{{0, 0, 0}}));
  std::stop_source stop;
  stop.request_stop();
  const auto counts = simulator.evaluate_sampled(networks, {.voxels = 20}, {.stop = stop.get_token()});
  ASSERT_EQ(counts.size(), networks.size());
  for (const NetworkCounts& one : counts) EXPECT_TRUE(one.cancelled);
}

TEST(Evaluate, SampledNetworksThatShareStationsCountAsEachAlone) {
  for (const bool noisy : {false, true}) {
    Scanner scanner = coarse_scanner(1);
    if (noisy) scanner.noise = load_noise("rtc360");
    Simulator simulator(wall_and_floor().scene(), scanner, config());
    const std::vector<Station> heads{{{0, 0, 0}}, {{1, 1, 0}}, {{-2, 1, 0.5}}, {{0, -2, 0}}};
    std::vector<Network> networks;
    for (unsigned chosen = 1; chosen < 16; ++chosen) {
      Network& network = networks.emplace_back();
      for (unsigned k = 0; k < heads.size(); ++k)
        if ((chosen >> k & 1) != 0) network.push_back(heads[k]);
    }
    for (const CountTo count_to : {CountTo::all, CountTo::goal, CountTo::one}) {
      const SampleOptions options{.voxels = 200, .count_to = count_to, .registration = RegistrationModel{}};
      const std::uint64_t before = simulator.work().sampled_rays;
      const auto together = simulator.evaluate_sampled(networks, options);
      const std::uint64_t rays = simulator.work().sampled_rays - before;
      std::uint64_t alone_rays = 0;
      for (std::size_t k = 0; k < networks.size(); ++k) {
        const NetworkCounts alone = simulator.evaluate_sampled({&networks[k], 1}, options)[0];
        alone_rays += alone.rays;
        EXPECT_EQ(together[k].seen, alone.seen) << k;
        EXPECT_EQ(together[k].shared, alone.shared) << k;
        EXPECT_EQ(together[k].registration.pairs, alone.registration.pairs) << k;
        if (count_to == CountTo::one) continue;  // the rest of the points are as they come
        EXPECT_EQ(together[k].saturated, alone.saturated) << k;
        EXPECT_EQ(together[k].partial_points, alone.partial_points) << k;
        EXPECT_EQ(together[k].successive_difference_sum, alone.successive_difference_sum) << k;
      }
      EXPECT_GT(rays, 0u);
      // Noise depends on the place in a network, by which there are 9 different stations, and without it 4, of 32.
      EXPECT_LT(rays, alone_rays / 2) << noisy;
    }
  }
}

TEST(Evaluate, StopsBeforeThePlanesOfRegistrationAndMakesThemLater) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(), config()),
      fresh(wall_and_floor().scene(), coarse_scanner(), config());
  const std::vector<Network> networks{{Station{{0, 0, 0}}, Station{{0.3, 0, 0}}}};
  const SampleOptions options{.voxels = 20, .overlap = true, .registration = RegistrationModel{}};
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(simulator.evaluate_sampled(networks, options, {.stop = stop.get_token()})[0].cancelled);
  const NetworkCounts later = simulator.evaluate_sampled(networks, options)[0],
                      expected = fresh.evaluate_sampled(networks, options)[0];
  EXPECT_FALSE(later.cancelled);
  EXPECT_FALSE(expected.registration.pairs.empty());
  EXPECT_EQ(later.registration.pairs, expected.registration.pairs);
}

TEST(Scan, InactiveAndImpossibleStations) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(), config());
  const ScanSummary summary =
      simulator.scan({{0, 0, 0}, false}, {.outputs = scan_range}, [](const ScanChunk&) { ADD_FAILURE() << "a chunk"; });
  EXPECT_EQ(summary.rays, 0u);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double far : {nan, -1e198, 2e6})
    EXPECT_NE(message_of([&] {
                simulator.scan({{0, far, 0}}, {.place = 3}, {});
              }).find("station 4"),
              std::string::npos);
}

TEST(Evaluate, AgreesWithScans) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(0.7), config(0.5, 0.04));
  const Network network{{{0, 0, 0}}, {{1, -2, 0.5}}};
  VoxelField field;
  const NetworkCounts counts = simulator.evaluate(network, {.skip = false, .field = &field});
  PassField expected{std::vector<std::uint32_t>(simulator.voxel_count()),
                     std::vector<std::uint64_t>(simulator.voxel_count())};
  for (std::uint32_t place = 0; place < 2; ++place) {
    ScanSummary summary;
    for (const std::uint32_t voxel : whole_scan(simulator, network[place], place, scan_voxel, &summary).voxel) {
      if (voxel == 0xFFFFFFFFu) continue;
      ++expected.count[voxel];
      expected.stations[voxel] |= 1ull << place;
    }
    EXPECT_EQ(counts.points.at(place), summary.points);
    EXPECT_EQ(counts.points_on_surveyed.at(place), summary.points_on_surveyed);
  }
  EXPECT_EQ(field.count, expected.count);
  EXPECT_EQ(field.stations.all_words(), expected.stations);
  const double share = coverage(counts, simulator.goal_density());
  EXPECT_GT(share, 0.3);
  EXPECT_LT(share, 1.0);
}

TEST(Evaluate, TakesOneToSoManyStations) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(5), config());
  EXPECT_NE(message_of([&] { simulator.evaluate({}); }).find("this one has 0"), std::string::npos);
  EXPECT_NE(message_of([&] {
              simulator.evaluate(Network(1025, Station{{0, 0, 0}}));
            }).find("this one has 1025"),
            std::string::npos);
  const Network too_many(1025, Station{{0, 0, 0}});
  EXPECT_NE(message_of([&] { simulator.evaluate_sampled({&too_many, 1}); }).find("1 to 1024"), std::string::npos);
  Network full(64, Station{{0, 0, 0}});
  const NetworkCounts counts = simulator.evaluate(full);
  EXPECT_EQ(counts.stations, 64u);
  EXPECT_EQ(counts.shared.size(), 64u * 63u / 2);
  EXPECT_DOUBLE_EQ(clustering_coefficient(overlap_matrix(counts)), 1.0);  // stations at one place see the same
  EXPECT_EQ(clustering_coefficient(overlap_matrix(simulator.evaluate({full[0]}))), 0.0);
}

TEST(Evaluate, InactiveStationsKeepTheirPlace) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(1), config());
  const Station a{{0, 0, 0}}, b{{1, 1, 0}}, off{{2, 0, 0}, false};
  const NetworkCounts two = simulator.evaluate({a, b}), four = simulator.evaluate({off, a, off, b});
  EXPECT_EQ(four.stations, 4u);
  EXPECT_EQ(four.saturated, two.saturated);
  EXPECT_EQ(four.partial_points, two.partial_points);
  EXPECT_EQ(four.seen, (std::vector<std::uint64_t>{0, two.seen[0], 0, two.seen[1]}));
  EXPECT_EQ(four.shared_by(1, 3), two.shared_by(0, 1));
  EXPECT_EQ(four.shared_by(0, 1), 0u);
  EXPECT_EQ(four.points_on_surveyed,
            (std::vector<std::uint64_t>{0, two.points_on_surveyed[0], 0, two.points_on_surveyed[1]}));
}

TEST(Evaluate, NetworksWithoutAnActiveStationSeeNothing) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(1), config());
  const Network none(3, Station{{0, 0, 0}, false}), one{{{0, 0, 0}}};
  VoxelField field;
  const NetworkCounts counts = simulator.evaluate(none, {.skip = false, .field = &field});
  EXPECT_EQ(counts.stations, 3u);
  EXPECT_EQ(counts.voxels, simulator.voxel_count());
  EXPECT_EQ(counts.points, std::vector<std::uint64_t>(3, 0));
  EXPECT_EQ(counts.seen, std::vector<std::uint64_t>(3, 0));
  EXPECT_EQ(coverage(counts, simulator.goal_density()), 0.0);
  EXPECT_EQ(clustering_coefficient(overlap_matrix(counts)), 0.0);
  EXPECT_EQ(field.count, std::vector<std::uint32_t>(simulator.voxel_count(), 0));

  const std::vector<Network> networks{none, one, none};
  const auto sampled = simulator.evaluate_sampled(networks, {.voxels = 50});
  ASSERT_EQ(sampled.size(), 3u);
  EXPECT_EQ(sampled[0].partial_points + sampled[0].saturated, 0u);
  EXPECT_GT(sampled[1].partial_points + sampled[1].saturated, 0u);
  ASSERT_EQ(sampled[0].groups.size(), sampled[1].groups.size());
  for (std::size_t g = 0; g < sampled[0].groups.size(); ++g)
    EXPECT_EQ(sampled[0].groups[g].voxels, sampled[1].groups[g].voxels);
  EXPECT_EQ(coverage_estimate(sampled[0], simulator.goal_density(), simulator.voxel_count()).standard_error, 0.0);
  EXPECT_EQ(overlap_estimate(sampled[2], simulator.voxel_count()).standard_error, 0.0);
  EXPECT_EQ(simulator.evaluate_sampled(std::vector<Network>{none}, {.voxels = 50})[0].voxels, 50u);
}

TEST(Evaluate, GoesByTheGoalOfEachVoxel) {
  Scanner scanner = coarse_scanner(2);
  scanner.beam_divergence = Angle::radians(1e-4), scanner.exit_diameter_m = 0.005;
  SimulatorConfig by_detail = config(0.5, 0.2);
  by_detail.spacing_by_detail = true;
  Simulator simulator(walls_of_two_details().scene(), scanner, by_detail);
  EXPECT_DOUBLE_EQ(simulator.goal_density(), std::pow(simulator.voxel_size_m() / 0.08, 2));
  const Network network{{{0, 0, 0}}, {{1, -2, 0.5}}};
  VoxelField field;
  const NetworkCounts counts = simulator.evaluate(network, {.field = &field});
  double sum = 0;
  std::array<int, 2> voxels{}, full{};
  for (std::uint64_t voxel_index = 0; voxel_index < simulator.voxel_count(); ++voxel_index) {
    const bool coarse = simulator.voxel_centre(voxel_index).x < 0;
    const double goal = std::pow(simulator.voxel_size_m() / (coarse ? 0.2 : 0.08), 2);
    EXPECT_NEAR(simulator.goal_density(voxel_index), goal, goal / 4096);
    sum += std::min(field.count[voxel_index] / simulator.goal_density(voxel_index), 1.0);
    ++voxels[coarse];
    full[coarse] += field.count[voxel_index] >= goal;
  }
  EXPECT_NEAR(coverage(counts, simulator.goal_density()), sum / static_cast<double>(simulator.voxel_count()), 1e-12);
  // The same points fill one wall and not the other.
  EXPECT_LT(full[0], voxels[0] / 2);
  EXPECT_GT(full[1], voxels[1] / 2);
  EXPECT_EQ(counts.saturated, static_cast<std::uint64_t>(full[0] + full[1]));
  const NetworkCounts sampled =
      simulator.evaluate_sampled({&network, 1}, {.voxels = simulator.voxel_count(), .count_to = CountTo::goal})[0];
  EXPECT_EQ(sampled.saturated, counts.saturated);
  EXPECT_EQ(coverage(sampled, simulator.goal_density()), coverage(counts, simulator.goal_density()));
  by_detail.spacing_by_detail = false;
  EXPECT_DOUBLE_EQ(Simulator(walls_of_two_details().scene(), scanner, by_detail).goal_density(3),
                   std::pow(simulator.voxel_size_m() / 0.2, 2));
}

TEST(EvaluateSampled, AllVoxelsAreExact) {
  Scanner scanner = coarse_scanner(0.7);
  scanner.noise = {.distances_m = {10}, .reflectivities = {0.5}, .sigma_m = {0.02}};
  Simulator simulator(wall_and_floor().scene(), scanner, config(0.2, 0.1));
  const Network network{{{0, 0, 0}}, {{1, -2, 0.5}}, {{3, 1, -0.4}}};
  const NetworkCounts exact = simulator.evaluate(network);
  const NetworkCounts all = simulator.evaluate_sampled({&network, 1}, {.voxels = simulator.voxel_count() + 10})[0];
  EXPECT_EQ(all.voxels, exact.voxels);
  EXPECT_EQ(all.saturated, exact.saturated);
  EXPECT_EQ(all.partial_points, exact.partial_points);
  EXPECT_EQ(all.seen, exact.seen);
  EXPECT_EQ(all.shared, exact.shared);
  EXPECT_EQ(coverage_estimate(all, simulator.goal_density(), simulator.voxel_count()).standard_error, 0.0);

  const NetworkCounts stopped = simulator.evaluate_sampled(
      {&network, 1}, {.voxels = simulator.voxel_count(), .overlap = false, .count_to = CountTo::goal})[0];
  EXPECT_EQ(coverage(stopped, simulator.goal_density()), coverage(exact, simulator.goal_density()));
  EXPECT_NE(message_of([&] {
              simulator.evaluate_sampled({&network, 1}, {.voxels = 0});
            }).find("at least one"),
            std::string::npos);
}

TEST(Registration, OfAllVoxelsIsExactAndOfASampleNear) {
  Simulator simulator(wall_and_floor().scene(), coarse_scanner(0.5), config(0.1, 0.05));
  const Network network{{{0, 0, 0}}, {{1, -2, 0.5}}, {{3, 1, -0.4}}};
  const RegistrationModel model;
  const NetworkCounts exact = simulator.evaluate(network, {.registration = model});
  const NetworkCounts all =
      simulator.evaluate_sampled({&network, 1}, {.voxels = simulator.voxel_count(), .registration = model})[0];
  EXPECT_EQ(all.registration.pairs, exact.registration.pairs);
  EXPECT_EQ(all.registration.surface, exact.registration.surface);
  EXPECT_EQ(registration_estimate(all, simulator.voxel_count()).standard_error, 0.0);
  ASSERT_EQ(all.groups.size(), 20u);
  EXPECT_EQ(all.registration.groups[3].pairs.size(), exact.registration.pairs.size());
  const double whole = registration_error(exact, simulator.voxel_count()).rms_m;
  EXPECT_GT(whole, 0);

  const NetworkCounts some =
      simulator.evaluate_sampled({&network, 1}, {.voxels = simulator.voxel_count() / 2, .registration = model})[0];
  const Estimate estimate = registration_estimate(some, simulator.voxel_count());
  EXPECT_GT(estimate.standard_error, 0);
  EXPECT_NEAR(estimate.value, whole, 5 * estimate.standard_error);

  const NetworkCounts search = simulator.evaluate_sampled(
      {&network, 1}, {.voxels = simulator.voxel_count() / 2, .registration = model, .groups = false})[0];
  EXPECT_EQ(search.registration.pairs, some.registration.pairs);
  EXPECT_EQ(search.saturated, some.saturated);
  EXPECT_EQ(search.shared, some.shared);
  EXPECT_TRUE(search.groups.empty());
  EXPECT_TRUE(simulator.evaluate(network).registration.heads.empty());
  EXPECT_NE(message_of([&] { simulator.evaluate(network, {.overlap = false, .registration = model}); }).find("overlap"),
            std::string::npos);
  const Network none{{{0, 0, 0}, false}, {{1, 0, 0}, false}};
  EXPECT_NEAR(registration_error(simulator.evaluate(none, {.registration = model}), 1).rms_m, 0.03 * std::sqrt(3.0),
              1e-12);
}

// A surveyed panel in a room that is not surveyed.
QuadScene panel_in_a_room() {
  QuadScene scene;
  scene.quad({4.9f, -1, -0.5f}, {0, 2, 0}, {0, 0, 1.5f});
  const Role other = Role::blocking;
  scene.quad({-5, -4, -1.5f}, {10, 0, 0}, {0, 8, 0}, other).quad({-5, -4, 2}, {10, 0, 0}, {0, 8, 0}, other);
  scene.quad({5, -4, -1.5f}, {0, 8, 0}, {0, 0, 3.5f}, other).quad({-5, -4, -1.5f}, {0, 8, 0}, {0, 0, 3.5f}, other);
  scene.quad({-5, 4, -1.5f}, {10, 0, 0}, {0, 0, 3.5f}, other).quad({-5, -4, -1.5f}, {10, 0, 0}, {0, 0, 3.5f}, other);
  return scene;
}

TEST(Registration, GoesByTheScansThatSurroundingsStandFor) {
  Scanner scanner = coarse_scanner(0.1);
  scanner.noise = {.distances_m = {10}, .reflectivities = {0.5}, .sigma_m = {0.02}};
  Simulator simulator(panel_in_a_room().scene(), scanner, config(0.1, 0.05));
  const Network network{{{0, 0, 0}}, {{-2, 1, 0.2}}};
  const RegistrationOptions surveyed, all{.surfaces = RegistrationSurfaces::all};
  const NetworkCounts counts = simulator.evaluate(network, {.registration = all.model});
  Simulator around = surroundings_of(simulator);
  const NetworkCounts held = around.evaluate(network, {.registration = all.model});
  const double one_panel = registration_error(counts, counts.voxels, surveyed).rms_m;
  const double whole_room = registration_error(counts, counts.voxels, all, &held, held.voxels).rms_m;
  EXPECT_LT(whole_room, one_panel / 5);

  // The same room with everything surveyed, by all rays of the scanner.
  QuadScene open = panel_in_a_room();
  for (MeshInfo& mesh : open.data().meshes) mesh.role = Role::surveyed;
  Simulator fine(open.scene(), scanner, config(0.1, 0.05));
  const NetworkCounts seen = fine.evaluate(network, {.registration = all.model});
  const double by_all_rays = registration_error(counts, counts.voxels, all, &seen, seen.voxels).rms_m;
  EXPECT_NEAR(whole_room, by_all_rays, 0.05 * by_all_rays);

  // And for samples of both, within their errors.
  const NetworkCounts few =
      simulator.evaluate_sampled({&network, 1}, {.voxels = counts.voxels / 2, .registration = all.model})[0];
  const NetworkCounts few_around =
      around.evaluate_sampled({&network, 1}, {.voxels = held.voxels / 2, .registration = all.model})[0];
  const Estimate estimate = registration_estimate(few, counts.voxels, all, &few_around, held.voxels);
  EXPECT_GT(estimate.standard_error, registration_estimate(few, counts.voxels, all, &held, held.voxels).standard_error);
  EXPECT_NEAR(estimate.value, whole_room, 4 * estimate.standard_error);
}

// Scanners whose pattern is no even grid are thinned out for the surroundings, too: they see nearly as much of them.
TEST(Surroundings, TakeListsOfDirectionsAndUnevenRows) {
  Scanner grid = coarse_scanner(0.1), list = grid, rows = grid;
  std::vector<RayAngles> directions;
  for (std::uint64_t ray = 0; ray < grid.rays(); ++ray)
    directions.push_back(grid.angles(ray * 2'654'435'761u % grid.rays()));
  list.set_directions(directions);
  std::vector<Angle> zeniths;
  for (double zenith = 0.1; zenith < 150; zenith += zenith < 90 ? 0.08 : 0.12)
    zeniths.push_back(Angle::degrees(zenith));
  rows.set_row_zeniths(zeniths);
  const Network network{{{0, 0, 0}}};
  std::vector<double> seen;
  for (const Scanner& scanner : {grid, list, rows}) {
    Simulator simulator(panel_in_a_room().scene(), scanner, config(0.1, 0.05));
    Simulator around = surroundings_of(simulator);
    seen.push_back(static_cast<double>(around.evaluate(network).seen[0]));
    EXPECT_LT(around.scanner().rays(), scanner.rays() * 3 / 4);
  }
  EXPECT_NEAR(seen[1], seen[0], 0.05 * seen[0]);
  EXPECT_NEAR(seen[2], seen[0], 0.05 * seen[0]);
}

TEST(Simulator, TwoCoexistAndCanBeMoved) {
  const Scene scene = wall_and_floor().scene();
  Simulator a(scene, coarse_scanner(2), config()), b(scene, coarse_scanner(3), config());
  const Network network{{{0, 0, 0}}};
  const std::uint64_t points = a.evaluate(network).points_on_surveyed[0];
  EXPECT_GT(points, b.evaluate(network).points_on_surveyed[0]);
  Simulator moved(std::move(a));
  EXPECT_EQ(moved.evaluate(network).points_on_surveyed[0], points);
  b = std::move(moved);
  EXPECT_EQ(b.evaluate(network).points_on_surveyed[0], points);
}

// Networks of a room with unlike counts, and what one thread alone counts of them.
struct SeveralCallers {
  Simulator simulator{wall_and_floor().scene(), coarse_scanner(0.2), config()};
  std::vector<Network> networks = {
      {{{0, 0, 0}}}, {{{0.5, 0.3, 0.2}}}, {{{0, 0, 0}}, {{1, 0.5, 0}}}, {{{-1, 0.2, 0.1}}}};
  std::vector<NetworkCounts> exact = simulator.evaluate_each(networks);
  std::vector<NetworkCounts> sampled = simulator.evaluate_sampled(networks, {.voxels = 50});

  // Returns true if calls give the same as before for network k.
  bool agrees(std::size_t k) {
    const auto same = [](const NetworkCounts& a, const NetworkCounts& b) {
      return std::tie(a.saturated, a.partial_points, a.rays, a.points_on_surveyed, a.seen, a.shared) ==
             std::tie(b.saturated, b.partial_points, b.rays, b.points_on_surveyed, b.seen, b.shared);
    };
    return same(simulator.evaluate(networks[k]), exact[k]) &&
           same(simulator.evaluate_sampled({&networks[k], 1}, {.voxels = 50}).front(), sampled[k]);
  }
};

TEST(Simulator, ServesSeveralThreadsOneAfterAnother) {
  SeveralCallers callers;
  std::atomic<int> wrong = 0;
  {
    std::vector<std::jthread> threads;
    for (std::size_t k = 0; k < callers.networks.size(); ++k)
      threads.emplace_back([&, k] {
        for (int time = 0; time < 20; ++time)
          if (!callers.agrees(k)) ++wrong;
      });
  }
  EXPECT_EQ(wrong, 0);
}

// A thread that waits within a call could be given another of these tasks, which would call the simulator again.
TEST(Simulator, ServesTasksThatShareTheThreadsOfOneArena) {
  SeveralCallers callers;
  std::atomic<int> wrong = 0;
  tbb::task_arena arena(4);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, std::size_t{80}, [&](std::size_t k) {
      if (!callers.agrees(k % callers.networks.size())) ++wrong;
    });
  });
  EXPECT_EQ(wrong, 0);
}

TEST(Simulator, RefusesToBeCalledByACallbackOfItsOwnCall) {
  SeveralCallers callers;
  Simulator& simulator = callers.simulator;
  int refused = 0;
  const auto call_again = [&] {
    EXPECT_NE(message_of([&] { simulator.evaluate(callers.networks[0]); }).find("a callback of"), std::string::npos);
    ++refused;
  };
  simulator.scan({{0, 0, 0}}, {}, [&](const ScanChunk&) { call_again(); });
  EXPECT_GE(std::exchange(refused, 0), 1);
  simulator.evaluate_sampled(callers.networks, {.points = [&](auto, auto) { call_again(); }});
  EXPECT_EQ(std::exchange(refused, 0), 4);
  const NetworkCounts counts =
      simulator.evaluate(callers.networks[0], {}, {.report = [&](double) { call_again(); }, .stop = {}});
  EXPECT_GE(refused, 1);
  EXPECT_EQ(counts.partial_points, callers.exact[0].partial_points);
  EXPECT_TRUE(callers.agrees(0));  // and it serves again
}

// Stands for other processes that share the work, but leaves all of it to the simulator's own tracer.
struct Counted final : TracerMaker {
  std::unique_ptr<Tracer> make(std::unique_ptr<Tracer> own, const TraceScene& scene,
                               std::uint64_t fingerprint) override {
    fingerprints.push_back(fingerprint);
    voxels.push_back(scene.grid->size());
    return own;
  }
  std::size_t networks_at_once() const override { return 1; }
  std::vector<std::uint64_t> fingerprints, voxels;
};

TEST(Simulator, SharesItsTracingOnlyIfToldTo) {
  const Scene scene = wall_and_floor().scene();
  const auto maker = std::make_shared<Counted>();
  SimulatorConfig sharing = config();
  sharing.shared = maker;
  Simulator simulator(scene, coarse_scanner(2), sharing), alone(scene, coarse_scanner(2), config());
  EXPECT_EQ(maker->fingerprints, std::vector{scene.fingerprint()});
  EXPECT_EQ(maker->voxels, std::vector{simulator.voxel_count()});
  const Network network{{{0, 0, 0}}};
  EXPECT_EQ(simulator.evaluate(network).partial_points, alone.evaluate(network).partial_points);
  surroundings_of(simulator);
  EXPECT_EQ(maker->fingerprints.size(), 2u);
}

}  // namespace
}  // namespace vantage
