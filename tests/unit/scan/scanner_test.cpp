// SPDX-License-Identifier: Apache-2.0
#include "vantage/scanner.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "vantage/error.hpp"

namespace vantage {
namespace {

Scanner with_step(double degrees) {
  Scanner scanner;
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(degrees);
  return scanner;
}

TEST(Scanner, CountsRaysAsThePaperDoes) {
  EXPECT_EQ(with_step(0.1).columns(), 3600u);
  EXPECT_EQ(with_step(0.1).rows(), 1500u);
  EXPECT_EQ(with_step(0.0286).columns(), 12587u);  // Table 4
  EXPECT_EQ(with_step(0.0286).rows(), 5244u);
  EXPECT_EQ(with_step(0.0286).rays(), 66'006'228u);
}

TEST(Scanner, FloorsAreGuarded) {
  // n steps of 360°/n make n columns, for every n, however 360/n rounds.
  for (std::uint32_t n = 1; n <= 20'000; ++n) {
    Scanner scanner = with_step(360.0 / n);
    scanner.vertical_angle = Angle::degrees(360);
    EXPECT_EQ(scanner.columns(), n);
    EXPECT_EQ(scanner.rows(), n / 2);
  }
  Scanner narrow = with_step(0.7);
  narrow.horizontal_angle = Angle::degrees(0.7);
  EXPECT_EQ(narrow.columns(), 1u);
}

TEST(Scanner, AnglesFollowTheIndex) {
  Scanner scanner = with_step(0.1);
  scanner.heading = Angle::degrees(10);
  EXPECT_NEAR(scanner.angles(0).zenith.in_degrees(), 0.05, 1e-12);
  EXPECT_NEAR(scanner.angles(0).azimuth.in_degrees(), -169.95, 1e-12);
  const std::uint64_t ray = 700ull * 3600 + 1800;
  EXPECT_NEAR(scanner.angles(ray).zenith.in_degrees(), 70.05, 1e-12);
  EXPECT_NEAR(scanner.angles(ray).azimuth.in_degrees(), 10.05, 1e-12);
}

TEST(Scanner, DefaultAndPaperScannersPass) {
  EXPECT_NO_THROW(Scanner{}.check());
  Scanner scanner = with_step(0.0286);
  scanner.noise = rtc360_noise();
  EXPECT_NO_THROW(scanner.check());
  scanner.horizontal_angle = Angle::radians(2 * 3.141592653589793);
  scanner.vertical_angle = Angle::degrees(200);
  scanner.zenith_start = Angle::degrees(30);
  scanner.noise.reflectivities.front() = 0;
  scanner.noise.reflectivities.back() = 1;
  EXPECT_NO_THROW(scanner.check());
}

std::vector<Angle> degrees(std::initializer_list<double> values) {
  std::vector<Angle> angles;
  for (const double value : values) angles.push_back(Angle::degrees(value));
  return angles;
}

TEST(Scanner, UnevenRowsHaveTheirZeniths) {
  Scanner scanner = with_step(0.5);
  scanner.set_row_zeniths(degrees({61, 62.5, 90, 105}));
  EXPECT_NO_THROW(scanner.check());
  EXPECT_EQ(scanner.rows(), 4u);
  EXPECT_EQ(scanner.columns(), 720u);
  EXPECT_DOUBLE_EQ(scanner.zenith_start.in_degrees(), 61);
  EXPECT_DOUBLE_EQ(scanner.zenith_start.in_degrees() + scanner.vertical_angle.in_degrees() / 2, 105);
  EXPECT_NEAR(scanner.zenith_step.in_degrees(), 44.0 / 3, 1e-12);
  EXPECT_DOUBLE_EQ(scanner.angles(2 * 720 + 5).zenith.in_degrees(), 90);
  EXPECT_EQ(scanner.angles(2 * 720 + 5).azimuth, with_step(0.5).angles(5).azimuth);
  scanner.set_steps(Angle::degrees(1), Angle::degrees(1));
  EXPECT_NO_THROW(scanner.check());
  EXPECT_EQ(scanner.rays(), 4u * 360);
  // A single row, even at a pole.
  for (const double zenith : {0.0, 90.0, 180.0}) {
    scanner.set_row_zeniths(degrees({zenith}));
    EXPECT_NO_THROW(scanner.check());
    EXPECT_EQ(scanner.rows(), 1u);
    EXPECT_DOUBLE_EQ(scanner.angles(0).zenith.in_degrees(), zenith);
  }
  scanner.set_row_zeniths({});
  EXPECT_EQ(scanner.rows(), 1u);
  EXPECT_TRUE(scanner.row_zeniths.empty());
}

// Pairs of azimuth and zenith.
std::vector<RayAngles> listed(std::initializer_list<std::array<double, 2>> pairs) {
  std::vector<RayAngles> directions;
  for (const auto& [azimuth, zenith] : pairs) directions.push_back({Angle::degrees(zenith), Angle::degrees(azimuth)});
  return directions;
}

TEST(Scanner, AListOfDirectionsHasItsOrderAndTimes) {
  Scanner scanner;
  scanner.heading = Angle::degrees(100);
  scanner.points_per_second = 10;
  scanner.set_directions(listed({{350, 80}, {20, 60}, {-40, 95}, {20, 60}}));
  EXPECT_NO_THROW(scanner.check());
  EXPECT_EQ(scanner.rays(), 4u);
  EXPECT_EQ(scanner.rows(), 4u);
  EXPECT_EQ(scanner.columns(), 1u);
  EXPECT_FALSE(scanner.one_step());
  EXPECT_DOUBLE_EQ(scanner.angles(2).azimuth.in_degrees(), 60);
  EXPECT_DOUBLE_EQ(scanner.angles(0).azimuth.in_degrees(), 450);
  EXPECT_NEAR(scanner.zenith_start.in_degrees(), 60, 1e-12);
  EXPECT_NEAR(scanner.vertical_angle.in_degrees(), 70, 1e-12);
  EXPECT_NEAR(scanner.horizontal_angle.in_degrees(), 80, 1e-12) << "twice the largest distance from the heading";
  EXPECT_NEAR(scanner.azimuth_step.in_degrees(), std::sqrt(35.0 * 80 / 4), 1e-9);
  EXPECT_DOUBLE_EQ(scanner.seconds(), 0.4);
  EXPECT_DOUBLE_EQ(scanner.time_s(3), 0.3);
  EXPECT_THROW(scanner.set_steps(Angle::degrees(1), Angle::degrees(1)), Error);
  scanner.set_directions(scanner.directions, {0, 0.5, 0.5, 2});
  EXPECT_NO_THROW(scanner.check());
  EXPECT_EQ(scanner.time_s(1), 0.5);
  EXPECT_EQ(scanner.seconds(), 2);
  // A point, and lines.
  for (const auto& directions :
       {listed({{0, 0}}), listed({{0, 180}}), listed({{180, 3}, {-180, 3}}), listed({{7, 3}, {7, 90}, {7, 180}})}) {
    scanner.set_directions(directions);
    EXPECT_NO_THROW(scanner.check());
  }
  scanner.set_directions({});
  EXPECT_TRUE(scanner.times_s.empty());
  EXPECT_NO_THROW(scanner.set_steps(Angle::degrees(1), Angle::degrees(1)));
}

TEST(Scanner, RefusesWhatCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const struct {
    const char* says;
    std::function<void(Scanner&)> spoil;
  } cases[] = {
      {"heading in degrees is inf", [&](Scanner& s) { s.heading = Angle::degrees(inf); }},
      {"horizontal_angle in degrees is 0", [](Scanner& s) { s.horizontal_angle = Angle::degrees(0); }},
      {"horizontal_angle in degrees is 361", [](Scanner& s) { s.horizontal_angle = Angle::degrees(361); }},
      {"vertical_angle in degrees is -1", [](Scanner& s) { s.vertical_angle = Angle::degrees(-1); }},
      {"vertical_angle in degrees is nan", [&](Scanner& s) { s.vertical_angle = Angle::degrees(nan); }},
      {"zenith_start in degrees is 31", [](Scanner& s) { s.zenith_start = Angle::degrees(31); }},
      {"zenith_start in degrees is -1", [](Scanner& s) { s.zenith_start = Angle::degrees(-1); }},
      {"azimuth_step in degrees is 0", [](Scanner& s) { s.azimuth_step = Angle::degrees(0); }},
      {"azimuth_step in degrees is 400", [](Scanner& s) { s.azimuth_step = Angle::degrees(400); }},
      {"zenith_step in degrees is nan", [&](Scanner& s) { s.zenith_step = Angle::degrees(nan); }},
      {"zenith_step in degrees is 151", [](Scanner& s) { s.zenith_step = Angle::degrees(151); }},
      {"zenith_step in degrees is 1e-06", [](Scanner& s) { s.zenith_step = Angle::degrees(1e-6); }},
      {"row_zeniths[1] in degrees is nan",
       [&](Scanner& s) {
         s.row_zeniths = degrees({10, nan});
       }},
      {"row_zeniths[1] in degrees is 10, but must be above the zenith before it, 10",
       [](Scanner& s) {
         s.row_zeniths = degrees({10, 10, 12});
       }},
      {"row_zeniths[2] in degrees is 9",
       [](Scanner& s) {
         s.set_row_zeniths(degrees({8, 10, 9}));
       }},
      {"row_zeniths[0] in degrees is -1",
       [](Scanner& s) {
         s.set_row_zeniths(degrees({-1, 10}));
       }},
      {"row_zeniths[1] in degrees is 181",
       [](Scanner& s) {
         s.set_row_zeniths(degrees({3, 181}));
       }},
      {"row_zeniths from 10 to 170 degrees must lie in the vertical field, 0 to 150",
       [](Scanner& s) {
         s.row_zeniths = degrees({10, 170});
       }},
      {"zenith_step in degrees is 0.1, but must be the mean step of row_zeniths, 20",
       [](Scanner& s) {
         s.row_zeniths = degrees({10, 20, 50});
       }},
      {"number of row_zeniths is 16777217", [](Scanner& s) { s.row_zeniths.resize((1u << 24) + 1); }},
      {"directions[1]: zenith in degrees is 181",
       [&](Scanner& s) {
         s.directions = listed({{0, 3}, {0, 181}});
       }},
      {"directions[0]: zenith in degrees is nan",
       [&](Scanner& s) {
         s.directions = listed({{0, nan}});
       }},
      {"directions[1]: azimuth in degrees is 361",
       [&](Scanner& s) {
         s.directions = listed({{0, 3}, {361, 4}});
       }},
      {"number of times_s is 1, but must be that of directions, 2",
       [&](Scanner& s) {
         s.set_directions(listed({{0, 3}, {5, 8}}), {0});
       }},
      {"number of times_s is 2, but must be 0 without directions",
       [](Scanner& s) {
         s.times_s = {0, 1};
       }},
      {"times_s[1] is 0, but must be finite and at least the time before it, 1",
       [&](Scanner& s) {
         s.set_directions(listed({{0, 3}, {5, 8}}), {1, 0});
       }},
      {"times_s[0] is -1",
       [&](Scanner& s) {
         s.set_directions(listed({{0, 3}, {5, 8}}), {-1, 0});
       }},
      {"a step in degrees is 0.1, but must be the mean step of directions",
       [&](Scanner& s) {
         s.directions = listed({{0, 3}, {5, 8}});
       }},
      {"directions must lie in the field",
       [&](Scanner& s) {
         s.set_directions(listed({{0, 3}, {5, 8}}));
         s.zenith_start = Angle::degrees(7);
       }},
      {"both directions and row_zeniths",
       [&](Scanner& s) {
         s.set_directions(listed({{0, 3}, {5, 8}}));
         s.row_zeniths = degrees({10, 20});
       }},
      {"height_m is -1", [](Scanner& s) { s.height_m = -1; }},
      {"min_range_m is -0.1", [](Scanner& s) { s.min_range_m = -0.1; }},
      {"max_range_m is 0.1", [](Scanner& s) { s.max_range_m = 0.1; }},
      {"max_range_m is inf", [&](Scanner& s) { s.max_range_m = inf; }},
      {"noise table has 2 values", [](Scanner& s) { s.noise.sigma_m.resize(2); }},
      {"distance in metres is 5", [](Scanner& s) { s.noise.distances_m[1] = 5; }},
      {"reflectivity is 1.5", [](Scanner& s) { s.noise.reflectivities[2] = 1.5; }},
      {"reflectivity is 0.08", [](Scanner& s) { s.noise.reflectivities[1] = 0.08; }},
      {"standard deviation in metres is -1", [](Scanner& s) { s.noise.sigma_m[3] = -1; }},
  };
  for (const auto& c : cases) {
    Scanner scanner;
    scanner.noise = rtc360_noise();
    c.spoil(scanner);
    try {
      scanner.check();
      ADD_FAILURE() << "passed, but should say: " << c.says;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), Errc::invalid_argument);
      EXPECT_NE(std::string(e.what()).find(c.says), std::string::npos) << e.what();
    }
  }
}

TEST(Rtc360Noise, IsTable1) {
  const NoiseTable t = rtc360_noise();
  EXPECT_EQ(t.distances_m, (std::vector<double>{5, 10, 20, 40, 60}));
  EXPECT_EQ(t.reflectivities, (std::vector<double>{0.08, 0.21, 0.89}));
  EXPECT_EQ(t.sigma_m[0 * 5 + 3], 2.5e-3);
  EXPECT_EQ(t.sigma_m[1 * 5 + 4], 2.0e-3);
  EXPECT_EQ(t.sigma_m[2 * 5 + 0], 0.3e-3);
}

}  // namespace
}  // namespace vantage
