// SPDX-License-Identifier: Apache-2.0
#include "scan/wide_beam.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/philox.hpp"
#include "support/quad_scene.hpp"
#include "vantage/error.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage {
namespace {

using test::QuadScene;

constexpr double kExit_m = 0.006, kDivergence = 5e-4;
constexpr double kWall_m = 10;
// Radius of the footprint on the wall, to 1/e².
const double kRadius_m = std::hypot(kExit_m, kDivergence* kWall_m) / 2;
constexpr float kR = 0.5f;

// Rays around the x axis, a third of a millimetre apart on a wall at 10 m: two in each bin of means().
Scanner narrow_scanner() {
  Scanner scanner;
  scanner.horizontal_angle = Angle::degrees(0.6);
  scanner.zenith_start = Angle::degrees(89.7);
  scanner.vertical_angle = Angle::degrees(2 * 0.6);
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(0.002);
  scanner.max_range_m = 40;
  scanner.beam_divergence = Angle::radians(kDivergence);
  scanner.exit_diameter_m = kExit_m;
  return scanner;
}

// A wall square on at distance x, from y = low to high.
void add_wall(QuadScene& scene, float x, float low, float high) {
  scene.quad({x, low, -1}, {0, high - low, 0}, {0, 0, 2}, Role::surveyed, static_cast<double>(kR));
}

// Share of the power in the middle of 7 and of 19 sub-rays, which an edge takes or leaves as a whole.
double middle_share(std::uint32_t sub_rays) { return sub_rays == 7 ? 0.32 : 0.12; }

struct Return {
  double y, x, part;  // of the ray on a wall at 10 m; of the point; of the strength of a whole footprint
  int number;
};

std::vector<Return> scanned(const QuadScene& scene, const BeamOptions& beam, ScanSummary* summary = nullptr,
                            const Scanner& scanner = narrow_scanner()) {
  Simulator simulator(scene.scene(), scanner, {.engine = Engine::embree, .user_size_m = 0.02});
  std::vector<Return> all;
  const ScanSummary sums = simulator.scan(
      {{0, 0, 0}}, {.outputs = scan_position | scan_range | scan_reflectivity | scan_returns, .beam = beam},
      [&](const ScanChunk& chunk) {
        for (std::size_t k = 0; k < chunk.ray_count; ++k) {
          if (!std::isfinite(chunk.range_m[k])) continue;
          EXPECT_LE(chunk.return_number, chunk.returns[k]);
          const double azimuth = scanner.angles(chunk.first_ray + k).azimuth.in_radians();
          all.push_back({kWall_m * std::tan(azimuth), static_cast<double>(chunk.position[k][0]),
                         static_cast<double>(chunk.reflectivity[k] / kR), static_cast<int>(chunk.return_number)});
        }
      });
  if (summary) *summary = sums;
  return all;
}

// Share of a Gaussian beam's power on y < 0, if its axis is at y.
double share_below(double y) { return (1 - std::erf(std::sqrt(2) * y / kRadius_m)) / 2; }

// Means of a value over rays in bins of y of a sixth of the radius.
template <class Value>
std::map<int, double> means(const std::vector<Return>& returns, const Value& value) {
  std::map<int, std::pair<double, int>> sums;
  for (const Return& one : returns) {
    auto& [sum, count] = sums[static_cast<int>(std::floor(one.y / kRadius_m * 6))];
    sum += value(one), ++count;
  }
  std::map<int, double> result;
  for (const auto& [bin, sum] : sums) result[bin] = sum.first / sum.second;
  return result;
}

TEST(WideBeam, AFootprintThatIsHalfCoveredReturnsHalfTheStrength) {
  QuadScene scene;
  add_wall(scene, kWall_m, -1, 0);
  for (const std::uint32_t sub_rays : {7u, 19u}) {
    double sum = 0;
    int rays = 0;
    const std::vector<Return> returns = scanned(scene, {.sub_rays = sub_rays});
    for (const Return& one : returns)
      if (std::abs(one.y) < 1e-3) sum += one.part, ++rays;
    EXPECT_GT(rays, 200);
    EXPECT_NEAR(sum / rays, 0.5, sub_rays == 7 ? 0.03 : 0.02);
    for (const auto& [bin, part] : means(returns, [](const Return& one) { return one.part; })) {
      const double y = (bin + 0.5) / 6 * kRadius_m;
      if (std::abs(y) < 0.7 * kRadius_m) {
        EXPECT_NEAR(part, share_below(y), middle_share(sub_rays) / 2) << y;
      }
      if (y < -1.2 * kRadius_m) {
        EXPECT_NEAR(part, 1, 1e-4);
      }
    }
    EXPECT_TRUE(std::ranges::all_of(returns, [](const Return& one) { return one.y < kRadius_m; }));
  }
}

// Two walls 0.2 m apart, less than half of a pulse: where the beam meets both, the points lie between them, by the
// shares of the beam's power and the squares of the distances.
TEST(WideBeam, PointsOfAStepEdgeFollowTheBeam) {
  QuadScene scene;
  add_wall(scene, kWall_m, -1, 0);
  add_wall(scene, kWall_m + 0.2f, -1, 1);
  ScanSummary summary;
  const std::vector<Return> returns = scanned(scene, {.sub_rays = 19}, &summary);
  EXPECT_EQ(returns.size(), narrow_scanner().rays());
  const auto expected = [](double y) {
    const double front = share_below(y) / (10 * 10), back = (1 - share_below(y)) / (10.2 * 10.2);
    return (front * 10 + back * 10.2) / (front + back);
  };
  for (const auto& [bin, x] : means(returns, [](const Return& one) { return one.x; })) {
    const double y = (bin + 0.5) / 6 * kRadius_m;
    EXPECT_NEAR(x, expected(y), 0.016) << y;
  }
  // Density of the points: as many lie in the middle half of the step as rays meet the wall where the beam says so.
  double from = 0, to = 0;
  for (double y = -kRadius_m; y < kRadius_m; y += 1e-6) {
    if (expected(y) < 10.05) from = y;
    if (expected(y) < 10.15) to = y;
  }
  const Scanner scanner = narrow_scanner();
  const double rows = static_cast<double>(scanner.rows()), step = kWall_m * scanner.azimuth_step.in_radians();
  const auto between = std::ranges::count_if(returns, [](const Return& r) { return r.x > 10.05 && r.x < 10.15; });
  EXPECT_NEAR(static_cast<double>(between) / (rows * (to - from) / step), 1, middle_share(19));
  const auto off = std::ranges::count_if(
      returns, [](const Return& r) { return std::abs(r.x - 10) > 0.005 && std::abs(r.x - 10.2) > 0.005; });
  EXPECT_EQ(summary.mixed.points, static_cast<std::uint64_t>(off));
  EXPECT_LT(summary.mixed.counted, summary.mixed.points) << "most lie in no voxel of either wall";
  EXPECT_EQ(summary.mixed.wrong_voxel, 0u) << "there is no other surface";
}

TEST(WideBeam, SurfacesFartherApartAreReturnsOfTheirOwn) {
  QuadScene scene;
  add_wall(scene, kWall_m, -1, 0);
  add_wall(scene, kWall_m + 2, -1, 1);
  ScanSummary summary;
  const std::vector<Return> all = scanned(scene, {.sub_rays = 19, .returns = Returns::all}, &summary),
                            first = scanned(scene, {.sub_rays = 19, .returns = Returns::first}),
                            last = scanned(scene, {.sub_rays = 19, .returns = Returns::last}),
                            strongest = scanned(scene, {.sub_rays = 19, .returns = Returns::strongest});
  EXPECT_EQ(summary.mixed, MixedPoints{});
  EXPECT_EQ(summary.rays, narrow_scanner().rays());
  EXPECT_EQ(summary.points, all.size());
  std::map<double, double> parts;
  std::size_t seconds = 0;
  double sum = 0;
  for (const Return& one : all) {
    EXPECT_NEAR(one.x, one.x < 11 ? 10 : 12, 1e-4);
    if (one.number == 2) {
      EXPECT_NEAR(one.x, 12, 1e-4);
      ++seconds;
    }
    sum += one.part;
  }
  EXPECT_GT(seconds, 500u);
  EXPECT_NEAR(sum, static_cast<double>(narrow_scanner().rays()), 5) << "the shares of a ray's returns add up to one";
  const auto on_front = [](const std::vector<Return>& returns) {
    return static_cast<std::size_t>(std::ranges::count_if(returns, [](const Return& r) { return r.x < 11; }));
  };
  EXPECT_EQ(first.size(), narrow_scanner().rays());
  EXPECT_EQ(last.size(), narrow_scanner().rays());
  EXPECT_EQ(on_front(first) - on_front(last), seconds);
  EXPECT_GT(on_front(first), on_front(strongest));
  EXPECT_GT(on_front(strongest), on_front(last));
}

// A screen of leaves of 4 mm, each there by chance, with 30 % holes: so much of the power reaches the wall behind it.
TEST(WideBeam, AScreenLetsThroughTheShareOfItsHoles) {
  constexpr float cell = 0.004f;
  constexpr int cells = 50;
  QuadScene scene;
  RandomStream random(5);
  int holes = 0;
  for (int i = -cells / 2; i < cells / 2; ++i)
    for (int j = -cells / 2; j < cells / 2; ++j) {
      if (random.uniform() < 0.3) {
        ++holes;
        continue;
      }
      const float y = static_cast<float>(i) * cell, z = static_cast<float>(j) * cell;
      scene.quad({kWall_m, y, z}, {0, cell, 0}, {0, 0, cell}, Role::surveyed, static_cast<double>(kR));
    }
  add_wall(scene, kWall_m + 3, -1, 1);
  // The rays cover 0.105 m square: the mean over all places of the pattern differs from that of the whole screen as
  // the 690 cells there do.
  const std::vector<Return> returns = scanned(scene, {.returns = Returns::all});
  double front = 0, back = 0;
  for (const Return& one : returns) (one.x < 11 ? front : back) += one.part;
  const double rays = static_cast<double>(narrow_scanner().rays()),
               share = static_cast<double>(holes) / (cells * cells);
  EXPECT_NEAR(front + back, rays, 1e-3 * rays);
  EXPECT_NEAR(back / rays, share, 4 * std::sqrt(0.3 * 0.7 / 690));
  EXPECT_NEAR(back / rays, 0.3, 0.08);
}

TEST(WideBeam, AWallWithoutEdgesHasThePointsOfThinRays) {
  QuadScene scene;
  add_wall(scene, kWall_m, -1, 1);
  Simulator simulator(scene.scene(), narrow_scanner(), {.engine = Engine::embree, .user_size_m = 0.05});
  const ScanOptions options{.outputs = scan_position | scan_voxel};
  ScanOptions wide = options;
  wide.beam = BeamOptions{};
  const ScanPoints thin = simulator.scan_points({{0, 0, 0}}, options),
                   points = simulator.scan_points({{0, 0, 0}}, wide);
  ASSERT_EQ(points.ray, thin.ray);
  EXPECT_EQ(points.voxel, thin.voxel);
  for (std::size_t k = 0; k < thin.position.size(); ++k) {
    const Vec3 between = points.position[k] - thin.position[k];
    EXPECT_LT(dot(between, between), 1e-10);
  }
  EXPECT_EQ(points.summary.mixed, MixedPoints{});
  EXPECT_EQ(points.summary.points_on_surveyed, thin.summary.points_on_surveyed);
}

// The weaker half of a footprint is lost where the whole is just detected.
TEST(WideBeam, EachReturnIsJudgedByItsOwnStrength) {
  QuadScene scene;
  add_wall(scene, kWall_m, -1, 0);
  Scanner scanner = narrow_scanner();
  scanner.detection_range_m = 12;  // of the whole: (10/12)² = 0.69 of a footprint suffices
  scanner.detection_reflectivity = static_cast<double>(kR);
  double least = 1;
  for (const Return& one : scanned(scene, {.sub_rays = 19}, nullptr, scanner)) least = std::min(least, one.part);
  EXPECT_GT(least, 0.69);
  EXPECT_LT(least, 0.8);
}

// A wall before another one, and a plate between the two that points of the step fall upon, though hardly a ray meets
// it.
QuadScene step_over_a_plate() {
  QuadScene scene;
  add_wall(scene, kWall_m, -1, 0);
  add_wall(scene, kWall_m + 0.2f, -1, 1);
  scene.quad({kWall_m + 0.04f, -1, 0.0103f}, {0.12f, 0, 0}, {0, 2, 0}, Role::surveyed, 0.5);
  return scene;
}

// Voxels by their centres alone.
class VoxelsByCentre {
 public:
  explicit VoxelsByCentre(const Simulator& simulator)
      : first_(simulator.voxel_centre(0)), size_(simulator.voxel_size_m()) {
    for (std::uint64_t k = 0; k < simulator.voxel_count(); ++k) places_[place(simulator.voxel_centre(k))] = k;
  }
  // kNoVoxel if none holds the point.
  std::uint64_t at(const Vec3& point) const {
    const auto found = places_.find(place(point));
    return found == places_.end() ? kNoVoxel : found->second;
  }

 private:
  std::array<long, 3> place(const Vec3& p) const {
    const Vec3 d = (p - first_) * (1 / size_);
    return {std::lround(d.x), std::lround(d.y), std::lround(d.z)};
  }
  Vec3 first_;
  double size_;
  std::map<std::array<long, 3>, std::uint64_t> places_;
};

TEST(WideBeam, CountsOfANetworkAreThoseOfItsScans) {
  Scanner scanner = narrow_scanner();
  scanner.noise = {.distances_m = {10}, .reflectivities = {0.5}, .sigma_m = {0.004}};
  scanner.detection_range_m = 10.1, scanner.detection_reflectivity = static_cast<double>(kR);
  Simulator simulator(step_over_a_plate().scene(), scanner, {.engine = Engine::embree, .user_size_m = 0.02});
  const Network network{{{0, 0, 0}}, {{0, 0.004, 0}, false}, {{0, 0.002, 0.001}}};
  for (const Returns returns : {Returns::strongest, Returns::all}) {
    const BeamOptions beam{.sub_rays = 7, .returns = returns, .pulse_m = 0.5};
    VoxelField field;
    const NetworkCounts counts = simulator.evaluate(network, {.field = &field, .beam = beam});
    std::vector<std::uint32_t> points(simulator.voxel_count());
    std::vector<std::uint64_t> stations(simulator.voxel_count());
    for (std::uint32_t k = 0; k < network.size(); ++k) {
      const ScanSummary scanned =
          simulator.scan(network[k], {.outputs = scan_voxel, .place = k, .beam = beam}, [&](const ScanChunk& chunk) {
            for (const std::uint32_t voxel : chunk.voxel) {
              if (voxel == kNoVoxel) continue;
              ++points[voxel];
              stations[voxel] |= std::uint64_t{1} << k;
            }
          });
      EXPECT_EQ(counts.points[k], scanned.points);
      EXPECT_EQ(counts.points_on_surveyed[k], scanned.points_on_surveyed);
      EXPECT_EQ(counts.mixed[k], scanned.mixed);
      if (network[k].active) {
        EXPECT_GT(scanned.mixed.points, 100u);
        EXPECT_GT(counts.dropped[k].echo, 100u) << "halves of footprints";
        EXPECT_EQ(counts.dropped[k].points, counts.dropped[k].echo);
      }
    }
    EXPECT_EQ(field.count, points);
    EXPECT_EQ(field.stations.all_words(), stations);
    EXPECT_EQ(counts.voxels, simulator.voxel_count());
    EXPECT_EQ(counts.seen[0], static_cast<std::uint64_t>(
                                  std::ranges::count_if(stations, [](std::uint64_t mask) { return (mask & 1) != 0; })));
    const NetworkCounts each = simulator.evaluate_each({&network, 1}, {.beam = beam}).front();
    EXPECT_EQ(each.points_on_surveyed, counts.points_on_surveyed);
    EXPECT_EQ(each.saturated, counts.saturated);
  }
}

TEST(WideBeam, MixedPointsInVoxelsOfOtherSurfacesDoNotCount) {
  Simulator simulator(step_over_a_plate().scene(), narrow_scanner(), {.engine = Engine::embree, .user_size_m = 0.02});
  const VoxelsByCentre voxels(simulator);
  const ScanPoints scan = simulator.scan_points(
      {{0, 0, 0}}, {.outputs = scan_position | scan_voxel | scan_ids, .beam = BeamOptions{.sub_rays = 19}});
  MixedPoints expected;
  std::uint64_t of_the_plate = 0;  // a sub-ray met its edge
  for (std::size_t k = 0; k < scan.position.size(); ++k) {
    const Vec3& p = scan.position[k];
    const double off = std::min(std::abs(p.x - 10), std::abs(p.x - 10.2));
    if (scan.mesh[k] == 2 || off <= 0.005) continue;
    ++expected.points;
    expected.counted += scan.voxel[k] != kNoVoxel ? 1 : 0;
    const std::uint64_t in = voxels.at(p);
    if (in == kNoVoxel) {
      EXPECT_EQ(scan.voxel[k], kNoVoxel);
    } else if (off >= simulator.voxel_size_m()) {  // in none of the walls' voxels, where echoes come from
      (scan.voxel[k] == kNoVoxel ? expected.wrong_voxel : of_the_plate) += 1;
    }
  }
  const auto near = [&](std::uint64_t found, std::uint64_t wanted, double part) {
    EXPECT_NEAR(static_cast<double>(found) / static_cast<double>(wanted), 1, part) << found << " and " << wanted;
  };
  EXPECT_GT(expected.wrong_voxel, 60u);
  EXPECT_LT(10 * of_the_plate, expected.points);
  near(scan.summary.mixed.points, expected.points, 0.03);
  near(scan.summary.mixed.counted, expected.counted, 0.1);
  // A few more lie in a wall's voxel beside that of their echoes.
  EXPECT_GE(scan.summary.mixed.wrong_voxel, expected.wrong_voxel);
  near(scan.summary.mixed.wrong_voxel, expected.wrong_voxel, 0.2);
}

TEST(WideBeam, BadInputIsRefused) {
  QuadScene scene;
  add_wall(scene, kWall_m, -1, 1);
  Scanner unknown = narrow_scanner();
  EXPECT_THROW(scanned(scene, {.sub_rays = 8}), Error);
  EXPECT_THROW(scanned(scene, {.pulse_m = 0}), Error);
  unknown.beam_divergence = {}, unknown.exit_diameter_m = 0;
  EXPECT_THROW(scanned(scene, {}, nullptr, unknown), Error);
  EXPECT_THROW(returns_from_string("some"), Error);
  for (const Returns each : {Returns::first, Returns::strongest, Returns::last, Returns::all})
    EXPECT_EQ(returns_from_string(to_string(each)), each);
}

}  // namespace
}  // namespace vantage
