// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/quad_scene.hpp"
#include "support/temporary_folder.hpp"
#include "unit/formats/files.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

constexpr Vec3 kPlace{500'000.123456789, 5'600'000.25, 100};

// A station that exists, and two placed ones: from the entrance 10 m east, then 6 m north, and back.
Evaluation walked() {
  Evaluation evaluation;
  for (const Vec3& ground : {Vec3{1, 1, 0}, Vec3{10, 6, 0.5}, Vec3{10, 0, 0}})
    evaluation.stations.push_back({.uv = {}, .position = kPlace + ground + Vec3{0, 0, 1.8}, .ground = kPlace + ground});
  evaluation.stations[0].existing = true;
  evaluation.stations[1].setup.heading = Angle::degrees(30);
  Visit visit;
  visit.order = {1, 0};
  visit.legs_m = {10, 6, 12}, visit.arrive_min = {0.25, 4}, visit.stay_min = {3.5, 4.5}, visit.minutes = 9;
  const Vec3 corner = kPlace + Vec3{5, 0, 0}, back = kPlace + Vec3{0, 6, 0};
  visit.paths = {{kPlace, corner, evaluation.stations[2].ground},
                 {evaluation.stations[2].ground, evaluation.stations[1].ground},
                 {evaluation.stations[1].ground, back, kPlace}};
  evaluation.visit = visit;
  return evaluation;
}

std::vector<Scanner> scanners() {
  Scanner scanner = test::coarse_scanner(2);
  scanner.heading = Angle::degrees(90);
  return {scanner};
}

TEST(Waypoints, AreInTheSitesSystemAndLookTheWayTheyAreReached) {
  const test::TemporaryFolder folder;
  write_waypoints(folder / "w.csv", walked(), scanners(), "EPSG:25832");
  EXPECT_EQ(test::content(folder / "w.csv"),
            "day,crew,order,name,x,y,z,head_height,heading,first_column,dwell_s,wait_s\n"
            "1,1,1,S2,500010.123456789,5600000.25,100,1.800,0.00,-89.00,210.0,0.0\n"
            "1,1,2,S1,500010.123456789,5600006.25,100.5,1.800,90.00,-59.00,270.0,0.0\n");
  write_waypoints(folder / "w.json", walked(), scanners(), "EPSG:25832");
  const auto json = nlohmann::json::parse(test::content(folder / "w.json"));
  EXPECT_EQ(json["crs"], "EPSG:25832");
  ASSERT_EQ(json["rounds"].size(), 1u);
  const auto& round = json["rounds"][0];
  const auto point = [](const nlohmann::json& p) { return Vec3{p[0], p[1], p[2]}; };
  EXPECT_EQ(point(round["start"]), kPlace);
  EXPECT_EQ(round["minutes"], 9);
  ASSERT_EQ(round["waypoints"].size(), 2u);
  const auto& second = round["waypoints"][1];
  EXPECT_EQ(second["order"], 2);
  EXPECT_EQ(second["name"], "S1");
  EXPECT_EQ(point(second["position"]), walked().stations[1].ground) << "every bit";
  EXPECT_NEAR(second["orientation"]["z"].get<double>(), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(second["orientation"]["w"].get<double>(), std::sqrt(0.5), 1e-12);
  EXPECT_EQ(second["dwell_s"], 270);
  EXPECT_EQ(round["waypoints"][0]["path"].size(), 3u);
  EXPECT_EQ(point(round["back"].back()), kPlace);
}

TEST(Waypoints, AreThoseOfEachSession) {
  const test::TemporaryFolder folder;
  Evaluation evaluation = walked();
  for (std::size_t k = 0; k < 2; ++k) {
    Session one;
    one.day = 1, one.crew = k + 1, one.order = {evaluation.visit->order[k]}, one.stay_min = {3};
    const Vec3 ground = evaluation.stations[1 + one.order[0]].ground;
    one.paths = {{kPlace, ground}, {ground, kPlace}};
    evaluation.visit->sessions.push_back(one);
  }
  write_waypoints(folder / "w.csv", evaluation, scanners(), "");
  const std::string table = test::content(folder / "w.csv");
  EXPECT_NE(table.find("\n1,1,1,S2,"), std::string::npos) << table;
  EXPECT_NE(table.find("\n1,2,1,S1,"), std::string::npos) << table;
  EXPECT_NE(table.find(",30.96,"), std::string::npos) << "6 m north of 10 m east: " << table;
  write_waypoints(folder / "w.json", evaluation, scanners(), "");
  const auto json = nlohmann::json::parse(test::content(folder / "w.json"));
  EXPECT_TRUE(json["crs"].is_null());
  EXPECT_EQ(json["rounds"].size(), 2u);
}

TEST(Waypoints, WithoutAnEntranceTheFirstLooksToTheSecond) {
  const test::TemporaryFolder folder;
  Evaluation evaluation = walked();
  evaluation.visit->paths[0].clear();
  write_waypoints(folder / "w.csv", evaluation, scanners(), "");
  EXPECT_NE(test::content(folder / "w.csv").find("1,1,1,S2,500010.123456789,5600000.25,100,1.800,90.00,"),
            std::string::npos);
  write_waypoints(folder / "w.json", evaluation, scanners(), "");
  const auto start = nlohmann::json::parse(test::content(folder / "w.json"))["rounds"][0]["start"];
  EXPECT_EQ(start[0].get<double>(), evaluation.stations[2].ground.x);
}

TEST(Waypoints, OfNoRoundAreRefused) {
  const test::TemporaryFolder folder;
  Evaluation evaluation = walked();
  EXPECT_THROW(write_waypoints(folder / "w.txt", evaluation, scanners(), ""), Error);
  evaluation.visit.reset();
  EXPECT_THROW(write_waypoints(folder / "w.csv", evaluation, scanners(), ""), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "w.csv"));
}

}  // namespace
}  // namespace vantage
