// SPDX-License-Identifier: Apache-2.0
#include "vantage/on_site.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "evaluate/storey_ties.hpp"
#include "evaluate/ways.hpp"
#include "support/quad_scene.hpp"
#include "support/site_of.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/candidates.hpp"
#include "vantage/error.hpp"
#include "vantage/summary.hpp"

namespace vantage {
namespace {

void add_rectangle(SearchMesh& mesh, double x0, double x1, double y0, double y1, double z) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const auto& [x, y] : {std::pair{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}) {
    mesh.positions.push_back({x, y, z});
    mesh.uvs.push_back({x / 100 + z, y / 100});
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

bool everywhere(const Vec3&, const Vec3&) { return true; }

TEST(Ways, AreAsLongAsTheyAre) {
  SearchMesh square;
  add_rectangle(square, 0, 20, 0, 20, 0);
  const Ways ways(square, everywhere);
  for (const Vec3& to : {Vec3{19, 1, 0}, Vec3{19, 19, 0}, Vec3{19, 10, 0}, Vec3{5, 18, 0}}) {
    const double straight = std::sqrt(dot(to - Vec3{1, 1, 0}, to - Vec3{1, 1, 0}));
    const auto found = ways.between({1, 1, 0}, to);
    ASSERT_TRUE(found);
    EXPECT_GE(*found, straight * 0.999);
    EXPECT_LE(*found, straight * 1.03 + 0.1);
    EXPECT_EQ(*found, *ways.between(to, {1, 1, 0})) << "the way back is as long";
  }
}

TEST(Ways, AreTheSameForAllPairsAtOnce) {
  SearchMesh apart;  // two squares that nothing connects, and points on both and off them
  add_rectangle(apart, 0, 10, 0, 10, 0);
  add_rectangle(apart, 20, 30, 0, 10, 0);
  const Ways ways(apart, everywhere);
  const std::vector<Vec3> points{{1, 1, 0}, {9, 8, 0}, {21, 1, 0}, {1, 1, 0}, {100, 100, 0}, {5, 9, 0}};
  const auto all = ways.between_all(points);
  int connected = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      EXPECT_EQ(all[i][j], ways.between(points[i], points[j])) << i << ' ' << j;
      connected += all[i][j].has_value();
    }
  EXPECT_EQ(connected, 6) << "of the four on the first square";
}

// Places of two cells of the grid coincide where ground lies at their common side.
TEST(Ways, EndWherePlacesCoincide) {
  SearchMesh ground;
  add_rectangle(ground, -5, 0.2, 9.5, 10.5, 0);
  add_rectangle(ground, 0.125 - 1e-9, 0.125 + 1e-9, 0, 10, 0);
  const std::vector<Vec3> path = Ways(ground, everywhere).path({-4, 10, 0}, {0.125, 1, 0});
  ASSERT_GE(path.size(), 3u);
  EXPECT_EQ(path.front().x, -4);
  EXPECT_EQ(path.back().y, 1);
}

TEST(Ways, GoRoundCornersAndWalls) {
  SearchMesh corner;  // an L of two arms, 10 m long and 2 m wide
  add_rectangle(corner, 0, 10, 0, 2, 0);
  add_rectangle(corner, 0, 2, 2, 10, 0);
  const auto round = Ways(corner, everywhere).between({9, 1, 0}, {1, 9, 0});
  ASSERT_TRUE(round);
  EXPECT_NEAR(*round, 2 * std::hypot(7.0, 1.0), 0.6);  // past the inner corner (2, 2)

  SearchMesh square;
  add_rectangle(square, 0, 20, 0, 20, 0);
  const auto past_a_wall = [](const Vec3& a, const Vec3& b) {  // at x = 10.1, up to y = 15
    return (a.x < 10.1) == (b.x < 10.1) || std::min(a.y, b.y) > 15;
  };
  const auto detour = Ways(square, past_a_wall).between({9, 5, 0}, {11, 5, 0});
  ASSERT_TRUE(detour);
  EXPECT_NEAR(*detour, std::hypot(10.0, 1.1) + std::hypot(10.0, 0.9), 1.3);
}

TEST(Ways, ClimbStairsAndNotWalls) {
  SearchMesh stairs;
  add_rectangle(stairs, 0, 5, 0, 2, 0);
  for (int k = 0; k < 10; ++k) add_rectangle(stairs, 5 + 0.28 * k, 5.28 + 0.28 * k, 0, 2, 0.17 * (k + 1));
  add_rectangle(stairs, 7.8, 12, 0, 2, 1.7);
  const auto up = Ways(stairs, everywhere).between({1, 1, 0}, {11, 1, 1.7});
  ASSERT_TRUE(up);
  EXPECT_NEAR(*up, 4 + std::hypot(2.8, 1.7) + 3.2, 0.7);

  SearchMesh ledge;
  add_rectangle(ledge, 0, 5, 0, 5, 0);
  add_rectangle(ledge, 5, 10, 0, 5, 1.7);
  EXPECT_FALSE(Ways(ledge, everywhere).between({1, 1, 0}, {9, 1, 1.7}));
  EXPECT_FALSE(Ways(ledge, everywhere).between({1, 1, 0}, {50, 1, 0})) << "no ground near it";
}

// A ground of 40 × 40 m beside a wall.
struct Yard {
  SearchMesh ground;
  Scene scene = Scene::from_triangles(std::vector<Vec3>{{0, 60, 0}, {40, 60, 0}, {40, 60, 3}, {0, 60, 3}},
                                      std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}});
  Scanner scanner;
  Yard() {
    add_rectangle(ground, 0, 40, 0, 40, 0);
    scanner.azimuth_step = scanner.zenith_step = Angle::degrees(0.1);  // 5.4 million rays
    scanner.points_per_second = 90'000;                                // one minute
  }
  Site site(const std::vector<Scanner>& scanners) const {
    return test::site_of(
        Simulator(scene, scanners, {.engine = Engine::embree, .user_size_m = 1, .point_spacing_m = 0.5}),
        SearchArea::from_mesh(ground));
  }
  OnSite on_site(const OnSiteOptions& options = {}) const { return site({scanner}).on_site(options); }
};

std::vector<PlacedStation> stations_at(const std::vector<Vec3>& grounds) {
  std::vector<PlacedStation> stations;
  for (const Vec3& ground : grounds)
    stations.push_back({.uv = {}, .position = ground + Vec3{0, 0, 1.8}, .ground = ground});
  return stations;
}

TEST(Ways, PathsAreOverTheGroundAndAsLongAsTheirWays) {
  SearchMesh corner;  // an L of two arms, 10 m long and 2 m wide
  add_rectangle(corner, 0, 10, 0, 2, 0);
  add_rectangle(corner, 0, 2, 2, 10, 0);
  const Ways ways(corner, everywhere);
  const Vec3 from{9, 1, 0}, to{1, 9, 0};
  for (const bool back : {false, true}) {
    const auto path = back ? ways.path(to, from) : ways.path(from, to);
    ASSERT_GE(path.size(), 3u) << "round the corner";
    EXPECT_EQ(path.front(), back ? to : from);
    EXPECT_EQ(path.back(), back ? from : to);
    double metres = 0;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      const Vec3 step = path[k + 1] - path[k];
      metres += std::sqrt(dot(step, step));
      const Vec3 middle = (path[k] + path[k + 1]) * 0.5;
      EXPECT_TRUE(std::min(middle.x, middle.y) < 2.3) << "across the corner";
    }
    EXPECT_NEAR(metres, *ways.between(from, to), 0.6);
  }
  EXPECT_EQ(ways.path(from, {50, 1, 0}).size(), 2u) << "straight where there is no way";
}

TEST(OnSite, AddsScansSettingUpAndWalking) {
  const OnSite on_site =
      Yard().on_site({.set_up_min = 2, .photos_min = 0.5, .walking_m_per_s = 0.5, .entrance = Vec3{0, 20, 0}});
  EXPECT_NEAR(on_site.minutes_per_scan(), 1, 1e-12);
  const Visit visit = on_site.visit(stations_at({{30, 20, 0}, {10, 20, 0}, {20, 20, 0}}));
  EXPECT_EQ(visit.order, (std::vector<std::size_t>{1, 2, 0}));
  ASSERT_EQ(visit.legs_m.size(), 4u);
  EXPECT_NEAR(visit.legs_m.back(), 30, 0.5) << "back out";
  EXPECT_NEAR(visit.walk_m, 60, 1);
  EXPECT_NEAR(visit.scan_min, 3, 1e-12);
  EXPECT_NEAR(visit.set_up_min, 6, 1e-12);
  EXPECT_NEAR(visit.walk_min, 2, 0.05);
  EXPECT_NEAR(visit.photos_min, 1.5, 1e-12);
  EXPECT_NEAR(visit.minutes, visit.scan_min + visit.set_up_min + visit.photos_min + visit.walk_min, 1e-12);
  ASSERT_EQ(visit.paths.size(), visit.legs_m.size());
  EXPECT_EQ(visit.paths.front().front(), (Vec3{0, 20, 0})) << "from the entrance";
  EXPECT_EQ(visit.paths.back().back(), (Vec3{0, 20, 0})) << "and back out";
  EXPECT_EQ(visit.unconnected, 0u);
}

TEST(OnSite, ScansTakeAsLongAsTheirScanners) {
  const Yard yard;
  std::vector<Scanner> scanners{yard.scanner, yard.scanner};
  scanners[1].azimuth_step = scanners[1].zenith_step = Angle::degrees(0.05);
  const OnSite on_site = yard.site(scanners).on_site();
  EXPECT_NEAR(on_site.minutes_per_scan(1), 4, 1e-12);
  auto stations = stations_at({{30, 20, 0}, {10, 20, 0}, {20, 20, 0}});
  EXPECT_NEAR(on_site.visit(stations).scan_min, 3, 1e-12);
  stations[1].setup.scanner = 1;
  EXPECT_NEAR(on_site.visit(stations).scan_min, 6, 1e-12);
  stations[0].setup.scanner = 2;
  EXPECT_THROW(on_site.visit(stations), std::out_of_range);
}

TEST(OnSite, LeavesOutWhatCannotBeUsedAndTellsOfWhatIsNotConnected) {
  const OnSite on_site = Yard().on_site({.detour = 2});
  auto stations = stations_at({{10, 10, 0}, {100, 10, 0}, {20, 10, 0}});
  stations[2].status = StationStatus::hole;
  const Visit visit = on_site.visit(stations);
  EXPECT_EQ(visit.order.size(), 2u);
  EXPECT_EQ(visit.unconnected, 2u);
  EXPECT_TRUE(on_site.way(stations[0].ground, stations[1].ground).empty());
  EXPECT_NEAR(visit.walk_m, 2 * 2 * 90, 1e-9);
  EXPECT_EQ(on_site.visit({}).minutes, 0);
  EXPECT_THROW(Yard().on_site({.walking_m_per_s = 0}), Error);
  EXPECT_THROW(Yard().on_site({.set_up_min = -1}), Error);
  EXPECT_THROW(Yard().on_site({.detour = 0.5}), Error);
}

// Ground in a doorway of 0.9 m is a strip that narrows to nothing between the jambs.
TEST(OnSite, GoesThroughEachOpenDoorOfAnOffice) {
  const auto file = std::filesystem::temp_directory_path() / ("on_site_office_" + std::to_string(getpid()) + ".glb");
  write_built_in_scene("office", 0, file);
  Site site = Site::open(file);
  std::filesystem::remove(file);
  const OnSite on_site = site.on_site();
  const std::vector<PlacedStation> stations = candidate_positions(site, 80);

  // The rooms, each with one door to the corridor; 0.6 to 1.5 m from its western wall.
  struct Room {
    double x0, x1;
    bool south;
    bool holds(const Vec3& p) const {
      return p.x > x0 && p.x < x1 && (south ? p.y > 0.3 && p.y < 6.4 : p.y > 8.6 && p.y < 14.7);
    }
    Vec3 door() const { return {x0 + 1.05, south ? 6.54 : 8.46, 0}; }
  };
  const Room rooms[] = {{0.3, 5.94, true},  {6.06, 11.94, true},  {12.06, 17.94, true},  {18.06, 23.7, true},
                        {0.3, 4.94, false}, {5.06, 14.94, false}, {15.06, 19.94, false}, {20.06, 23.7, false}};
  const auto metres = [](const Vec3& a, const Vec3& b) { return std::sqrt(dot(b - a, b - a)); };
  std::size_t pairs = 0;
  for (const PlacedStation& a : stations)
    for (const PlacedStation& b : stations) {
      const auto way = on_site.way_m(a.ground, b.ground);
      ASSERT_TRUE(way) << a.ground.x << ',' << a.ground.y << " to " << b.ground.x << ',' << b.ground.y;
      const auto from = std::ranges::find_if(rooms, [&](const Room& room) { return room.holds(a.ground); });
      const auto to = std::ranges::find_if(rooms, [&](const Room& room) { return room.holds(b.ground); });
      if (from == to || from == std::end(rooms) || to == std::end(rooms)) continue;
      const double through =
          metres(a.ground, from->door()) + metres(from->door(), to->door()) + metres(to->door(), b.ground);
      ++pairs;
      const std::vector<Vec3> path = on_site.way(a.ground, b.ground);
      ASSERT_GE(path.size(), 3u) << "through two doors";
      EXPECT_EQ(path.front(), a.ground);
      EXPECT_EQ(path.back(), b.ground);
      double along = 0;
      for (std::size_t k = 0; k + 1 < path.size(); ++k) along += metres(path[k], path[k + 1]);
      EXPECT_LE(along, *way + 0.5);
      EXPECT_GT(along, through - 1.0) << "through a wall";
      EXPECT_GT(*way, through - 1.0) << "through a wall";
      EXPECT_LT(*way, 1.1 * through + 3.0) << "not through the doors, or round more than the furniture";
    }
  EXPECT_GT(pairs, 1000u);

  const Visit visit = on_site.visit(stations);
  EXPECT_EQ(visit.unconnected, 0u);
  EXPECT_EQ(visit.order.size(), stations.size());
  for (const auto& path : visit.paths)
    for (std::size_t k = 0; k + 1 < path.size(); ++k)
      for (const double height : {0.4, 1.0})
        EXPECT_TRUE(site.clash().sees(path[k] + Vec3{0, 0, height}, path[k + 1] + Vec3{0, 0, height}))
            << path[k].x << ',' << path[k].y << " to " << path[k + 1].x << ',' << path[k + 1].y;
}

TEST(OnSite, GoesNearlyTheShortestRound) {
  const OnSite on_site = Yard().on_site();
  std::mt19937 random(5);
  const auto number = [&] { return 40 * static_cast<double>(random()) / 4294967296.0; };
  for (int trial = 0; trial < 5; ++trial) {
    std::vector<Vec3> grounds(7);
    for (Vec3& ground : grounds) ground = {number(), number(), 0};
    const auto length = [&](const std::vector<std::size_t>& order) {
      double sum = 0;
      for (std::size_t k = 0; k < order.size(); ++k)
        sum += on_site.way_m(grounds[order[k]], grounds[order[(k + 1) % order.size()]]).value();
      return sum;
    };
    std::vector<std::size_t> order(grounds.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    double shortest = length(order);
    while (std::next_permutation(order.begin() + 1, order.end())) shortest = std::min(shortest, length(order));
    const Visit visit = on_site.visit(stations_at(grounds));
    EXPECT_NEAR(visit.walk_m, length(visit.order), 1e-6);
    EXPECT_LE(visit.walk_m, 1.05 * shortest);
  }
}

// Lengths of rounds from an entrance, and back to it, over some places.
class Rounds {
 public:
  Rounds(const OnSite& on_site, std::vector<Vec3> stops, const Vec3& entrance) {
    stops.push_back(entrance);
    for (const Vec3& a : stops) {
      metres_.emplace_back();
      for (const Vec3& b : stops) metres_.back().push_back(on_site.way_m(a, b).value());
    }
  }
  double length(const std::vector<std::size_t>& order) const {
    double sum = metres_.back()[order.front()] + metres_.back()[order.back()];
    for (std::size_t k = 0; k + 1 < order.size(); ++k) sum += metres_[order[k]][order[k + 1]];
    return sum;
  }
  // Calls found(order) for every order.
  template <class Found>
  void for_each(Found&& found) const {
    std::vector<std::size_t> order(metres_.size() - 1);
    std::iota(order.begin(), order.end(), std::size_t{0});
    do found(order);
    while (std::next_permutation(order.begin(), order.end()));
  }
  double least() const {
    double least = std::numeric_limits<double>::infinity();
    for_each([&](const auto& order) { least = std::min(least, length(order)); });
    return least;
  }

 private:
  std::vector<std::vector<double>> metres_;
};

// Two rows of stations, each linked along itself and to the other at the far end: the shortest round steps across
// between them again and again.
TEST(OnSite, ConsecutiveStationsAreLinkedWhereLinksAllowIt) {
  const Vec3 entrance{1, 20, 0};
  const OnSite on_site = Yard().on_site({.entrance = entrance});
  std::vector<Vec3> grounds;
  for (const double y : {18.0, 22.0})
    for (const double x : {4.0, 12.0, 20.0, 28.0}) grounds.push_back({x, y, 0});
  const auto stations = stations_at(grounds);
  const auto linked = [](std::size_t a, std::size_t b) {
    const std::size_t low = std::min(a, b), high = std::max(a, b);
    return high == low + 1 ? (high == 4 ? 0 : 0.5) : low == 3 && high == 7 ? 0.5 : 0.0;
  };
  const Visit visit = on_site.visit(stations, linked);
  ASSERT_EQ(visit.order.size(), stations.size());
  for (std::size_t k = 0; k + 1 < visit.order.size(); ++k)
    EXPECT_GT(linked(visit.order[k], visit.order[k + 1]), 0) << visit.order[k] << " to " << visit.order[k + 1];
  EXPECT_EQ(visit.unlinked, 0u);
  EXPECT_LE(visit.walk_m, 1.3 * Rounds(on_site, grounds, entrance).least());
  EXPECT_LE(visit.legs_m.front(), visit.legs_m.back()) << "from the end that is nearer to the entrance";
}

TEST(OnSite, LinksTakeNoRoundThatIsMuchLonger) {
  const Vec3 entrance{0.5, 0.5, 0};
  const OnSite on_site = Yard().on_site({.entrance = entrance});
  std::mt19937 random(11);
  const auto number = [&] { return 1 + 38 * static_cast<double>(random()) / 4294967296.0; };
  int all_linked = 0;
  for (int trial = 0; trial < 12; ++trial) {
    std::vector<Vec3> grounds(7);
    for (Vec3& ground : grounds) ground = {number(), number(), 0};
    std::vector<std::vector<double>> strength(7, std::vector<double>(7, 0));
    for (std::size_t a = 0; a < 7; ++a)
      for (std::size_t b = a + 1; b < 7; ++b)
        strength[a][b] = strength[b][a] =
            std::hypot(grounds[a].x - grounds[b].x, grounds[a].y - grounds[b].y) < 17 ? 0.4 : 0;
    const LinkStrength link = [&](std::size_t a, std::size_t b) { return strength[a][b]; };
    const Rounds rounds(on_site, grounds, entrance);
    const double least = rounds.least();
    const Visit plain = on_site.visit(stations_at(grounds)), along = on_site.visit(stations_at(grounds), link);
    EXPECT_LE(along.walk_m, 1.3 * least) << trial;
    const auto unlinked = [&](const std::vector<std::size_t>& order) {
      std::size_t count = 0;
      for (std::size_t k = 0; k + 1 < order.size(); ++k) count += strength[order[k]][order[k + 1]] == 0;
      return count;
    };
    EXPECT_EQ(along.unlinked, unlinked(along.order));
    EXPECT_LE(unlinked(along.order), unlinked(plain.order)) << trial;
    // Fewest steps without a link of any walk that is no longer than 1.3 times the shortest.
    std::size_t fewest = 7;
    rounds.for_each([&](const auto& order) {
      if (rounds.length(order) <= 1.3 * least) fewest = std::min(fewest, unlinked(order));
    });
    EXPECT_EQ(along.unlinked, fewest) << trial;
    all_linked += fewest == 0;
    const double limit = plain.minutes + 1e-6;
    EXPECT_LE(on_site.visit(stations_at(grounds), link, limit).minutes, limit) << "a limit on time comes before links";
  }
  EXPECT_GT(all_linked, 0);
}

// A corridor with its entrance at one end: in to the far end and straight back out.
TEST(OnSite, ATunnelIsWalkedOnceInAndOnceOut) {
  const Vec3 entrance{0.5, 20, 0};
  const OnSite on_site = Yard().on_site({.entrance = entrance});
  std::vector<Vec3> grounds;
  for (const int k : {5, 2, 7, 0, 3, 6, 1, 4}) grounds.push_back({2 + 4.5 * k, 20 + 0.3 * (k % 2), 0});
  const auto linked = [&](std::size_t a, std::size_t b) {
    return std::max(0.0, 1 - std::abs(grounds[a].x - grounds[b].x) / 14);
  };
  const Visit visit = on_site.visit(stations_at(grounds), linked);
  for (std::size_t k = 0; k + 1 < visit.order.size(); ++k)
    EXPECT_NEAR(grounds[visit.order[k + 1]].x - grounds[visit.order[k]].x, 4.5, 1e-9) << k;
  EXPECT_LE(visit.walk_m, 1.05 * 2 * (2 + 4.5 * 7 - 0.5));
}

// Eight stations along a corridor, each linked to the next, the entrance at its end; a minute of scanning and two of
// setting up at each.
class Corridor {
 public:
  static constexpr Vec3 kEntrance{0.5, 20, 0};
  Corridor() {
    std::vector<Vec3> grounds;
    for (const int k : {5, 2, 7, 0, 3, 6, 1, 4}) place.push_back(k), grounds.push_back({2 + 4.5 * k, 20, 0});
    stations = stations_at(grounds);
  }
  LinkStrength chain() const {
    return [this](std::size_t a, std::size_t b) { return std::abs(place[a] - place[b]) == 1 ? 0.5 : 0.0; };
  }
  Visit visit(double day_min, std::size_t crews, const LinkStrength& link, const LinkStrength& of_sessions) const {
    const OnSite on_site = Yard().on_site(
        {.set_up_min = 2, .walking_m_per_s = 0.5, .entrance = kEntrance, .day_min = day_min, .crews = crews});
    Visit visit = on_site.visit(stations, link);
    visit.sessions = on_site.sessions(stations, visit, of_sessions);
    return visit;
  }
  std::vector<int> place;  // along the corridor
  std::vector<PlacedStation> stations;
};

TEST(Sessions, ADayTakesAsManyStationsOfACorridorAsFit) {
  const Corridor corridor;
  // The last pair stands 31 m from the entrance, two minutes there and back with six for the pair.
  const Visit visit = corridor.visit(8.5, 2, corridor.chain(), corridor.chain());
  ASSERT_EQ(visit.sessions.size(), 4u);
  std::vector<std::size_t> all;
  for (std::size_t s = 0; s < visit.sessions.size(); ++s) {
    const Session& one = visit.sessions[s];
    EXPECT_EQ(one.day, s / 2 + 1);
    EXPECT_EQ(one.crew, s % 2 + 1);
    ASSERT_EQ(one.order.size(), 2u);
    all.insert(all.end(), one.order.begin(), one.order.end());
    const double far = corridor.stations[one.order.back()].ground.x - Corridor::kEntrance.x;
    EXPECT_NEAR(one.walk_m, 2 * far, 1);
    EXPECT_LE(one.minutes, 8.5);
    EXPECT_NEAR(one.minutes, 2 * 3 + one.walk_m / 0.5 / 60, 1e-9);
    EXPECT_EQ(one.paths.front().front(), Corridor::kEntrance);
    EXPECT_EQ(one.paths.back().back(), Corridor::kEntrance);
    ASSERT_EQ(one.arrive_min.size(), 2u);
    EXPECT_NEAR(one.arrive_min[1], one.arrive_min[0] + 3 + 4.5 / 0.5 / 60, 0.03);
    EXPECT_NEAR(one.minutes, one.arrive_min[1] + one.stay_min[1] + one.legs_m.back() / 0.5 / 60, 1e-9);
    EXPECT_EQ(one.parts, 1u);
    EXPECT_TRUE(one.linked);
    EXPECT_EQ(one.unlinked, 0u);
  }
  EXPECT_EQ(all, visit.order) << "parts of the visiting order";

  const Visit whole = corridor.visit(60, 3, corridor.chain(), corridor.chain());
  ASSERT_EQ(whole.sessions.size(), 1u);
  EXPECT_EQ(whole.sessions[0].order, whole.order);
  EXPECT_NEAR(whole.sessions[0].minutes, whole.minutes, 1e-9);
  EXPECT_TRUE(whole.sessions[0].linked);
}

// Two minutes of setting up and one of scanning at each, and 4.5 m, 9 s, from one to the next: 3 min, then 3.15 min
// each.
TEST(Batteries, AreChangedBetweenStationsBeforeTheyAreEmpty) {
  const Corridor corridor;
  const auto used = [&](double battery_min, double battery_scans, OnSiteOptions options) {
    Yard yard;
    yard.scanner.name = "Mine @fine", yard.scanner.battery_min = battery_min,
    yard.scanner.battery_scans = battery_scans;
    options.set_up_min = 2, options.walking_m_per_s = 0.5, options.entrance = Corridor::kEntrance;
    const OnSite on_site = yard.on_site(options);
    Visit visit = on_site.visit(corridor.stations, corridor.chain());
    visit.sessions = on_site.sessions(corridor.stations, visit, corridor.chain());
    return visit;
  };
  const auto batteries = [&](double battery_min, double battery_scans) {
    const std::vector<BatteryUse> uses = used(battery_min, battery_scans, {}).batteries;
    EXPECT_EQ(uses.size(), 1u);
    return uses.empty() ? BatteryUse{} : uses.front();
  };
  EXPECT_TRUE(used(0, 0, {}).batteries.empty()) << "nothing is known";
  const BatteryUse one = batteries(60, 0);
  EXPECT_EQ(one.instrument, "Mine");
  EXPECT_EQ(one.batteries, 1u);
  EXPECT_EQ(one.scans, 8u);
  EXPECT_NEAR(one.on_min, 8 * 3 + 7 * 4.5 / 0.5 / 60, 0.1) << "from the first to the last, not from the entrance";
  EXPECT_EQ(batteries(0, 3).batteries, 3u);
  EXPECT_EQ(batteries(0, 4).batteries, 2u);
  EXPECT_EQ(batteries(10, 0).batteries, 3u) << "three stations take 9.3 min";
  EXPECT_EQ(batteries(9, 0).batteries, 4u) << "two stations each, although three times 9 are more than all 25 min";
  EXPECT_EQ(batteries(10, 2).batteries, 4u) << "whichever ends first";
  EXPECT_EQ(batteries(2, 0).batteries, 16u) << "two within each stay";

  const Visit split = used(4, 0, {.day_min = 8.5, .crews = 2});
  ASSERT_EQ(split.sessions.size(), 4u) << "two stations each";
  for (const Session& session : split.sessions) {
    ASSERT_EQ(session.batteries.size(), 1u);
    EXPECT_EQ(session.batteries[0].batteries, 2u);
  }
  const std::vector<BatteryUse> all = batteries_of(split);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].batteries, 8u);
  EXPECT_EQ(all[0].in_a_day, 4u) << "two crews";
  EXPECT_EQ(all[0].scans, 8u);
}

TEST(Batteries, SettingsOfOneScannerShareThemAndOthersDoNot) {
  const Corridor corridor;
  std::vector<Scanner> scanners(3, Yard().scanner);
  scanners[0].name = "Mine @fine", scanners[1].name = "Mine @fast", scanners[2].name = "Yours";
  scanners[0].battery_scans = scanners[1].battery_scans = 2, scanners[2].battery_min = 5;
  std::vector<PlacedStation> stations = corridor.stations;
  const auto scanner_at = [&](int place) -> std::uint32_t& {
    const auto k = std::ranges::find(corridor.place, place) - corridor.place.begin();
    return stations[static_cast<std::size_t>(k)].setup.scanner;
  };
  scanner_at(1) = 1, scanner_at(3) = 2, scanner_at(4) = 0, scanner_at(5) = 2;
  const OnSite on_site =
      Yard().site(scanners).on_site({.set_up_min = 2, .walking_m_per_s = 0.5, .entrance = Corridor::kEntrance});
  const std::vector<BatteryUse> uses = on_site.visit(stations, corridor.chain()).batteries;
  ASSERT_EQ(uses.size(), 2u);
  EXPECT_EQ(uses[0].instrument, "Mine");
  EXPECT_EQ(uses[0].scans, 6u);
  EXPECT_EQ(uses[0].batteries, 3u);
  EXPECT_EQ(uses[1].instrument, "Yours");
  EXPECT_EQ(uses[1].scans, 2u);
  EXPECT_NEAR(uses[1].on_min, 3 * 3 + 2 * 4.5 / 0.5 / 60, 0.1) << "carried while the other one scans";
  EXPECT_EQ(uses[1].batteries, 2u);
}

TEST(Sessions, AreCutWhereLinksAllowItAndTellWhereTheyDoNot) {
  const Corridor corridor;
  // Five would fit a day, but the corridor falls apart after the third station.
  const auto broken = [&](std::size_t a, std::size_t b) {
    const int low = std::min(corridor.place[a], corridor.place[b]);
    return low == 2 ? 0 : corridor.chain()(a, b);
  };
  const Visit visit = corridor.visit(17.5, 1, corridor.chain(), broken);
  ASSERT_EQ(visit.sessions.size(), 2u);
  EXPECT_EQ(visit.sessions[0].order.size(), 3u);
  for (const Session& one : visit.sessions) {
    EXPECT_EQ(one.parts, 1u);
    EXPECT_FALSE(one.linked) << "no scan of it is linked to the other session";
  }
  const Visit apart = corridor.visit(17.5, 1, corridor.chain(), [](std::size_t, std::size_t) { return 0.0; });
  ASSERT_EQ(apart.sessions.size(), 2u);
  EXPECT_EQ(apart.sessions[0].parts + apart.sessions[1].parts, 8u);
  EXPECT_EQ(apart.sessions[0].unlinked + apart.sessions[1].unlinked, 6u);
}

TEST(Sessions, ADayThatIsTooShortIsOneError) {
  const Corridor corridor;
  const auto refusal = [&](double day_min) -> std::string {
    try {
      corridor.visit(day_min, 1, {}, {});
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Errc::invalid_argument);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(2.9),
            "day: 2.90 min are too short for one station, which takes 3.00 min with setting up. Give a longer day");
  // The farthest one: 33 m, 2.2 minutes there and back.
  const std::string far = refusal(5);
  EXPECT_TRUE(far.starts_with("day: station 3 takes 5.2")) << far;
  EXPECT_TRUE(
      far.ends_with(" min from the entrance and back, 3.00 of them at the station; a day has 5.00. Give a longer day"))
      << far;
  EXPECT_EQ(refusal(5.5), "");
  // A plan that was made before is not lost by it.
  Evaluation made{.stations = corridor.stations, .values = {{"coverage", {0.5, 0}}}};
  const OnSite short_days =
      Yard().on_site({.set_up_min = 2, .walking_m_per_s = 0.5, .entrance = Corridor::kEntrance, .day_min = 5});
  made.visit = short_days.visit(made.stations);
  add_sessions(made, short_days);
  EXPECT_EQ(made.visit->not_split, far);
  EXPECT_TRUE(made.visit->sessions.empty());
  EXPECT_EQ(std::ranges::count(summary_lines(made), "not split into days: " + far, &SummaryLine::text), 1);
  EXPECT_THROW(Yard().on_site({.crews = 2}), Error) << "crews share days";
  EXPECT_THROW(Yard().on_site({.day_min = 60, .crews = 0}), Error);
  EXPECT_THROW(Yard().on_site({.day_min = 0}), Error);
}

TEST(Sessions, BeginAtTheFirstStationWhereNoEntranceIsKnown) {
  const Corridor corridor;
  const OnSite on_site = Yard().on_site({.set_up_min = 2, .day_min = 14});
  const Visit visit = on_site.visit(corridor.stations);
  const std::vector<Session> sessions = on_site.sessions(corridor.stations, visit);
  ASSERT_GE(sessions.size(), 2u);
  EXPECT_EQ(sessions[0].legs_m.front(), 0);
  EXPECT_TRUE(sessions[0].paths.front().empty());
  EXPECT_EQ(sessions[1].paths.front().front(), corridor.stations[visit.order[0]].ground);
  EXPECT_TRUE(on_site.sessions({}, {}).empty());
}

// The corridor's stations 0 to 3 are in a hall, the others in an archive, 4.5 m apart.
class Halls : public Corridor {
 public:
  Site site() const {
    SceneData data = yard_.scene.data();
    data.rooms = {{.name = "Hall 1", .storey = {}, .box = {{0, 15, 0}, {10, 25, 3}}},
                  {.name = "Hall 2", .storey = {}, .box = {{10, 15, 0}, {17, 25, 3}}},
                  {.name = "Archive", .storey = {}, .box = {{17, 15, 0}, {40, 25, 3}}}};
    return test::site_of(Simulator(Scene(std::make_shared<const SceneData>(std::move(data))), yard_.scanner,
                                   {.engine = Engine::embree, .user_size_m = 1, .point_spacing_m = 0.5}),
                         SearchArea::from_mesh(yard_.ground));
  }
  static OnSiteOptions options(double day_min, double start_min, const std::vector<std::string>& windows) {
    OnSiteOptions options{
        .set_up_min = 2, .walking_m_per_s = 0.5, .entrance = kEntrance, .day_min = day_min, .day_start_min = start_min};
    for (const std::string& window : windows) options.windows.push_back(parse_access_window(window));
    return options;
  }
  Evaluation planned(const OnSiteOptions& options) const {
    Site own = site();
    const OnSite on_site = own.on_site(options);
    Evaluation made{.stations = stations, .values = {{"coverage", {0.5, 0}}}};
    made.visit = on_site.visit(made.stations);
    add_sessions(made, on_site);
    return made;
  }
  bool in_hall(std::size_t station) const { return place[station] <= 3; }

 private:
  Yard yard_;
};

TEST(AccessWindows, SessionsScanRoomsWithinTheirHours) {
  const Halls halls;
  // Four stations of three minutes in the halls, whose hour has room for all; four others after or before it.
  const Evaluation made = halls.planned(Halls::options(60, 7 * 60, {"Hall*=07:20-07:40"}));
  ASSERT_EQ(made.visit->sessions.size(), 1u);
  EXPECT_TRUE(made.visit->closed.empty());
  EXPECT_EQ(made.visit->bound, 4u);
  EXPECT_EQ(closed_stations(made), 0u);
  const Session& one = made.visit->sessions[0];
  std::vector<std::size_t> all = one.order;
  std::ranges::sort(all);
  EXPECT_EQ(all.size(), 8u);
  EXPECT_EQ(std::ranges::adjacent_find(all), all.end());
  double now = one.start_min, waited = 0;
  for (std::size_t k = 0; k < one.order.size(); ++k) {
    const double begin = one.start_min + one.arrive_min[k];
    now += one.legs_m[k] / 0.5 / 60 + one.wait_min[k];
    EXPECT_NEAR(begin, now, 1e-6);
    now += one.stay_min[k], waited += one.wait_min[k];
    if (!halls.in_hall(one.order[k])) continue;
    EXPECT_GE(begin, 7 * 60 + 20 - 1e-6);
    EXPECT_LE(begin + one.stay_min[k], 7 * 60 + 40 + 1e-6);
  }
  EXPECT_NEAR(one.waiting_min, waited, 1e-9);
  EXPECT_NEAR(one.minutes, now + one.legs_m.back() / 0.5 / 60 - one.start_min, 1e-6);
  EXPECT_GE(one.start_min, 7 * 60);
  EXPECT_LE(one.start_min + one.minutes, 8 * 60);
  EXPECT_EQ(std::ranges::count(summary_lines(made), "hours", &SummaryLine::heading), 1);

  // Seven minutes a day have room for two of them: two mornings, which others fill.
  const Evaluation twice = halls.planned(Halls::options(60, 7 * 60, {"Hall*=07:20-07:27"}));
  ASSERT_EQ(twice.visit->sessions.size(), 2u);
  for (const Session& session : twice.visit->sessions)
    EXPECT_EQ(std::ranges::count_if(session.order, [&](std::size_t k) { return halls.in_hall(k); }), 2);
  EXPECT_EQ(twice.visit->sessions[1].day, 2u);

  // Without windows only the reported time changes.
  const Evaluation plain = halls.planned(Halls::options(60, 7 * 60, {}));
  ASSERT_EQ(plain.visit->sessions.size(), 1u);
  EXPECT_EQ(plain.visit->sessions[0].order, plain.visit->order);
  EXPECT_EQ(plain.visit->sessions[0].start_min, 7 * 60);
  EXPECT_EQ(plain.visit->sessions[0].waiting_min, 0);
}

TEST(AccessWindows, HoursThatNoSessionKeepsAreTold) {
  const Halls halls;
  const Evaluation late = halls.planned(Halls::options(60, 8 * 60, {"Hall 1=06:00-08:03", "Archive=08:00-24:00"}));
  ASSERT_EQ(late.visit->closed.size(), 2u) << "three minutes with the walk from the entrance are too many";
  EXPECT_EQ(late.visit->bound, 6u);
  EXPECT_EQ(closed_stations(late), 2u);
  std::size_t visited = 0;
  for (const Session& session : late.visit->sessions) {
    visited += session.order.size();
    for (const ClosedStation& closed : late.visit->closed)
      EXPECT_EQ(std::ranges::count(session.order, closed.station), 0);
  }
  EXPECT_EQ(visited, 6u);
  for (const ClosedStation& closed : late.visit->closed) {
    EXPECT_LE(halls.place[closed.station], 1);
    EXPECT_TRUE(closed.why.starts_with("takes 3.0 min within Hall 1=06:00-08:03, and a day from 08:00 to 09:00 with "))
        << closed.why;
  }
  std::vector<std::string> told;
  for (const SummaryLine& line : summary_lines(late))
    if (line.heading == "hours" || line.text.find("is in no session") != std::string::npos) told.push_back(line.text);
  ASSERT_EQ(told.size(), 3u);
  EXPECT_EQ(told[0], "not kept at 2 of 6 stations that access windows are for, which no session scans");

  const auto refusal = [&](const OnSiteOptions& options) -> std::string {
    try {
      halls.site().on_site(options);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(Halls::options(60, 0, {"hall*=06:00-08:00"})),
            "window: no room is named like 'hall*'; did you mean Hall 1?");
  OnSiteOptions no_day = Halls::options(60, 0, {"Hall*=06:00-08:00"});
  no_day.day_min.reset();
  EXPECT_EQ(refusal(no_day), "window: hours are kept by the sessions of a day; give its length too");
  EXPECT_THROW(Yard().on_site(Halls::options(60, 0, {"Hall*=06:00-08:00"})), Error) << "no rooms are known";
  for (const char* text : {"", "Hall", "Hall=", "=06:00-08:00", "Hall=06:00", "Hall=6-8", "Hall=06:00-24:01",
                           "Hall=06:00-06:00", "Hall=06:60-08:00", "Hall=-06:00-08:00"})
    EXPECT_THROW(parse_access_window(text), Error) << text;
  EXPECT_EQ(to_string(parse_access_window("a=b|c*=22:00-2:30")), "a=b|c*=22:00-02:30");
}

// A gallery over a hall, with a ramp up to it at the far end: metres.
struct Gallery {
  Site site = [] {
    test::QuadScene scene;
    scene.quad({0, 0, 0}, {40, 0, 0}, {0, 8, 0});
    scene.quad({0, 0, 3}, {20, 0, 0}, {0, 4, 0});
    scene.quad({20, 0, 3}, {12, 0, -3}, {0, 4, 0});
    return test::site_of(Simulator(scene.scene(), test::coarse_scanner(2),
                                   {.engine = Engine::embree, .user_size_m = 0.4, .point_spacing_m = 0.1}));
  }();
  OnSite on_site = site.on_site();
  // In the hall and over it at the near end, then at the foot and at the head of the ramp.
  Evaluation network = [] {
    Evaluation made{.scan_overlap_matrix = ScanOverlapMatrix(4)};
    for (const Vec3& ground : {Vec3{2, 2, 0}, Vec3{2, 2, 3}, Vec3{35, 2, 0}, Vec3{18, 2, 3}})
      made.stations.push_back({.position = ground + Vec3{0, 0, 1.8}, .ground = ground});
    made.scan_overlap_matrix.set(0, 1, 0.9), made.scan_overlap_matrix.set(0, 2, 0.5);
    made.scan_overlap_matrix.set(1, 3, 0.4);
    return made;
  }();
};

TEST(StoreyTies, AreLinksThatNobodyWalksAlong) {
  Gallery gallery;
  const std::vector<StoreyTie> ties = storey_ties_of(gallery.network, gallery.on_site);
  ASSERT_EQ(ties.size(), 1u);
  EXPECT_EQ(ties[0].a, 0u);
  EXPECT_EQ(ties[0].b, 1u);
  EXPECT_EQ(ties[0].value, 0.9);
  EXPECT_DOUBLE_EQ(ties[0].apart_m, 3);
  // To the ramp and back on it: nobody steps onto it from aside where it is 1.5 m high, at x = 26.
  EXPECT_GT(ties[0].way_m, 2 * (26 - 2));
  EXPECT_LT(ties[0].way_m, 2 * (32 + 2 - 2));
  gallery.network.storey_ties = ties;
  gallery.network.values["coverage"] = {1, 0};
  EXPECT_NE(summary_text(gallery.network)
                .find("storeys are tied past the stair, through a window or across a void, by S1–S2 (3.0 m apart, "),
            std::string::npos)
      << summary_text(gallery.network);
}

// The treads of the house's stair are too small for a station, and people walk on them.
TEST(OnSite, AStairJoinsStoreys) {
  const test::TemporaryFolder folder;
  write_built_in_scene("house", 0, folder / "house.glb");
  Site house = Site::open(folder / "house.glb");
  const OnSite on_site = house.on_site();
  // From the hall to the landing: 1.0 m to the foot of the stair, 5.3 m on it, and 1.7 m from its head.
  const auto up = on_site.way_m({5.4, 2, 0.15}, {5.4, 5, 3.21});
  ASSERT_TRUE(up);
  EXPECT_GT(*up, std::hypot(16 * 0.27, 17 * 0.18) + 2);
  EXPECT_LT(*up, 1.15 * (std::hypot(16 * 0.27, 17 * 0.18) + 1.0 + 1.7));
  // From the garden round to the front door, in, and up.
  const auto round = on_site.way_m({-4.4, 2.7, 0}, {0.9, 5.7, 3.21});
  ASSERT_TRUE(round);
  EXPECT_GT(*round, 25);
}

TEST(StoreyTies, GiveWayToALinkOnTheStair) {
  Gallery gallery;
  gallery.network.scan_overlap_matrix.set(2, 3, 0.3);
  EXPECT_TRUE(storey_ties_of(gallery.network, gallery.on_site).empty()) << "though it is weaker";
  gallery.network.stations[3].status = StationStatus::clash;
  EXPECT_EQ(storey_ties_of(gallery.network, gallery.on_site).size(), 1u) << "one that is left out ties nothing";
  EXPECT_TRUE(storey_ties_of({.stations = gallery.network.stations}, gallery.on_site).empty()) << "nothing is known";
}

TEST(StoreyTies, WaysAreLongerThanALengthWhereTheyAreLonger) {
  const Gallery gallery;
  std::vector<Vec3> points;
  for (const PlacedStation& station : gallery.network.stations) points.push_back(station.ground);
  points.push_back({60, 60, 0});  // off the ground
  std::vector<OnSite::Way> than;
  std::vector<std::uint8_t> expected;
  for (std::size_t a = 0; a < points.size(); ++a)
    for (std::size_t b = 0; b < points.size(); ++b)
      for (const double off : {-0.01, 0.01}) {
        const auto way = gallery.on_site.way_m(points[a], points[b]);
        than.push_back({a, b, way.value_or(50) + off});
        expected.push_back(way && off < 0);
      }
  EXPECT_EQ(gallery.on_site.longer(points, than), expected);
  EXPECT_TRUE(gallery.on_site.longer({}, {}).empty());
  EXPECT_THROW(gallery.on_site.longer({{Vec3{1e9, 0, 0}}}, {}), Error);
}

// Links that nobody walks along are the ones reported if each is the only one between the storeys.
TEST(StoreyTies, ArePastStairs) {
  const Gallery gallery;
  const std::vector<PlacedStation>& stations = gallery.network.stations;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < stations.size(); ++a)
    for (std::size_t b = a + 1; b < stations.size(); ++b) pairs.emplace_back(a, b);
  const std::vector<std::uint8_t> past = past_stairs(stations, pairs, gallery.on_site);
  ASSERT_EQ(past.size(), pairs.size());
  std::size_t told = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    Evaluation two{.stations = {stations[pairs[k].first], stations[pairs[k].second]}};
    two.scan_overlap_matrix = ScanOverlapMatrix(2);
    two.scan_overlap_matrix.set(0, 1, 0.9);
    EXPECT_EQ(past[k] != 0, !storey_ties_of(two, gallery.on_site).empty()) << pairs[k].first << pairs[k].second;
    told += past[k];
  }
  EXPECT_EQ(told, 2u) << "both from below the gallery, and not those from the foot of the ramp";
}

}  // namespace
}  // namespace vantage
