// SPDX-License-Identifier: Apache-2.0
// Scenes, scanners and networks made from bytes.
#include <array>
#include <vector>

#include "fuzz/target.hpp"
#include "scan/noise_model.hpp"
#include "scan/pattern.hpp"
#include "stress/comparison.hpp"
#include "support/reference_counts.hpp"
#include "vantage/scene_builder.hpp"
#include "vantage/simulator.hpp"

namespace vantage::fuzz {
namespace {

// Coordinates on a grid of 1/16 m meet in planes, edges and corners; others lie anywhere.
Vec3 corner(Source& from, bool on_grid) {
  const auto number = [&] {
    return on_grid ? static_cast<double>(static_cast<std::int8_t>(from.byte())) / 16 : from.between(-8, 8);
  };
  const double x = number(), y = number(), z = number();
  return {x, y, z};
}

}  // namespace

// Compares Embree with every ray against every triangle in double precision.
void reference(Bytes bytes) {
  Source from(bytes);
  Scanner scanner;
  scanner.azimuth_step = Angle::degrees(from.between(4, 20));
  scanner.zenith_step = Angle::degrees(from.between(4, 20));
  scanner.horizontal_angle = Angle::degrees(from.between(1, 360));
  scanner.vertical_angle = Angle::degrees(from.between(1, 360));
  scanner.heading = Angle::degrees(from.between(-720, 720));
  scanner.min_range_m = from.between(0, 1);
  scanner.max_range_m = scanner.min_range_m + from.between(0.1, 30);
  const double user_size = from.between(0.2, 2);
  const bool on_grid = from.byte() & 1;
  std::array<Vec3, 2> heads;
  for (Vec3& head : heads) head = corner(from, on_grid);
  SceneMesh surveyed, blocking;
  surveyed.role = Role::surveyed, blocking.role = Role::blocking;
  for (int k = 0; k < 24 && !from.empty(); ++k) {
    SceneMesh& mesh = from.byte() % 3 == 0 ? blocking : surveyed;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int c = 0; c < 3; ++c) mesh.positions.push_back(corner(from, on_grid));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  accepts([&] {
    scanner.check();
    SceneBuilder builder;
    for (const SceneMesh& mesh : {surveyed, blocking})
      if (!mesh.triangles.empty()) builder.add(mesh);
    const Scene scene = builder.build();
    TraceScene traced;
    traced.scene = std::make_shared<const SceneData>(scene.data());
    traced.grid = std::make_shared<const VoxelGrid>(VoxelGrid::build(*traced.scene, user_size));
    traced.scanners.push_back(
        {std::make_shared<const RayPattern>(make_pattern(scanner)), std::make_shared<const NoiseModel>()});
    const auto tracer = make_tracer(Engine::embree, std::nullopt, traced);
    for (std::uint32_t k = 0; k < heads.size(); ++k) {
      const Vec3 local = heads[k] - traced.scene->origin;
      const TraceStation station{
          {static_cast<float>(local.x), static_cast<float>(local.y), static_cast<float>(local.z)}, k};
      const test::Comparison found = test::compare(*tracer, traced, station);
      require(found.broken == 0, "every hit lies in range and is a number");
      require(found.unexplained == 0, "rays hit what they hit in double precision, but at edges and faces");
      require(found.range_m < 1e-3, "ranges are those of double precision");
    }
  });
}

// Any numbers are rejected, or give finite results that add up.
void simulator(Bytes bytes) {
  Source from(bytes);
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(5);
  for (Angle* angle : {&scanner.azimuth_step, &scanner.zenith_step, &scanner.horizontal_angle, &scanner.vertical_angle,
                       &scanner.zenith_start, &scanner.heading, &scanner.beam_divergence})
    if (from.byte() % 4 == 0) *angle = Angle::degrees(from.any_real());
  for (double* number : {&scanner.height_m, &scanner.min_range_m, &scanner.max_range_m, &scanner.exit_diameter_m,
                         &scanner.points_per_second})
    if (from.byte() % 4 == 0) *number = from.any_real();
  if (from.byte() % 2 == 0) {
    scanner.noise = rtc360_noise();
    if (from.byte() % 4 == 0) scanner.noise.sigma_m[from.below(8)] = from.any_real();
    if (from.byte() % 4 == 0) scanner.noise.distances_m[from.below(4)] = from.any_real();
  }
  SimulatorConfig config;
  config.engine = Engine::embree;
  config.user_size_m = from.byte() % 4 == 0 ? from.any_real() : 0.5;
  config.point_spacing_m = from.byte() % 4 == 0 ? from.any_real() : 0.2;
  config.seed = from.bits();
  config.max_memory_bytes = std::uint64_t{256} << 20;
  if (from.byte() % 4 == 0) config.max_incidence = Angle::degrees(from.any_real());
  Network network;
  for (std::uint32_t n = 1 + from.below(4); n > 0; --n) {
    Station station{.position = {from.between(-9, 9), from.between(-9, 9), from.between(-9, 9)}};
    if (from.byte() % 4 == 0) station.position.x = from.any_real();
    if (from.byte() % 4 == 0) station.setup.tilt = Angle::degrees(from.any_real());
    if (from.byte() % 4 == 0) station.setup.heading = Angle::degrees(from.any_real());
    station.active = from.byte() % 8 != 0;
    network.push_back(station);
  }
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const bool odd = from.byte() % 4 == 0;
  for (int k = 0; k < 24 && !from.empty(); ++k) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (int c = 0; c < 3; ++c)
      positions.push_back(odd ? Vec3{from.any_real(), from.any_real(), from.any_real()} : corner(from, true));
    triangles.push_back({first, first + 1, first + (odd && from.byte() == 0 ? 99 : 2)});
  }
  accepts([&] {
    scanner.check();
    if (scanner.rays() > 20'000) return;  // valid, but slow
    const Scene scene = Scene::from_triangles(positions, triangles);
    Simulator simulator(scene, scanner, config);
    if (simulator.voxel_count() > 1'000'000) return;
    VoxelField field;
    const NetworkCounts counts = simulator.evaluate(network, {.field = &field});
    const auto stations = static_cast<std::uint32_t>(network.size());
    const NetworkCounts expected =
        test::reference_counts({field.count, field.stations.all_words()}, stations, simulator.goal_density());
    require(counts.saturated == expected.saturated && counts.partial_points == expected.partial_points &&
                counts.seen == expected.seen && counts.shared == expected.shared,
            "counts are those of the field");
    const double covered = coverage(counts, simulator.goal_density());
    require(covered >= 0 && covered <= 1, "coverage lies in [0, 1]");
    const NetworkCounts sampled =
        simulator.evaluate_sampled(std::array{network}, {.voxels = simulator.voxel_count()})[0];
    require(sampled.saturated == counts.saturated && sampled.partial_points == counts.partial_points &&
                sampled.seen == counts.seen && sampled.shared == counts.shared,
            "a sample of all voxels counts what every ray does");
    for (const Station& station : network)
      simulator.scan(station, {.outputs = scan_range | scan_position | scan_normal | scan_reflectivity | scan_voxel},
                     [&](const ScanChunk& chunk) {
                       for (std::size_t k = 0; k < chunk.range_m.size(); ++k) {
                         if (!std::isfinite(chunk.range_m[k])) continue;
                         require(std::isfinite(chunk.position[k][0] + chunk.position[k][1] + chunk.position[k][2]),
                                 "a point of a hit is a number");
                         require(chunk.reflectivity[k] >= 0 && chunk.reflectivity[k] <= 1.0001f,
                                 "reflectivity lies in [0, 1]");
                       }
                     });
  });
}

}  // namespace vantage::fuzz
