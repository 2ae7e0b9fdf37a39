// SPDX-License-Identifier: Apache-2.0
// The registration error against closed forms, on artificial surfaces.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "core/philox.hpp"
#include "objective/registration_adjustment.hpp"
#include "scan/voxel_sample.hpp"
#include "trace/field_counts.hpp"
#include "trace/registration_sums.hpp"
#include "vantage/error.hpp"
#include "vantage/measure.hpp"
#include "vantage/objective.hpp"

namespace vantage {
namespace {

constexpr Vec3 X{1, 0, 0}, Y{0, 1, 0}, Z{0, 0, 1};
constexpr RegistrationModel model{.rho_m = 0.002, .patch_m = 0.5};
constexpr double q = 2 * model.rho_m * model.rho_m * model.patch_m * model.patch_m;  // m⁴: of two stations, per area

// A wide prior, so that surfaces decide.
RegistrationOptions weak() {
  return {.model = model, .position_m = 10, .heading = Angle::radians(1), .tilt = Angle::radians(1)};
}

std::vector<PatchScanner> scanner_with(const NoiseModel& noise) {
  return {{std::make_shared<const NoiseModel>(noise)}};
}

// Surfaces, the stations that see them, and the heads.
struct Made {
  std::vector<VoxelSurface> surfaces = {};
  std::vector<std::uint64_t> masks = {};
  std::vector<Vec3> heads = {};
  double voxel_m = 0.1;
  PatchScanner scanner = {};  // its errors

  // A patch spanned by u and v around o, of k × k voxels.
  void patch(const Vec3& o, const Vec3& u, const Vec3& v, int k, std::uint64_t who) {
    const Vec3 normal = cross(u, v);
    const double area = std::sqrt(dot(normal, normal));
    for (int i = 0; i < k; ++i)
      for (int j = 0; j < k; ++j)
        one(o + u * ((i + 0.5) / k - 0.5) + v * ((j + 0.5) / k - 0.5), normal * (1 / area), area / (k * k), who);
    voxel_m = std::sqrt(area) / k;
  }
  void one(const Vec3& p, const Vec3& n, double area, std::uint64_t who) {
    const auto rounded = [](const Vec3& a) {
      return Float3{static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
    };
    const auto a = static_cast<float>(area);
    surfaces.push_back({.point = rounded(p), .normal = rounded(n), .area = a, .share = 1, .extent = a, .diffuse = 0.5});
    masks.push_back(who);
  }
  // Three pairs of patches of side a at ±d around c, facing inwards.
  void room(const Vec3& c, double d, double a, int k, std::uint64_t who) {
    for (const double s : {-1.0, 1.0}) {
      patch(c + X * (d * s), Y * a, Z * a, k, who);
      patch(c + Y * (d * s), Z * a, X * a, k, who);
      patch(c + Z * (d * s), X * a, Y * a, k, who);
    }
  }

  std::vector<TraceStation> stations() const {
    std::vector<TraceStation> all;
    for (const Vec3& h : heads)
      all.push_back({{static_cast<float>(h.x), static_cast<float>(h.y), static_cast<float>(h.z)},
                     static_cast<std::uint32_t>(all.size())});
    return all;
  }
  Patches patches(const RegistrationModel& m = model) const {
    Box box;
    for (const VoxelSurface& s : surfaces) box.extend({s.point.x, s.point.y, s.point.z});
    const Vec3 size = box.size();
    RayPattern pattern;
    pattern.zenith_step = pattern.azimuth_step = 0.001;
    return make_patches(surfaces, {box.centre(), std::max({size.x, size.y, size.z}), voxel_m}, pattern, m);
  }
  std::vector<PatchScanner> scanners(const NoiseModel& noise = {}) const {
    PatchScanner one = scanner;
    one.noise = std::make_shared<const NoiseModel>(noise);
    return {one};
  }
  NetworkCounts counts(const NoiseModel& noise = {}) const {
    NetworkCounts counts;
    counts.stations = static_cast<std::uint32_t>(heads.size());
    counts.voxels = masks.size();
    counts.registration = sum_patches(patches(), scanners(noise), stations(), counts.stations, masks, 0).front();
    return counts;
  }
  RegistrationError error(const RegistrationOptions& options = weak()) const {
    return registration_error(counts(), masks.size(), options);
  }
  // H of stations 0 and 1, about the frame's centre in units of its radius.
  Eigen::Matrix<double, 6, 6> information() const {
    const NetworkCounts c = counts();
    const double* sum = c.registration.pairs.data();
    Eigen::Matrix<double, 6, 6> h;
    for (int a = 0; a < 6; ++a)
      for (int b = a; b < 6; ++b) h(a, b) = h(b, a) = *sum++;
    return h;
  }
  int rank() const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(information());
    return static_cast<int>((solver.eigenvalues().array() > 1e-7 * solver.eigenvalues()[5]).count());
  }
};

constexpr std::uint64_t all_of(int stations) { return (std::uint64_t{1} << stations) - 1; }

// Variances of shift and turn between two stations in a room: s²/A of two patches across each axis, and of four about
// each.
struct Room {
  double shift, turn, radius_squared;
  Room(double d, double a, int k) {
    const double second = a * a / 12 * (1 - 1.0 / (k * k));  // of the voxels' centres, in each direction
    shift = q / (2 * a * a);
    turn = q / (4 * a * a * second);
    radius_squared = d * d + 2 * second;
  }
};

TEST(RegistrationError, AtAPointIsTheTraceOfItsDisplacementsCovariance) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 100; ++k) {
    const Eigen::Matrix<double, 6, 6> factor =
        Eigen::Matrix<double, 6, 6>::NullaryExpr([&] { return 1e-3 * normal(random); });
    const Eigen::Matrix<double, 6, 6> covariance = factor * factor.transpose();
    RegistrationError error;
    error.centre = {3, -2, 1}, error.scale_m = 17;
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(error.poses.emplace_back().data()) = covariance;
    const Vec3 local{30 * normal(random), 30 * normal(random), 5 * normal(random)},
        q = (local - error.centre) * (1.0 / 17);
    Eigen::Matrix<double, 3, 6> moves;  // shift + turn × q, of [turn, shift]
    moves << 0, q.z, -q.y, 1, 0, 0, -q.z, 0, q.x, 0, 1, 0, q.y, -q.x, 0, 0, 0, 1;
    const double expected = std::sqrt((moves * covariance * moves.transpose()).trace());
    EXPECT_NEAR(error.at(0, local), expected, 1e-12 * expected);
  }
}

TEST(RegistrationError, OfThreePairsOfPlanes) {
  const double a = 2, d = 3;
  const int k = 20;
  Made m{.heads = {{0.5, 0, 0}, {-0.5, 0, 0}}};
  m.room({}, d, a, k, 3);
  const Room room(d, a, k);
  // The best motion of the whole is the mean, so each station has half of the difference: a quarter of its variance.
  const double expected = std::sqrt((3 * room.shift + 2 * room.turn * room.radius_squared) / 4);
  EXPECT_NEAR(m.error().rms_m, expected, 1e-4 * expected);
  EXPECT_NEAR(m.error().worst_m, expected, 1e-4 * expected);

  Made fine{.heads = m.heads};
  fine.room({}, d, a, 4 * k, 3);
  EXPECT_NEAR(fine.error().rms_m, expected, 3e-3 * expected) << "finer voxels";

  Made turned{.heads = {}, .voxel_m = m.voxel_m};
  const auto turn = [](const Vec3& v) {  // by 40° about (1, 2, 3)
    const Vec3 axis = Vec3{1, 2, 3} * (1 / std::sqrt(14.0));
    const double c = std::cos(0.7), s = std::sin(0.7);
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
  };
  for (const Vec3& h : m.heads) turned.heads.push_back(turn(h));
  for (const VoxelSurface& f : m.surfaces)
    turned.one(turn({f.point.x, f.point.y, f.point.z}), turn({f.normal.x, f.normal.y, f.normal.z}), f.area, 3);
  EXPECT_NEAR(turned.error().rms_m, expected, 1e-4 * expected) << "turned";
}

// Each plane is unknown itself: k stations give k − 1 constraints, so pairs are not independent.
TEST(RegistrationError, OfManyStationsInOneRoom) {
  for (const int stations : {2, 3, 5, 8}) {
    Made m;
    for (int i = 0; i < stations; ++i) m.heads.push_back({i * 0.1, 0, 0});
    m.room({}, 3, 2, 20, all_of(stations));
    const Room room(3, 2, 20);
    const double expected =
        std::sqrt((3 * room.shift + 2 * room.turn * room.radius_squared) / 2 * (1 - 1.0 / stations));
    EXPECT_NEAR(m.error().rms_m, expected, 2e-4 * expected) << stations;
  }
}

TEST(RegistrationError, LeavesACorridorItsFreeDirection) {
  for (const double length : {10.0, 100.0})
    for (const double angle : {0.0, 0.3}) {
      const Vec3 along{std::cos(angle), std::sin(angle), 0}, across{-std::sin(angle), std::cos(angle), 0};
      Made m{.heads = {along * -3 + Z * 1.5, along * 3 + Z * 1.5}};
      for (const double s : {-1.0, 1.0}) {
        m.patch(across * s + Z * 1.5, along * length, Z * 3, 40, 3);
        m.patch(Z * (1.5 + 1.5 * s), along * length, across * 2, 40, 3);
      }
      const RegistrationOptions options{
          .model = model, .position_m = 0.1, .heading = Angle::degrees(1), .tilt = Angle::degrees(1)};
      // The difference of two positions, half to each.
      const RegistrationError error = m.error(options);
      EXPECT_NEAR(error.rms_m, 0.1 / std::sqrt(2.0), 1e-3 * 0.1) << length << ' ' << angle;
      const Vec3 axis = error.stations[0].axes[0];
      EXPECT_NEAR(std::abs(dot(axis, along)), 0.1 / std::sqrt(2.0), 1e-3 * 0.1);
      EXPECT_LT(dot(error.stations[0].axes[1], error.stations[0].axes[1]), 1e-4 * dot(axis, axis));
    }
}

TEST(RegistrationError, OfOnePlaneIsThePriorsWithinIt) {
  Made m{.heads = {{-3, 0, 1.5}, {3, 0, 1.5}}};
  m.patch({}, X * 10, Y * 10, 40, 3);
  EXPECT_EQ(m.rank(), 3);
  const RegistrationOptions options{
      .model = model, .position_m = 0.1, .heading = Angle::radians(1e-6), .tilt = Angle::radians(1e-6)};
  EXPECT_NEAR(m.error(options).rms_m, 0.1, 1e-4 * 0.1);  // two directions, each with half of the variance
  RegistrationOptions level = options;
  level.tilt = Angle();
  EXPECT_NEAR(m.error(level).rms_m, m.error(options).rms_m, 1e-6);
}

TEST(RegistrationError, KnowsWhatRoundSurfacesLeaveFree) {
  Made cylinder{.heads = {{-3, 0, 0}, {3, 0, 0}}};
  for (int i = 0; i < 400; ++i)
    for (int j = 0; j < 10; ++j) {
      const double t = 2 * std::numbers::pi * i / 400;
      const Vec3 n{std::cos(t), std::sin(t), 0};
      cylinder.one(n + Z * ((j - 4.5) * 0.2), n, 0.003, 3);
    }
  // Both stations stand outside. Visibility is not tested here, so they look from within.
  cylinder.heads = {{-0.1, 0, 0}, {0.1, 0, 0}};
  EXPECT_EQ(cylinder.rank(), 4);
  Made sphere{.heads = {{5, 6, 7}, {5.1, 6, 7}}};
  for (int k = 0; k < 4000; ++k) {
    const double z = 1 - 2 * (k + 0.5) / 4000, t = k * 2.399963;
    const Vec3 n{std::sqrt(1 - z * z) * std::cos(t), std::sqrt(1 - z * z) * std::sin(t), z};
    sphere.one(n + Vec3{5, 6, 7}, n, 0.003, 3);
  }
  EXPECT_EQ(sphere.rank(), 3);
}

// Links in a row add their variances as resistances do; a ring has two ways.
TEST(RegistrationError, OfAChainAndARingOfRooms) {
  for (const bool ring : {false, true}) {
    const int stations = 6;
    Made m;
    // about one centre, so nothing has leverage
    for (int i = 0; i < stations; ++i) m.heads.push_back({0.001 * i, 0, 0});
    for (int i = 0; i + (ring ? 0 : 1) < stations; ++i)
      m.room({}, 3, 2, 20, std::uint64_t{1} << i | std::uint64_t{1} << (i + 1) % stations);
    const RegistrationError error = m.error();
    // Shifts relative to the mean of all: the variance of each is the pseudoinverse of the links' Laplacian, weighted
    // by the surfaces' masses. Tested by shape: in a chain, the error at its ends over that in its middle; in a ring,
    // all are equal.
    std::vector<double> shift;
    for (const auto& pose : error.poses) shift.push_back(pose[21]);
    const double link = q / 8;
    if (ring) {
      for (const double v : shift) EXPECT_NEAR(v / link, 35.0 / 72, 2e-3);
    } else {
      // Masses 1, 2, 2, 2, 2, 1: the variance about the weighted mean, by sums over links.
      const std::vector<double> mass{0.1, 0.2, 0.2, 0.2, 0.2, 0.1};
      for (int i = 0; i < stations; ++i) {
        double expected = 0;
        for (int l = 0; l + 1 < stations; ++l) {
          double beyond = 0;  // mass on the far side of the link
          for (int k = 0; k < stations; ++k)
            if ((k <= l) != (i <= l)) beyond += mass[static_cast<std::size_t>(k)];
          expected += beyond * beyond;
        }
        EXPECT_NEAR(shift[static_cast<std::size_t>(i)] / link, expected, 2e-3 * expected) << i;
      }
    }
  }
}

TEST(RegistrationError, DoesNotSeeThroughThinWalls) {
  Made m{.heads = {{-3, 0, 0}, {3, 0, 0}}};
  m.patch({}, Y * 4, Z * 3, 20, 3);
  EXPECT_EQ(m.rank(), 0);
  m.heads[1].x = -2;
  EXPECT_EQ(m.rank(), 3);
}

TEST(RegistrationError, OfPartsThatShareNothingIsWhereTheyStart) {
  Made m{.heads = {{-10, 0, 0}, {-11, 0, 0}, {10, 0, 0}, {11, 0, 0}}};
  m.room(X * -10.5, 3, 2, 20, 3);
  m.room(X * 10.5, 3, 2, 20, 12);
  const RegistrationOptions options{
      .model = model, .position_m = 0.1, .heading = Angle::radians(1e-6), .tilt = Angle::radians(1e-6)};
  // Along X the components' difference remains; across, a turn of the whole absorbs all but r²/(D² + r²).
  const double r2 = 2 * (2 * 9 + 4 * (1.0 / 3) * (1 - 1.0 / 400)) / 6, left = r2 / (10.5 * 10.5 + r2);
  EXPECT_NEAR(m.error(options).rms_m, 0.05 * std::sqrt(1 + 2 * left), 1e-3 * 0.05);
}

TEST(RegistrationError, OfASampleIsThatOfTheWhole) {
  Made m{.heads = {{0.5, 0, 0}, {-0.5, 0, 0}}};
  m.room({}, 3, 2, 20, 3);
  NetworkCounts half = m.counts();
  for (double& sum : half.registration.pairs) sum /= 2;
  for (double& sum : half.registration.surface) sum /= 2;
  half.voxels /= 2, half.registration.voxels /= 2;
  EXPECT_NEAR(registration_error(half, m.masks.size(), weak()).rms_m, m.error().rms_m, 1e-12);
}

// Unseen corners that move and widen the frame.
void widen(Made& m, const Vec3& a, const Vec3& b) {
  for (const Vec3& corner : {a, b}) m.one(corner, Z, 0.01, 0);
}

// The surfaces that register the scans have their own grid, separate from the surface whose error is wanted.
TEST(RegistrationError, GoesByAllSurfacesWhereAsked) {
  const double a = 2, d = 3;
  Made around{.heads = {{0.5, 0, 0}, {-0.5, 0, 0}}}, surveyed{.heads = around.heads};
  around.room({}, d, a, 20, 3);
  surveyed.room({}, d, a, 40, 3);
  for (VoxelSurface& s : surveyed.surfaces) s.share = 0.1f;  // too little to register by
  widen(surveyed, {-20, -3, -4}, {5, 30, 9});
  RegistrationOptions options = weak();
  EXPECT_GT(surveyed.error(options).rms_m, 1);
  options.surfaces = RegistrationSurfaces::all;
  NetworkCounts counts = surveyed.counts(), held = around.counts();
  const Room room(d, a, 20);
  const double expected = std::sqrt((3 * room.shift + 2 * room.turn * room.radius_squared) / 4);
  EXPECT_NEAR(registration_error(counts, counts.voxels, options, &held, held.voxels).rms_m, expected, 1e-3 * expected);
  EXPECT_NEAR(registration_error(counts, counts.voxels, options, &held, 4 * held.voxels).rms_m, expected / 2,
              1e-3 * expected)
      << "a quarter of the surroundings was counted";
  EXPECT_EQ(registration_error(counts, counts.voxels, weak(), &held, held.voxels).rms_m, surveyed.error().rms_m)
      << "not asked for";
  // Counting the same thing on both grids changes nothing.
  Made same = around;
  EXPECT_NEAR(registration_error(same.counts(), same.masks.size(), options, &held, held.voxels).rms_m,
              same.error().rms_m, 1e-9);
  EXPECT_THROW(registration_error(counts, counts.voxels, options), Error);
  held.registration = {};
  EXPECT_THROW(registration_error(counts, counts.voxels, options, &held, held.voxels), Error);
}

// A station that sees nothing surveyed passes on the poses of its neighbours; one that sees nothing at all does not.
TEST(RegistrationError, HandsPosesOnByStationsThatSeeNothingSurveyed) {
  for (const std::size_t blind : {0u, 1u}) {  // number of such stations before the others
    Made around{.heads = {{0, 0, 0}, {0.001, 0, 0}, {0.002, 0, 0}}};
    around.heads.insert(around.heads.begin(), blind, {5, 0, 0});
    Made surveyed{.heads = around.heads};
    around.room({}, 3, 2, 20, 3u << blind);
    around.room({}, 3, 2, 20, 6u << blind);
    surveyed.room({}, 3, 2, 20, 1u << blind);
    surveyed.room({}, 3, 2, 20, 4u << blind);
    RegistrationOptions options = weak();
    options.surfaces = RegistrationSurfaces::all;
    const NetworkCounts counts = surveyed.counts(), held = around.counts();
    const RegistrationError error = registration_error(counts, counts.voxels, options, &held, held.voxels);
    const Room room(3, 2, 20);
    // Two links in a row, with half of the difference to each end: a quarter of its variance.
    const double expected = std::sqrt(2 * (3 * room.shift + 2 * room.turn * room.radius_squared) / 4);
    EXPECT_NEAR(error.rms_m, expected, 1e-3 * expected);
    const StationError& between = error.stations[blind + 1];
    EXPECT_EQ(between.rms_m, 0);
    EXPECT_GT(dot(between.axes[0], between.axes[0]), 0) << "its head is not where it should be, too";
    if (blind > 0) {
      EXPECT_EQ(dot(error.stations[0].axes[0], error.stations[0].axes[0]), 0);
    }
  }
}

TEST(RegistrationError, CountsRangeNoiseByTheRaysOfAFreeView) {
  Made m{.heads = {{0.5, 0, 0}, {0.5, 0, 0}}};  // a level wall straight ahead: no obliquity in either direction
  m.one({10.5, 0, 0}, X, 0.01, 3);
  m.one({-9.5, 0, 0}, X, 0.01, 3);
  NoiseModel noise;
  noise.sigma.assign(NoiseModel::kSide * NoiseModel::kSide, 0.004f);
  noise.inverse_span = 0.01f;
  const double points = 0.01 / (100 * 1e-6);  // area / (r² Δh Δv)
  const double s2 = 0.004 * 0.004 / points + model.rho_m * model.rho_m * model.patch_m * model.patch_m / 0.01;
  const NetworkCounts counts = m.counts(noise);
  EXPECT_NEAR(counts.registration.pairs[15], 2 / (2 * s2), 1e-3 / s2);  // J_x J_x of n = X
}

TEST(RegistrationError, SumsDoNotDependOnGroups) {
  RandomStream random(5);
  Made m{.heads = {{0.5, 0, 0}, {-0.5, 0.3, 0}, {0.1, -0.2, 0.4}}};
  m.room({}, 3, 2, 23, 7);
  for (std::uint64_t& mask : m.masks) mask = random.bits() & 7;
  const Patches patches = m.patches();
  const auto whole = sum_patches(patches, scanner_with({}), m.stations(), 3, m.masks, 0);
  const auto parts = sum_patches(patches, scanner_with({}), m.stations(), 3, m.masks, 20);
  ASSERT_EQ(parts.size(), 21u);
  EXPECT_EQ(parts[0].pairs, whole[0].pairs);
  EXPECT_EQ(parts[0].surface, whole[0].surface);
  double sum = 0;
  for (std::size_t g = 1; g < parts.size(); ++g) sum += parts[g].pairs[15];
  EXPECT_NEAR(sum, whole[0].pairs[15], 1e-9 * sum);
}

TEST(RegistrationError, OfNothingIsThePriors) {
  Made m{.heads = {{0.5, 0, 0}, {-0.5, 0, 0}}};
  m.room({}, 3, 2, 5, 0);
  EXPECT_DOUBLE_EQ(m.error().rms_m, 10 * std::sqrt(3.0));
  Made one{.heads = {{0, 0, 0}}};
  one.room({}, 3, 2, 5, 1);
  EXPECT_NEAR(one.error().rms_m, 0, 1e-6);  // a single scan is the survey's frame
}

TEST(RegistrationError, RefusesWhatItWasNotToldOf) {
  NetworkCounts unasked;
  unasked.voxels = 1;
  unasked.stations = 2;
  EXPECT_THROW(registration_error(unasked, 1), Error);
  for (const RegistrationOptions& bad :
       {RegistrationOptions{.model = {.rho_m = 0}}, RegistrationOptions{.model = {.patch_m = -1}},
        RegistrationOptions{.position_m = 0}, RegistrationOptions{.heading = Angle()},
        RegistrationOptions{.tilt = Angle::degrees(-1)}})
    EXPECT_THROW(make_objective("registration", {.registration = bad}), Error);
}

// A street of rooms with doors between them, seen by six stations, partly at random as through clutter. The 95 %
// intervals contain the error of all voxels in 93 to 97 of 100 samples, small and large.
TEST(RegistrationError, StandardErrorsHold) {
  RandomStream random(9);
  Made m;
  for (int i = 0; i < 6; ++i) m.heads.push_back({4.0 * i, 0.2 * (i % 3), 0});
  for (int i = 0; i < 6; ++i) {
    const std::uint64_t here = std::uint64_t{1} << i, next = i < 5 ? here << 1 : here >> 1;
    m.room({4.0 * i, 0, 0}, 1.9, 3, 30, here);
    for (std::size_t k = m.masks.size() - 6 * 900; k < m.masks.size(); ++k) {
      if (random.uniform() < 0.3) m.masks[k] |= next;
      if (random.uniform() < 0.2) m.masks[k] = 0;
    }
  }
  const Patches all = m.patches();
  const RegistrationOptions options{.model = model};
  const double truth = m.error(options).rms_m;
  constexpr int trials = 2000;  // determines the share itself to 0.005
  for (const std::uint64_t size : {1500u, 3000u, 6000u}) {
    SCOPED_TRACE(size);
    std::vector<Estimate> estimates(trials);
    tbb::parallel_for(0, trials, [&](int trial) {
      const auto sample = voxel_sample(m.masks.size(), size, static_cast<std::uint64_t>(trial) + 1);
      Patches some = all;
      some.patches.clear();
      std::vector<std::uint64_t> masks;
      for (const std::uint32_t voxel : sample) {
        some.patches.push_back(all.patches[voxel]);
        masks.push_back(m.masks[voxel]);
      }
      const auto sums = sum_patches(some, scanner_with({}), m.stations(), 6, masks, 20);
      NetworkCounts counts;
      counts.stations = 6;
      counts.voxels = sample.size();
      take_registration(counts, sums);
      estimates[static_cast<std::size_t>(trial)] = registration_estimate(counts, m.masks.size(), options);
    });
    int held = 0;
    double off = 0, squares = 0;
    for (const Estimate& estimate : estimates) {
      held += std::abs(estimate.value - truth) <= 1.96 * estimate.standard_error;
      off += (estimate.value - truth) / trials;
      squares += std::pow(estimate.value - truth, 2) / trials;
    }
    const double share = held / double(trials);
    EXPECT_GE(share, 0.93);
    EXPECT_LE(share, 0.97);
    EXPECT_LT(std::abs(off), 0.2 * std::sqrt(squares)) << "what is left of the bias";
  }
}

// Leaving out the only group that holds a link shows that the error might be anything, not that there is none.
TEST(Registration, OfALinkInOneGroupIsNotFreeOfError) {
  Made m{.heads = {{0.5, 0, 0}, {-0.5, 0, 0}}};
  m.room({}, 3, 2, 20, 3);
  NetworkCounts counts = m.counts();
  for (int g = 0; g < 20; ++g) {
    RegistrationSums group = counts.registration;
    group.groups.clear();
    group.voxels /= 20;
    for (double& sum : group.pairs) sum *= g == 0 ? 1 : 0;
    for (double& sum : group.surface) sum /= 20;
    counts.registration.groups.push_back(group);
  }
  const double seen = registration_error(counts, 20 * counts.voxels).rms_m;
  const Estimate estimate = registration_estimate(counts, 20 * counts.voxels);
  EXPECT_GT(estimate.standard_error, seen);
  EXPECT_DOUBLE_EQ(estimate.value, seen / 2);
}

TEST(Registration, SumsOfAFieldDoNotDependOnTheParts) {
  Made made;
  made.heads = {{0.1, 0, 0}, {-0.4, 0.3, 0.2}, {0.5, -0.2, -0.3}};
  made.room({0, 0, 0}, 4, 3, 12, 0b111);
  for (std::size_t k = 0; k < made.masks.size(); ++k) made.masks[k] = k % 8;
  const Patches patches = made.patches();
  const std::size_t voxels = made.masks.size();
  for (const std::uint32_t station_count : {3u, 150u}) {
    SCOPED_TRACE(std::to_string(station_count) + " stations");
    std::vector<TraceStation> stations = made.stations();
    stations.back().place = station_count - 1;
    std::vector<std::uint64_t> words(voxels * mask_words(station_count));
    for (std::size_t k = 0; k < voxels; ++k) {
      words[k] |= made.masks[k] & 3;
      words[(station_count - 1) / 64 * voxels + k] |= (made.masks[k] >> 2) << ((station_count - 1) % 64);
    }
    StationMasks masks(voxels, station_count);
    for (std::size_t w = 0; w < masks.words(); ++w) masks.set_words(w, std::span(words).subspan(w * voxels, voxels));
    const std::vector<std::uint32_t> counts(voxels, 1);
    const NetworkCounts network = reduce_field(counts, words, station_count, 1);
    const RegistrationSums whole = sum_patches(patches, scanner_with({}), stations, station_count, words, 0).front();
    for (const std::size_t at_once : {std::size_t{1000}, voxels - 1, voxels}) {
      const auto some = [&](std::size_t first, std::size_t many) {
        Patches part = patches;
        part.patches.assign(patches.patches.begin() + static_cast<std::ptrdiff_t>(first),
                            patches.patches.begin() + static_cast<std::ptrdiff_t>(first + many));
        return std::make_shared<const Patches>(std::move(part));
      };
      const auto sums = sum_patches(some, at_once, scanner_with({}), stations, network, masks);
      ASSERT_TRUE(sums);
      EXPECT_EQ(sums->pairs, whole.pairs);
      EXPECT_EQ(sums->surface, whole.surface);
      EXPECT_TRUE(std::ranges::any_of(sums->pairs, [](double sum) { return sum != 0; }));
    }
    const auto stopped = [](std::size_t, std::size_t) { return std::shared_ptr<const Patches>(); };
    EXPECT_FALSE(sum_patches(stopped, 1000, scanner_with({}), stations, network, masks));
  }
}

TEST(Registration, SumsOfLargeNetworksAreThoseOfTheSameStationsInASmallOne) {
  Made made;
  made.heads = {{0.1, 0, 0}, {-0.4, 0.3, 0.2}, {0.5, -0.2, -0.3}};
  made.room({0, 0, 0}, 4, 3, 12, 0b111);
  for (std::size_t k = 0; k < made.masks.size(); ++k) made.masks[k] = k % 8;
  const Patches patches = made.patches();
  constexpr std::uint32_t groups = 5, large = 150;
  const std::vector<TraceStation> few = made.stations();
  const std::vector<RegistrationSums> small = sum_patches(patches, scanner_with({}), few, 3, made.masks, groups);

  const std::array<std::uint32_t, 3> places{3, 70, 149};
  std::vector<TraceStation> many = few;
  std::vector<std::uint64_t> masks(made.masks.size() * mask_words(large));
  for (std::size_t s = 0; s < many.size(); ++s) {
    many[s].place = places[s];
    for (std::size_t k = 0; k < made.masks.size(); ++k)
      masks[places[s] / 64 * made.masks.size() + k] |= (made.masks[k] >> s & 1) << (places[s] % 64);
  }
  const std::vector<RegistrationSums> sums = sum_patches(patches, scanner_with({}), many, large, masks, groups);
  ASSERT_EQ(sums.size(), small.size());
  constexpr std::size_t of_pair = RegistrationSums::of_pair, of_station = RegistrationSums::of_station;
  for (std::size_t g = 0; g < sums.size(); ++g) {
    std::vector<double> pairs(large * (large - 1) / 2 * of_pair), surface(large * of_station);
    std::size_t pair = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      std::copy_n(small[g].surface.begin() + static_cast<std::ptrdiff_t>(a * of_station), of_station,
                  surface.begin() + static_cast<std::ptrdiff_t>(places[a] * of_station));
      for (std::size_t b = a + 1; b < 3; ++b, ++pair) {
        const std::size_t i = places[a], j = places[b];
        std::copy_n(small[g].pairs.begin() + static_cast<std::ptrdiff_t>(pair * of_pair), of_pair,
                    pairs.begin() + static_cast<std::ptrdiff_t>((i * (2 * large - i - 1) / 2 + j - i - 1) * of_pair));
      }
    }
    std::vector<double> summed;
    for_summed_pairs(sums.front(), [&](std::size_t first) {
      summed.insert(summed.end(), pairs.begin() + static_cast<std::ptrdiff_t>(first),
                    pairs.begin() + static_cast<std::ptrdiff_t>(first + of_pair));
    });
    EXPECT_EQ(summed.size(), 3 * of_pair);
    EXPECT_EQ(sums[g].pairs, g == 0 ? pairs : summed);
    EXPECT_EQ(sums[g].surface, surface);
    EXPECT_GT(*std::ranges::max_element(small[g].pairs), 0);
  }

  const auto estimate = [&](std::vector<RegistrationSums> of, std::uint32_t stations) {
    NetworkCounts counts;
    counts.stations = stations, counts.voxels = patches.patches.size();
    take_registration(counts, std::move(of));
    RegistrationOptions options;
    options.surfaces = RegistrationSurfaces::surveyed;
    return registration_estimate(counts, 10 * counts.voxels, options);
  };
  const Estimate in_small = estimate(small, 3), in_large = estimate(sums, large);
  EXPECT_EQ(in_large.value, in_small.value);
  EXPECT_EQ(in_large.standard_error, in_small.standard_error);
  EXPECT_GT(in_small.standard_error, 0);
}

// Stations along a corridor that is free to slide along X, and targets that some of them measure.
struct Tied {
  Made made{.heads = {{-6, 0.4, 0}, {0, -0.3, 0.2}, {5, 0, 0}}};
  std::vector<RegistrationTarget> targets{
      {.centre = {-3, 1, 0.5}, .seen_by = {{0, 0.002, 0.001}, {1, 0.001, 0.001}}},
      {.centre = {2, -1, 0}, .seen_by = {{2, 0.004, 0.001}, {1, 0.002, 0.003}, {0, 0.001, 0.002}}},
      {.centre = {4, 0.5, -0.5}, .control_m = 0.003, .seen_by = {{1, 0.002, 0.0005}, {2, 0.002, 0.002}}},
      {.centre = {9, 0.5, -0.5}, .control_m = 0.005, .seen_by = {{2, 0.003, 0.001}}}};
  RegistrationOptions options{
      .model = model, .position_m = 0.05, .heading = Angle::degrees(0.5), .tilt = Angle::degrees(0.05)};
  Tied() {
    for (const double s : {-1.0, 1.0}) {
      made.patch(Y * (s * 1.5), X * 14, Z * 2, 20, 7);
      made.patch(Z * (s * 1.5), Y * 2, X * 14, 20, 7);
    }
  }
};

TEST(RegistrationError, WithTargetsIsThatOfAnAdjustmentWithTheirCentresAmongTheUnknowns) {
  for (const double tilt : {0.05, 0.0}) {
    Tied tied;
    tied.options.tilt = Angle::degrees(tilt);
    const NetworkCounts counts = tied.made.counts();
    const RegistrationInputs inputs = registration_inputs(counts, counts.voxels, tied.options, nullptr, 0);
    const auto adjustment = [&](std::span<const RegistrationTarget> targets) {
      return RegistrationAdjustment(inputs.held_by, inputs.share, inputs.covered, tied.options, targets);
    };
    const RegistrationAdjustment bare = adjustment({}), with = adjustment(tied.targets);
    // Normal equations with three more unknowns a target: a station measures centre + its own displacement there.
    const Eigen::MatrixXd stations = bare.covariance().inverse();
    const Eigen::Index d = bare.unknowns(), n = stations.rows(), more = 3 * std::ssize(tied.targets);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + more, n + more);
    all.topLeftCorner(n, n) = stations;
    for (std::size_t t = 0; t < tied.targets.size(); ++t) {
      const RegistrationTarget& target = tied.targets[t];
      const Eigen::Index at = n + 3 * static_cast<Eigen::Index>(t);
      if (target.control_m > 0)
        all.block(at, at, 3, 3) += Eigen::Matrix3d::Identity() / (target.control_m * target.control_m);
      for (const RegistrationTarget::Sighting& seen : target.seen_by) {
        Eigen::MatrixXd row = Eigen::MatrixXd::Zero(3, n + more);
        row.middleCols(static_cast<Eigen::Index>(seen.station) * d, d) = bare.displacement_at(target.centre);
        row.middleCols(at, 3) = Eigen::Matrix3d::Identity();
        // Along the line from the head, and two axes across it.
        const Vec3 line = target.centre - tied.made.heads[seen.station];
        const Eigen::Vector3d along = Eigen::Vector3d(line.x, line.y, line.z).normalized(),
                              side = along.unitOrthogonal(), up = along.cross(side);
        for (const Eigen::Vector3d& axis : {along, side, up}) {
          const double sigma = axis == along ? seen.along_m : seen.across_m;
          all += row.transpose() * axis * axis.transpose() * row / (sigma * sigma);
        }
      }
    }
    const Eigen::MatrixXd expected = all.inverse().topLeftCorner(n, n), found = with.covariance();
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-9 * expected.cwiseAbs().maxCoeff());
    const double rms = registration_error(counts, counts.voxels, tied.options, nullptr, 0, tied.targets).rms_m;
    EXPECT_NEAR(rms * rms, (bare.metric() * expected).trace(), 1e-9 * rms * rms);
  }
}

// Two stations that share no surface, so that compensators and targets alone hold their scans.
struct Levelled {
  Made made{.heads = {{-6, 0, 0}, {6, 0, 0}}};
  std::vector<RegistrationTarget> targets;
  RegistrationOptions options{.model = model, .position_m = 0.03, .heading = Angle::degrees(0.2)};
  explicit Levelled(Angle tilt) {
    options.tilt = tilt;
    for (const std::uint64_t who : {1, 2})
      for (const double s : {-1.0, 1.0}) made.patch(Y * (s * 5) + X * (who == 1 ? -6 : 6), X * 4, Z * 2, 8, who);
    for (const Vec3& centre : {Vec3{-3, 4, 0.3}, Vec3{2, -4, 0.1}, Vec3{4, 3, -0.2}, Vec3{0, 1, 0.6}})
      targets.push_back({.centre = centre, .seen_by = {{0, 0.0003, 0.0005}, {1, 0.0004, 0.0006}}});
  }
  // Covariance of what the two scans differ by at a place.
  Eigen::Matrix3d difference(const Vec3& place, bool with_targets) const {
    const NetworkCounts counts = made.counts();
    const RegistrationInputs inputs = registration_inputs(counts, counts.voxels, options, nullptr, 0);
    const RegistrationAdjustment adjustment(
        inputs.held_by, inputs.share, inputs.covered, options,
        with_targets ? std::span<const RegistrationTarget>(targets) : std::span<const RegistrationTarget>());
    const Eigen::MatrixXd at = adjustment.displacement_at(place);
    Eigen::MatrixXd both(3, 2 * at.cols());
    both << at, -at;
    return both * adjustment.covariance() * both.transpose();
  }
};

TEST(RegistrationError, OfLevelledScansGrowsWithTheirTiltsAndTheDistance) {
  const double tilt = 3.0 / 60 * std::numbers::pi / 180;
  const Levelled levelled(Angle::radians(tilt));
  const Vec3 place{4, 9, 0};  // at the heads' height: two tilts move it up and down by its distances from them
  double square = 2 * 0.03 * 0.03;
  for (const Vec3& head : levelled.made.heads) square += tilt * tilt * dot(place - head, place - head);
  EXPECT_NEAR(levelled.difference(place, false)(2, 2), square, 1e-6 * square);
}

// The linear adjustment of drawn poses and drawn sightings, by unknowns of its own: turns about the heads, in radians,
// and shifts.
double simulated_difference(const Levelled& levelled, const Vec3& place, int trials) {
  const auto vector = [](const Vec3& v) { return Eigen::Vector3d(v.x, v.y, v.z); };
  const auto moved = [&](const Vec3& p, std::size_t station) {
    const Eigen::Vector3d q = vector(p - levelled.made.heads[station]);
    Eigen::Matrix<double, 3, 6> j;
    j << 0, q.z(), -q.y(), 1, 0, 0, -q.z(), 0, q.x(), 0, 1, 0, q.y(), -q.x(), 0, 0, 0, 1;
    return j;
  };
  const RegistrationOptions& o = levelled.options;
  const Eigen::Index unknowns = 12 + 3 * std::ssize(levelled.targets);
  Eigen::VectorXd prior(12);
  for (Eigen::Index k = 0; k < 12; ++k)
    prior[k] = k % 6 < 2 ? o.tilt.in_radians() : k % 6 == 2 ? o.heading.in_radians() : o.position_m;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  double squares = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Eigen::VectorXd truth(12), right = Eigen::VectorXd::Zero(unknowns);
    for (Eigen::Index k = 0; k < 12; ++k) truth[k] = prior[k] * normal(random);
    Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(unknowns, unknowns);
    for (Eigen::Index k = 0; k < 12; ++k) equations(k, k) = 1 / (prior[k] * prior[k]);
    for (std::size_t t = 0; t < levelled.targets.size(); ++t)
      for (const RegistrationTarget::Sighting& seen : levelled.targets[t].seen_by) {
        const Vec3& centre = levelled.targets[t].centre;
        const Eigen::Vector3d along = vector(centre - levelled.made.heads[seen.station]).normalized(),
                              side = along.unitOrthogonal(), up = along.cross(side);
        Eigen::MatrixXd row = Eigen::MatrixXd::Zero(3, unknowns);
        const auto own = static_cast<Eigen::Index>(6 * seen.station);
        row.middleCols(own, 6) = moved(centre, seen.station);
        row.middleCols(12 + 3 * static_cast<Eigen::Index>(t), 3) = Eigen::Matrix3d::Identity();
        for (const Eigen::Vector3d& axis : {along, side, up}) {
          const double sigma = axis == along ? seen.along_m : seen.across_m;
          const Eigen::VectorXd one = row.transpose() * axis;
          equations += one * one.transpose() / (sigma * sigma);
          right += one * (one.head(12).dot(truth) + sigma * normal(random)) / (sigma * sigma);
        }
      }
    const Eigen::VectorXd error = equations.ldlt().solve(right).head(12) - truth;
    squares += (moved(place, 0) * error.head(6) - moved(place, 1) * error.tail(6)).squaredNorm();
  }
  return std::sqrt(squares / trials);
}

TEST(RegistrationError, OfLevelledScansIsThatOfSimulatedAdjustments) {
  const Vec3 place{4, 9, 0};
  double levelled_mm = 0;
  for (const double arcsec : {1.5, 15.0, 180.0, 18'000.0}) {
    const Levelled levelled(Angle::degrees(arcsec / 3600));
    const double predicted = std::sqrt(levelled.difference(place, true).trace());
    const double simulated = simulated_difference(levelled, place, 2000);
    EXPECT_NEAR(simulated, predicted, 0.05 * predicted) << arcsec;
    EXPECT_GT(predicted, levelled_mm) << "a better compensator does not harm";
    levelled_mm = predicted;
  }
}

TEST(RegistrationError, TakesTheTiltOfTheScannersIfAsked) {
  Scanner fine, coarse;
  fine.name = "fine", fine.tilt_accuracy = Angle::degrees(1.5 / 3600);
  coarse.name = "coarse", coarse.tilt_accuracy = Angle::degrees(180.0 / 3600);
  const std::vector<Scanner> both{coarse, fine}, unknown{fine, Scanner()};
  RegistrationOptions options;
  EXPECT_EQ(levelled_by(options, unknown).tilt, RegistrationOptions().tilt) << "not asked for";
  options.tilt_of_scanner = true;
  EXPECT_EQ(levelled_by(options, {both.data() + 1, 1}).tilt, fine.tilt_accuracy);
  EXPECT_EQ(levelled_by(options, both).tilt, coarse.tilt_accuracy);
  EXPECT_FALSE(levelled_by(options, both).tilt_of_scanner);
  EXPECT_THROW(levelled_by(options, unknown), Error);
  const NetworkCounts counts = Levelled(Angle::degrees(1)).made.counts();
  EXPECT_THROW(registration_error(counts, counts.voxels, options), Error) << "whose scanners?";
  fine.tilt_accuracy = Angle::degrees(6);
  EXPECT_THROW(fine.check(), Error);
  // Presets state it, and no figure of a scan depends on it.
  EXPECT_NEAR(load_scanner("rtc360").tilt_accuracy.in_degrees(), 0.05, 1e-12);
}

// Stations stand along a corridor, so many that most pairs see nothing together.
TEST(RegistrationError, OfManyStationsIsThatOfTheWholeCovariance) {
  for (const double tilt : {0.05, 0.0}) {
    Made made;
    made.heads.clear();
    RegistrationTarget target{.centre = {}, .control_m = 0.003};
    for (int k = 0; k < 64; ++k) {
      made.heads.push_back({4.0 * k, k % 3 == 0 ? 0.4 : -0.3, 0.1 * (k % 2)});
      if (k % 20 == 3) target.seen_by.push_back({static_cast<std::size_t>(k), 0.002, 0.001});
    }
    for (int k = 0; k < 31; ++k) {
      const std::uint64_t here = std::uint64_t{15} << (2 * k);  // four stations
      made.patch(Vec3{8.0 * k + 6, 1.5, 0}, X * 3, Z * 2, 8, here);
      made.patch(Vec3{8.0 * k + 6, 0, 1.5}, Y * 2, X * 3, 8, here);
      if (k % 4 == 1) made.patch(Vec3{8.0 * k + 9, 0, 0}, Y * 0.5, Z * 2, 4, here);
    }
    RegistrationOptions options{
        .model = model, .position_m = 0.05, .heading = Angle::degrees(0.5), .tilt = Angle::degrees(tilt)};
    const NetworkCounts counts = made.counts();
    const RegistrationInputs inputs = registration_inputs(counts, counts.voxels, options, nullptr, 0);
    const RegistrationAdjustment adjustment(inputs.held_by, inputs.share, inputs.covered, options, {&target, 1});
    ASSERT_GE(adjustment.stations().size(), 64u);
    const Eigen::MatrixXd covariance = adjustment.covariance(), metric = adjustment.metric();
    const RegistrationError error = adjustment.error();
    const double square = (metric * covariance).trace();
    EXPECT_NEAR(error.rms_m * error.rms_m, square, 1e-9 * square);
    EXPECT_GT(error.worst_m, error.rms_m);
    EXPECT_TRUE(error.absolute_rms_m);
  }
}

// Rows of a block, and the share of pairs of blocks that are tied: few leave a sparse factor.
class PartialInverseTest : public testing::TestWithParam<std::tuple<Eigen::Index, double>> {};
INSTANTIATE_TEST_SUITE_P(Blocks, PartialInverseTest,
                         testing::Combine(testing::Values(3, 4, 6), testing::Values(0.04, 0.16, 0.9)));

// A positive definite matrix in which the pairs of blocks are tied that tied(i, j) says, and its parts against its
// inverse.
void expect_partial_inverse(std::size_t blocks, Eigen::Index size,
                            const std::function<bool(std::size_t, std::size_t)>& tied) {
  std::mt19937 random(3);
  const auto number = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  const auto at = [&](std::size_t block) { return static_cast<Eigen::Index>(block) * size; };
  SparseBlocks matrix{.diagonal = std::vector<SmallBlock>(blocks, SmallBlock::Identity(size, size)), .pairs = {}};
  for (std::size_t i = 0; i < blocks; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      if (i != j && !tied(i, j)) continue;
      const Eigen::MatrixXd part = Eigen::MatrixXd::NullaryExpr(size, size, number);
      for (const std::size_t own : {i, j}) matrix.diagonal[own] += part.transpose() * part;
      if (i != j) matrix.pairs.push_back({i, j, -part.transpose() * part});
    }
  const Eigen::MatrixXd full = matrix.dense();
  ASSERT_EQ(full, full.transpose());
  ASSERT_EQ(full.block(at(1), at(1), size, size), matrix.diagonal[1]);
  for (const SparseBlocks::Pair& pair : matrix.pairs)
    ASSERT_EQ(full.block(at(pair.row), at(pair.column), size, size), pair.block);
  const Eigen::MatrixXd right = Eigen::MatrixXd::NullaryExpr(at(blocks), 3, number), inverse = full.inverse();
  const PartialInverse found = partial_inverse(matrix, right);
  EXPECT_LT((found.times - inverse * right).cwiseAbs().maxCoeff(), 1e-12);
  ASSERT_EQ(found.blocks.size(), blocks);
  for (std::size_t k = 0; k < blocks; ++k)
    EXPECT_LT((found.blocks[k] - inverse.block(at(k), at(k), size, size)).cwiseAbs().maxCoeff(), 1e-12) << k;
}

TEST_P(PartialInverseTest, HasTheBlocksOfTheInverse) {
  std::mt19937 random(5);
  const auto [size, share] = GetParam();
  expect_partial_inverse(40, size, [&, most = share](std::size_t, std::size_t) {
    return static_cast<double>(random()) < most * 4294967296.0;
  });
}

// Stations of a floor are tied to those beside them: columns that fill up only where parts of the floor meet.
TEST(PartialInverse, OfAGridHasTheBlocksOfTheInverse) {
  constexpr std::size_t kSide = 13;
  expect_partial_inverse(kSide * kSide, 4, [](std::size_t i, std::size_t j) {
    return i % kSide == j % kSide ? i - j <= kSide : i / kSide == j / kSide && i - j <= 2;
  });
}

TEST(PartialInverse, OfBlocksWithoutPairsIsOfEachBlock) {
  expect_partial_inverse(5, 6, [](std::size_t, std::size_t) { return false; });
  expect_partial_inverse(2, 6, [](std::size_t, std::size_t) { return true; });
}

TEST(RegistrationError, IsAbsoluteWhereAControlPointIsSeen) {
  Tied tied;
  const NetworkCounts counts = tied.made.counts();
  const auto error = [&](std::span<const RegistrationTarget> targets) {
    return registration_error(counts, counts.voxels, tied.options, nullptr, 0, targets);
  };
  EXPECT_FALSE(error({}).absolute_rms_m);
  EXPECT_FALSE(error(std::span(tied.targets).first(2)).absolute_rms_m);
  const RegistrationError tied_in = error(tied.targets);
  ASSERT_TRUE(tied_in.absolute_rms_m);
  EXPECT_GT(*tied_in.absolute_rms_m, tied_in.rms_m);
  EXPECT_LT(*tied_in.absolute_rms_m, 0.05);
  EXPECT_LT(tied_in.rms_m, 0.5 * error({}).rms_m) << "targets hold what slides along the corridor";
  tied.targets.back().seen_by.clear(), tied.targets[2].seen_by.clear();
  EXPECT_FALSE(error(tied.targets).absolute_rms_m);
}

// Two stations in a hall of 37 × 33 × 12 m, as of a field check of a scanner whose surfaces predicted 0.06 mm where
// targets had 1.2; an instrument of 14.4″, 1 mm and 10 ppm.
Made hall() {
  Made m{.heads = {{-6, -3, 1.8}, {7, 4, 1.9}}};
  m.patch({0, 0, 0}, X * 37, Y * 33, 60, 3);
  m.patch({0, 0, 12}, Y * 33, X * 37, 60, 3);
  for (const double s : {-1.0, 1.0}) {
    m.patch({18.5 * s, 0, 6}, Y * (-33 * s), Z * 12, 40, 3);
    m.patch({0, 16.5 * s, 6}, X * (37 * s), Z * 12, 40, 3);
  }
  m.scanner.angle = static_cast<float>(14.4 / 3600 * std::numbers::pi / 180);
  m.scanner.offset_m = 0.001f, m.scanner.scale = 1e-5f, m.scanner.range_m = 120;
  return m;
}

// Place at which a scanner with one error sees a point: its range and angles are changed, and read back.
Vec3 seen_with(int error, const PatchScanner& scanner, const Vec3& head, double start, const Vec3& point) {
  const Vec3 v = point - head;
  double range = std::sqrt(dot(v, v)), azimuth = std::atan2(v.y, v.x), zenith = std::acos(v.z / range);
  const double face = std::sin(azimuth - start) > 0 ? 1 : -1;
  if (error == 0) zenith += face * scanner.angle;
  if (error == 1) azimuth += face * scanner.angle / std::sin(zenith);
  if (error == 2) azimuth += face * scanner.angle / std::tan(zenith);
  if (error == 3) range += scanner.offset_m;
  if (error == 4) range *= 1 + scanner.scale;
  return head +
         Vec3{std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)} * range;
}

// Normal equations of the two scans, with a plane for each voxel, solved for the motions that each error causes.
TEST(InstrumentErrors, MoveScansAsAnAdjustmentOfMeasurementsThatHaveThem) {
  for (const bool turned : {false, true}) {
    Made m = hall();
    RegistrationOptions options{.model = model};
    // Directions in which scans begin: drawn four times, but for scanners that are turned.
    const auto start_of = [turned](std::size_t k, int draw) {
      const double golden = std::numbers::pi * (3 - std::sqrt(5.0)), quarter = std::numbers::pi / 2;
      return turned ? 0.3 + 1.7 * static_cast<double>(k)
                    : static_cast<double>(k) * (golden + draw * quarter) + draw * quarter / 4;
    };
    std::vector<TraceStation> stations = m.stations();
    if (turned)
      for (std::size_t k = 0; k < 2; ++k) {
        const auto c = static_cast<float>(std::cos(start_of(k, 0))), s = static_cast<float>(std::sin(start_of(k, 0)));
        stations[k].turn = Turn{{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
      }
    NetworkCounts counts = m.counts();
    const std::vector<PatchScanner> scanners = m.scanners();
    counts.registration = sum_patches(m.patches(), scanners, stations, 2, m.masks, 0).front();
    const RegistrationError found = registration_error(counts, counts.voxels, options);

    const auto row = [](const Vec3& p, const Vec3& head, const Vec3& n) {
      const Vec3 q = p - head, turn = cross(q, n);
      Eigen::Matrix<double, 1, 6> r;
      r << turn.x, turn.y, turn.z, n.x, n.y, n.z;
      return r;
    };
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(12, 12), right = Eigen::MatrixXd::Zero(12, 20);
    const auto weight = [](double sigma) { return 1 / (sigma * sigma); };
    for (int k = 0; k < 2; ++k)
      for (int a = 0; a < 6; ++a)
        normal(6 * k + a, 6 * k + a) = a < 2   ? weight(options.tilt.in_radians())
                                       : a < 3 ? weight(options.heading.in_radians())
                                               : weight(options.position_m);
    double area = 0;
    Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(12, 12);  // Σ area · (displacement of the surface)²
    for (const VoxelSurface& s : m.surfaces) {
      const Vec3 p{s.point.x, s.point.y, s.point.z}, n{s.normal.x, s.normal.y, s.normal.z};
      Eigen::RowVectorXd j(12);
      j << row(p, m.heads[0], n), -row(p, m.heads[1], n);
      const double w = s.area / (2 * model.rho_m * model.rho_m * model.patch_m * model.patch_m);
      normal += w * j.transpose() * j;
      for (int column = 0; column < 20; ++column) {
        const auto moved = [&](std::size_t k) {
          return dot(seen_with(column % 5, scanners[0], m.heads[k], start_of(k, column / 5), p) - p, n);
        };
        right.col(column) -= w * j.transpose() * (moved(0) - moved(1));
      }
      area += s.area;
      for (std::size_t k = 0; k < 2; ++k) {
        Eigen::MatrixXd at = Eigen::MatrixXd::Zero(3, 12);
        const Vec3 q = p - m.heads[k];
        Eigen::Matrix3d cross;
        cross << 0, -q.z, q.y, q.z, 0, -q.x, -q.y, q.x, 0;
        at.block(0, 6 * static_cast<Eigen::Index>(k), 3, 3) = -cross;
        at.block(0, 6 * static_cast<Eigen::Index>(k) + 3, 3, 3) = Eigen::Matrix3d::Identity();
        moments += s.area / 2 * at.transpose() * at;
      }
    }
    // Motions of the whole are no error: the same small motion of both heads, whatever it is.
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(12, 6);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto at = 6 * static_cast<Eigen::Index>(k);
      const Vec3& h = m.heads[k];
      Eigen::Matrix3d cross;
      cross << 0, -h.z, h.y, h.z, 0, -h.x, -h.y, h.x, 0;
      whole.block(at, 0, 3, 3) = whole.block(at + 3, 3, 3, 3) = Eigen::Matrix3d::Identity();
      whole.block(at + 3, 0, 3, 3) = -cross;
    }
    const Eigen::MatrixXd motions = normal.ldlt().solve(right);
    double square = 0;
    for (int column = 0; column < 20; ++column) {
      const Eigen::VectorXd x = motions.col(column);
      const Eigen::VectorXd fit = (whole.transpose() * moments * whole).ldlt().solve(whole.transpose() * moments * x);
      const Eigen::VectorXd rest = x - whole * fit;
      square += rest.dot(moments * rest) / area / 4;  // the mean of the draws
    }
    const double instrument = std::sqrt(found.rms_m * found.rms_m - found.random_m * found.random_m);
    EXPECT_NEAR(instrument, std::sqrt(square), 0.01 * instrument) << turned;
    EXPECT_LT(found.random_m, 0.2e-3);
    if (!turned) {
      EXPECT_GT(found.rms_m, 0.5e-3);
      EXPECT_LT(found.rms_m, 1.5e-3);
    }
  }
}

TEST(InstrumentErrors, AddNothingWhereTheScannerStatesNone) {
  Made m = hall();
  m.scanner = {};
  const NetworkCounts counts = m.counts();
  EXPECT_TRUE(counts.registration.instrument.empty());
  const RegistrationError error = registration_error(counts, counts.voxels, {.model = model});
  EXPECT_EQ(error.rms_m, error.random_m);
}

TEST(InstrumentErrors, SumsDoNotDependOnGroups) {
  Made m = hall();
  const auto sums = [&](std::uint32_t groups) {
    return sum_patches(m.patches(), m.scanners(), m.stations(), 2, m.masks, groups);
  };
  const auto whole = sums(0), parts = sums(20);
  EXPECT_EQ(parts[0].instrument, whole[0].instrument);
  double sum = 0;
  for (std::size_t g = 1; g < parts.size(); ++g) sum += parts[g].instrument[50];
  EXPECT_NE(sum, 0);
  EXPECT_NEAR(sum, whole[0].instrument[50], 1e-9 * std::abs(sum));
}

}  // namespace
}  // namespace vantage
