// SPDX-License-Identifier: Apache-2.0
#include "plan/fewest_choice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <map>
#include <random>

#include "core/graph.hpp"
#include "unit/plan/floor_survey.hpp"

namespace vantage {
namespace {

using test::floor_candidates;
using test::floor_choice;
using test::floor_columns;
using test::floor_problem;

// A choice among the lattice's candidates.
FewestChoice chosen(const SurveyProblem& problem, int side, std::size_t step = 1) {
  FewestChoice choice = floor_choice(problem, step);
  const auto candidates = floor_candidates(side);
  look(choice.table, {}, candidates, floor_columns(step)(candidates, {}), {}, {});
  choose(choice, {}, {});
  return choice;
}

TEST(FewestAsked, TakesTheStrictestLimits) {
  SurveyProblem problem = fewest_stations(0.8, 0.25, 2, 9, 1.5);
  problem.attainable = 0.5;
  for (Requirement& requirement : problem.requirements)
    if (requirement.objective.name == "capture") requirement.objective = make_objective("capture", problem.settings());
  problem.existing = {{1, 1, 4.5}};
  FewestAsked asked = fewest_asked(problem);
  EXPECT_EQ(asked.existing, 1u);
  EXPECT_EQ(asked.fewest, 2u);
  EXPECT_EQ(asked.most, 9u);
  EXPECT_TRUE(asked.captured);
  EXPECT_DOUBLE_EQ(asked.coverage, 0.8) << "of what is attainable";
  EXPECT_EQ(asked.link, 0.25);
  EXPECT_EQ(asked.apart_m, 1.5);
  EXPECT_FALSE(asked.minutes);
  problem.requirements.push_back({.objective = make_objective("coverage", problem.settings()), .limit = 0.45});
  problem.requirements.push_back(
      {.objective = make_objective("time", problem.settings()), .bound = Requirement::Bound::at_most, .limit = 90});
  asked = fewest_asked(problem);
  EXPECT_EQ(asked.coverage, 0.9) << "a coverage of 0.45, of 0.5 that are attainable";
  EXPECT_EQ(asked.minutes, 90);
  std::erase_if(problem.requirements, [](const Requirement& r) { return r.objective.name == "capture"; });
  asked = fewest_asked(problem);
  EXPECT_FALSE(asked.captured);
  EXPECT_EQ(asked.coverage, 0.45);
}

TEST(Look, TakesExistingStationsFirstAndSomeCandidatesWhereTimeIsOver) {
  const auto candidates = floor_candidates(16);
  ASSERT_GT(candidates.size(), 150u);
  const CoverageMatrix known = floor_columns()(candidates, {});
  const PlacedStation existing = candidates.back();
  const auto looked_at = [&](std::stop_token stop, std::stop_token abort) {
    FewestChoice choice = floor_choice(floor_problem(0.5));
    look(choice.table, {&existing, 1}, candidates, known, {.stop = std::move(stop)}, abort);
    return choice.table;
  };
  std::stop_source stop, abort;
  const CandidateTable all = looked_at({}, {});
  EXPECT_EQ(all.stations().size(), candidates.size() + 1);
  EXPECT_EQ(all.stations().front().position, existing.position);
  EXPECT_GT(all.graph().overlap(1, 2), 0);
  stop.request_stop();
  EXPECT_GE(looked_at(stop.get_token(), {}).stations().size(), 97u) << "as many as two seconds allow, but some";
  abort.request_stop();
  EXPECT_EQ(looked_at(stop.get_token(), abort.get_token()).stations().size(), 0u);
}

TEST(StandAside, SwapsAStationThatIsInTheWay) {
  FewestChoice choice = chosen(floor_problem(0.7), 16);
  const FewestChoice before = choice;
  ASSERT_EQ(choice.network.violation, 0);
  PlacementOracle oracle = test::toy_site();
  EXPECT_FALSE(stand_aside(choice, oracle, {})) << "nothing tells where none should stand";
  const Vec3 door = choice.stations_of(choice.network)[1].ground;
  double near_m = 0.7;
  oracle.better_aside = [&](const Vec3& ground) { return test::apart_m(ground, door) < near_m; };
  EXPECT_TRUE(stand_aside(choice, oracle, {}));
  EXPECT_EQ(choice.network.violation, 0);
  EXPECT_EQ(choice.network.chosen.size(), before.network.chosen.size());
  std::size_t same = 0;
  for (const std::size_t k : choice.network.chosen) {
    EXPECT_GE(test::apart_m(choice.table.stations()[k].ground, door), near_m);
    same += static_cast<std::size_t>(std::ranges::count(before.network.chosen, k));
  }
  EXPECT_EQ(same, before.network.chosen.size() - 1) << "the others stay";
  near_m = 3.5;  // farther than it looks
  choice = before;
  EXPECT_FALSE(stand_aside(choice, oracle, {}));
  EXPECT_EQ(choice.network.chosen, before.network.chosen);
}

// A share that samples overestimate or underestimate. The bound lies above it in as many samples as the normal
// distribution gives for so many standard errors.
TEST(LeastShare, IsRarelyAboveTheTruth) {
  std::mt19937 rng(3);
  for (const int size : {20, 100, 1000}) {
    int above = 0;
    constexpr int kSamples = 20'000;
    std::binomial_distribution<int> drawn(size, 0.3);
    for (int k = 0; k < kSamples; ++k) above += least_share(static_cast<double>(drawn(rng)) / size, size, 2) > 0.3;
    EXPECT_LT(above, 0.035 * kSamples) << size;
    EXPECT_GT(above, 0.008 * kSamples) << size;
  }
  EXPECT_EQ(least_share(0, 10, 2), 0);
  EXPECT_DOUBLE_EQ(least_share(0.4, 10, 0), 0.4) << "all was counted";
  EXPECT_NEAR(least_share(1, 12, 2), 0.75, 1e-12) << "few voxels prove little, even if all agree";
}

TEST(CandidateTable, TakesOverlapsForTheLeastThatTheirSampleAdmits) {
  const auto candidates = floor_candidates(6);
  CandidateTable plain(floor_columns(), floor_columns(7, 4), {}),
      careful(floor_columns(), floor_columns(7, 4), {}, 0.25);
  const std::size_t half = candidates.size() / 2;
  for (CandidateTable* table : {&plain, &careful}) {
    table->add(std::span(candidates).first(half), {});
    if (table == &careful) careful.take_least_overlaps(1);
    table->add(std::span(candidates).subspan(half), {});
  }
  ScanOverlapMatrix exact(3);
  exact.set(0, 1, 0.25), exact.set(0, 2, 0), exact.set(1, 2, 0.75);
  const std::vector<std::size_t> chosen{4, 2, 7};
  careful.take_in(chosen, exact);
  careful.take_least_overlaps(2);
  EXPECT_EQ(careful.graph().overlap(4, 2), 0.25F);
  EXPECT_EQ(careful.graph().overlap(4, 7), 0);
  EXPECT_EQ(careful.graph().overlap(7, 2), 0.75F);
  const CoverageMatrix seen = floor_columns(7, 4)(candidates, {});
  int linked = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (std::size_t j = 0; j < candidates.size(); ++j) {
      if (i == j || plain.graph().overlap(i, j) == 0) continue;
      if (std::ranges::count(chosen, i) + std::ranges::count(chosen, j) == 2) continue;
      ++linked;
      const auto share = static_cast<double>(plain.graph().overlap(i, j));
      const auto size = static_cast<double>(std::min(seen.column(i).size(), seen.column(j).size()));
      EXPECT_FLOAT_EQ(careful.graph().overlap(i, j), static_cast<float>(least_share(share, size, 1))) << i << ' ' << j;
      EXPECT_EQ(careful.graph().overlap(i, j), careful.graph().overlap(j, i));
    }
  EXPECT_GT(linked, 100);
}

TEST(Choose, KeepsWhatIsAskedAndNoStationFewerDoes) {
  const FewestChoice choice = chosen(floor_problem(0.7), 12);
  EXPECT_EQ(choice.network.violation, 0);
  EXPECT_GE(choice.network.coverage, 0.7);
  EXPECT_GE(choice.network.link, 0.1);
  ASSERT_TRUE(choice.one_fewer);
  EXPECT_EQ(choice.one_fewer->chosen.size() + 1, choice.placed());
  const auto stations = choice.placed_of(choice.network);
  for (std::size_t i = 0; i < stations.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(test::apart_m(stations[i].position, stations[j].position), 1);
}

// The requirement is on the cells in one corner, of which the fewest stations capture less.
TEST(CaptureMeshes, AddsTheStationsThatItTakesAndNoneMore) {
  FewestChoice choice = chosen(floor_problem(0.5), 12);
  const std::size_t before = choice.placed();
  constexpr std::size_t side = 40;
  const auto in_corner = [](std::size_t cell) { return cell % side < 16 && cell / side < 16; };
  const auto share = [&] {
    double some = 0, all = 0;
    for (std::size_t cell = 0; cell < side * side; ++cell) {
      if (!in_corner(cell)) continue;
      const double x = (static_cast<double>(cell % side) + 0.5) / 4, y = (static_cast<double>(cell / side) + 0.5) / 4;
      all += 1;
      some += std::ranges::any_of(choice.stations_of(choice.network), [&](const PlacedStation& station) {
        return std::hypot(x - station.position.x, y - station.position.y) < test::kReach_m;
      });
    }
    return some / all;
  };
  AskedOfMeshes asked{.measure = "capture(corner)", .share = 0.98};
  for (std::size_t cell = 0; cell < side * side; ++cell) asked.weight.push_back(in_corner(cell) ? 1 : 0);
  choice.of_meshes = {asked}, choice.attainable.assign(side * side, 1);
  const double lacking = share();
  ASSERT_LT(lacking, 0.98) << "or there is nothing to add";
  EXPECT_TRUE(capture_meshes(choice, {}));
  EXPECT_GE(share(), 0.98);
  EXPECT_EQ(choice.network.violation, 0) << "linked, and as much of all as before";
  EXPECT_LE(choice.placed(), before + 2);
  EXPECT_FALSE(capture_meshes(choice, {})) << "all is there";
  for (const std::size_t station : choice.visiting)
    EXPECT_NE(std::ranges::find(choice.network.chosen, station), choice.network.chosen.end());
  // No more stations than are allowed.
  FewestChoice few = chosen(floor_problem(0.5), 12);
  few.of_meshes = {asked}, few.attainable.assign(side * side, 1);
  few.asked.most = few.placed();
  capture_meshes(few, {});
  EXPECT_LE(few.placed(), few.asked.most);
}

TEST(Choose, TakesAsManyAsThereIsTimeFor) {
  const std::size_t without_limit = chosen(floor_problem(0.8), 12).placed();
  ASSERT_GT(without_limit, 3u);
  FewestChoice choice = floor_choice(floor_problem(0.8));
  choice.asked.minutes = 35;
  const auto candidates = floor_candidates(12);
  look(choice.table, {}, candidates, floor_columns()(candidates, {}), {}, {});
  // 10 minutes a station and 2 for the way to it.
  const VisitTime visit{.each_min = 10, .minutes = [](std::span<const PlacedStation> placed) {
                          return 12 * static_cast<double>(placed.size());
                        }};
  choose(choice, visit, {});
  EXPECT_EQ(choice.placed(), 2u);
  EXPECT_EQ(choice.asked.most, 2u);
  EXPECT_GT(choice.network.violation, 0);
}

TEST(RefineAround, AddsAllowedPositionsNearTheChosen) {
  FewestChoice choice = chosen(floor_problem(0.7), 7);
  const std::size_t before = choice.table.stations().size(), placed = choice.placed();
  std::vector<PlacedStation> from = choice.placed_of(choice.network);
  const auto fewer = choice.placed_of(*choice.one_fewer);
  from.insert(from.end(), fewer.begin(), fewer.end());
  refine_around(choice, test::toy_site(), 0.8, {});
  const auto& stations = choice.table.stations();
  EXPECT_GT(stations.size(), before);
  for (std::size_t k = before; k < stations.size(); ++k) {
    EXPECT_EQ(stations[k].status, StationStatus::ok);
    EXPECT_TRUE(std::ranges::any_of(from, [&](const PlacedStation& one) {
      return test::apart_m(one.position, stations[k].position) <= 0.8 + 1e-9;
    }));
    for (std::size_t other = before; other < k; ++other)
      EXPECT_GT(test::apart_m(stations[other].position, stations[k].position), 0) << "a position is tried once";
  }
  EXPECT_EQ(choice.network.violation, 0);
  EXPECT_LE(choice.placed(), placed);
}

TEST(Choose, TakesTheMostCoverageOfSoManyStations) {
  SurveyProblem problem = floor_problem(0);
  std::erase_if(problem.requirements, [](const Requirement& r) { return r.objective.name == "capture"; });
  problem.stations_min = problem.stations_max = 3;
  const FewestAsked asked = fewest_asked(problem);
  EXPECT_TRUE(asked.most_coverage);
  EXPECT_FALSE(asked.captured) << "coverage is searched for";
  FewestChoice choice = chosen(problem, 10);
  ASSERT_EQ(choice.placed(), 3u);
  EXPECT_GE(choice.network.link, 0.1) << "and linked";
  // No swap of one station among the linked, spaced networks of as many stations has more.
  const CoverProblem asked_of = cover_problem(choice);
  for (std::size_t at = 0; at < 3; ++at)
    for (std::size_t k = 0; k < choice.table.stations().size(); ++k) {
      std::vector<std::size_t> other = choice.network.chosen;
      other[at] = k;
      const CoverSolution swapped = evaluate_cover(asked_of, other);
      const auto near = [&](std::size_t i, std::size_t j) { return choice.table.graph().excluded(i, j) || i == j; };
      if (swapped.link < 0.1 || near(other[0], other[1]) || near(other[0], other[2]) || near(other[1], other[2]))
        continue;
      EXPECT_LE(swapped.coverage, choice.network.coverage + 1e-9);
    }
}

// Two storeys by construction. Each candidate is at the place x of its number, sees voxels of its own, and shares some
// with those that it is linked to: the surroundings are 100 voxels for each candidate and each pair.
struct Storeys {
  using Pair = std::pair<std::size_t, std::size_t>;
  std::vector<double> z;                 // by candidate
  std::vector<std::uint32_t> captures;   // elements of its own
  std::map<Pair, std::uint32_t> shared;  // voxels, of 100 and more that each sees
  std::vector<Pair> past = {};           // links that nobody walks along

  static std::size_t number(const PlacedStation& station) { return static_cast<std::size_t>(station.position.x); }
  std::vector<PlacedStation> stations() const {
    std::vector<PlacedStation> all;
    for (std::size_t k = 0; k < z.size(); ++k) {
      const Vec3 ground{static_cast<double>(k), 0, z[k]};
      all.push_back({.uv = {}, .position = ground + Vec3{0, 0, 1.8}, .ground = ground});
    }
    return all;
  }
  TraceColumns columns() const {
    return [this](std::span<const PlacedStation> some, const Progress&) {
      std::vector<std::size_t> first{0};
      for (const std::uint32_t own : captures) first.push_back(first.back() + own);
      CoverageMatrix matrix(std::vector<std::uint32_t>(first.back(), 1), 1);
      for (const PlacedStation& one : some) {
        std::vector<std::uint32_t> amounts(first.back(), 0);
        for (std::size_t e = first[number(one)]; e < first[number(one) + 1]; ++e) amounts[e] = 1;
        matrix.add(std::span<const std::uint32_t>(amounts));
      }
      return matrix;
    };
  }
  TraceColumns surroundings() const {
    return [this](std::span<const PlacedStation> some, const Progress&) {
      const std::size_t each = 100, voxels = each * (z.size() + shared.size());
      CoverageMatrix matrix(std::vector<std::uint32_t>(voxels, 1), 1);
      for (const PlacedStation& one : some) {
        std::vector<std::uint32_t> seen(voxels, 0);
        std::size_t left = each, pair = z.size();
        for (const auto& [ends, count] : shared) {
          if (ends.first == number(one) || ends.second == number(one)) {
            for (std::uint32_t k = 0; k < count; ++k) seen[each * pair + k] = 1;
            left -= count;
          }
          ++pair;
        }
        for (std::size_t k = 0; k < left; ++k) seen[each * number(one) + k] = 1;  // each sees 100 in all
        matrix.add(std::span<const std::uint32_t>(seen));
      }
      return matrix;
    };
  }
  bool is_past(std::size_t a, std::size_t b) const {
    return std::ranges::find(past, Pair(std::minmax(a, b))) != past.end();
  }
  PastStairs past_stairs() const {
    return [this](std::span<const PlacedStation> some, std::span<const Pair> pairs) {
      std::vector<std::uint8_t> found;
      for (const auto& [a, b] : pairs) found.push_back(is_past(number(some[a]), number(some[b])));
      return found;
    };
  }
  FewestChoice choice(const FewestAsked& asked) const {
    FewestChoice made{.asked = asked, .table = CandidateTable(columns(), surroundings(), {})};
    made.past_stairs = past_stairs();
    const std::vector<PlacedStation> all = stations();
    look(made.table, {}, all, columns()(all, {}), {}, {});
    choose(made, {}, {});
    return made;
  }
  FewestChoice choice(double coverage) const {
    return choice({.most = z.size(), .captured = true, .coverage = coverage, .link = 0.3});
  }
  // True if links of 0.3 connect these candidates, without those past the stair.
  bool connected_on_foot(std::span<const std::size_t> some) const {
    return components(some.size(), [&](std::size_t i, std::size_t j) {
             const Pair pair = std::minmax(some[i], some[j]);
             return shared.contains(pair) && shared.at(pair) >= 30 && !is_past(pair.first, pair.second);
           }).count == 1;
  }
  double captured(std::span<const std::size_t> some) const {
    double own = 0, all = 0;
    for (std::size_t k = 0; k < z.size(); ++k)
      all += captures[k], own += std::ranges::find(some, k) != some.end() ? captures[k] : 0;
    return own / all;
  }
  // Least number of candidates that capture so much and are connected on foot, among all sets of them.
  std::size_t fewest_on_foot(double coverage) const {
    std::size_t fewest = z.size() + 1;
    for (std::uint32_t bits = 1; bits < (1u << z.size()); ++bits) {
      std::vector<std::size_t> some;
      for (std::size_t k = 0; k < z.size(); ++k)
        if ((bits >> k & 1) != 0) some.push_back(k);
      if (captured(some) >= coverage && connected_on_foot(some)) fewest = std::min(fewest, some.size());
    }
    return fewest;
  }
};

// Rooms 0 and 1 over each other see each other through the garden; 2 and 3 are the foot and the head of the stair.
Storeys rooms_and_stair() {
  return {.z = {0, 3, 0, 3},
          .captures = {40, 40, 5, 5},
          .shared = {{{0, 1}, 45}, {{0, 2}, 35}, {{1, 3}, 35}, {{2, 3}, 31}},
          .past = {{0, 1}}};
}

TEST(KeepToStairs, TiesStoreysAlongTheStair) {
  const Storeys storeys = rooms_and_stair();
  FewestChoice choice = storeys.choice(0.8);
  std::ranges::sort(choice.network.chosen);
  ASSERT_EQ(choice.network.chosen, (std::vector<std::size_t>{0, 1})) << "the plain choice ties them past the stair";
  EXPECT_TRUE(keep_to_stairs(choice, {}));
  EXPECT_EQ(choice.network.violation, 0);
  EXPECT_TRUE(storeys.connected_on_foot(choice.network.chosen));
  EXPECT_GE(storeys.captured(choice.network.chosen), 0.8);
  EXPECT_EQ(choice.network.chosen.size(), storeys.fewest_on_foot(0.8));
  ASSERT_TRUE(choice.along_stairs);
  EXPECT_EQ(choice.along_stairs->unavoidable, 0u);
  EXPECT_FALSE(keep_to_stairs(choice, {})) << "they are tied already";
  // Every ray shows the stair's link to be too weak.
  ScanOverlapMatrix exact(2);
  exact.set(0, 1, 0.2);
  const std::vector<std::size_t> stair{2, 3};
  choice.table.take_in(stair, exact);
  leave_stairs(choice, {});
  std::ranges::sort(choice.network.chosen);
  EXPECT_EQ(choice.network.chosen, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(choice.network.violation, 0);
}

TEST(KeepToStairs, LeavesAChoiceWithoutTiesAlone) {
  Storeys storeys = rooms_and_stair();
  storeys.past.clear();
  FewestChoice choice = storeys.choice(0.8);
  const std::vector<std::size_t> chosen = choice.network.chosen;
  EXPECT_FALSE(keep_to_stairs(choice, {}));
  EXPECT_EQ(choice.network.chosen, chosen);
  EXPECT_TRUE(choice.past_stairs) << "what every ray shows may need it";
}

TEST(KeepToStairs, LeavesTiesThatNoCandidatesReplace) {
  Storeys no_link = rooms_and_stair();
  no_link.shared.at({2, 3}) = 29;
  Storeys long_way = rooms_and_stair();  // over four further stations, of which none captures anything
  long_way.z.insert(long_way.z.end(), {0, 0, 3, 3}), long_way.captures.resize(8, 0);
  long_way.shared.erase({0, 2}), long_way.shared.erase({1, 3});
  for (const auto& [a, b] : {std::pair{0, 4}, {4, 5}, {5, 2}, {1, 6}, {6, 7}, {7, 3}})
    long_way.shared.emplace(std::minmax<std::size_t>(a, b), 40);
  ASSERT_EQ(long_way.fewest_on_foot(0.8), 8u);
  for (const Storeys& storeys : {no_link, long_way}) {
    FewestChoice choice = storeys.choice(0.8);
    const std::vector<std::size_t> chosen = choice.network.chosen;
    ASSERT_EQ(chosen.size(), 2u);
    EXPECT_FALSE(keep_to_stairs(choice, {}));
    EXPECT_EQ(choice.network.chosen, chosen);
    EXPECT_EQ(choice.network.violation, 0);
    EXPECT_EQ(choice.table.graph().overlap(0, 1), 0.45F) << "the link counts again";
    EXPECT_FALSE(choice.past_stairs) << "it is not tried again";
  }
}

// A third storey that no stair leads to, and one that candidates on the stair tie.
TEST(KeepToStairs, ReplacesTheTiesThatItCan) {
  Storeys storeys = rooms_and_stair();
  storeys.z.push_back(6), storeys.captures.push_back(40);
  storeys.shared.emplace(Storeys::Pair{1, 4}, 20), storeys.shared.emplace(Storeys::Pair{0, 4}, 20);
  storeys.shared.at({0, 1}) = 32, storeys.shared.at({1, 4}) = 31;
  storeys.past.push_back({1, 4}), storeys.past.push_back({0, 4});
  FewestChoice choice = storeys.choice(0.9);
  ASSERT_EQ(choice.network.chosen.size(), 3u);
  EXPECT_TRUE(keep_to_stairs(choice, {}));
  std::ranges::sort(choice.network.chosen);
  EXPECT_EQ(choice.network.chosen, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(choice.along_stairs->unavoidable, 1u);
  EXPECT_EQ(choice.network.violation, 0);
}

TEST(KeepToStairs, AsManyStationsAsAreAskedFor) {
  Storeys storeys = rooms_and_stair();
  storeys.z.push_back(0), storeys.captures.push_back(8);
  storeys.shared.emplace(Storeys::Pair{0, 4}, 15), storeys.shared.at({0, 4}) = 32, storeys.shared.at({0, 1}) = 31;
  FewestChoice choice =
      storeys.choice({.fewest = 4, .most = 4, .captured = true, .coverage = 1, .most_coverage = true, .link = 0.3});
  ASSERT_EQ(choice.placed(), 4u);
  ASSERT_FALSE(storeys.connected_on_foot(choice.network.chosen)) << "4 captures more than the foot of the stair";
  EXPECT_TRUE(keep_to_stairs(choice, {}));
  EXPECT_EQ(choice.placed(), 4u);
  EXPECT_TRUE(storeys.connected_on_foot(choice.network.chosen));
}

// Links past the stair between candidates that others connect share nothing; all others keep their share. Overlaps that
// are taken in, and candidates that come later, change which these are.
TEST(CandidateTable, LeavesOutTiesWhereOtherLinksConnect) {
  std::mt19937 rng(11);
  for (int round = 0; round < 20; ++round) {
    Storeys storeys;
    constexpr std::size_t kCandidates = 12;
    for (std::size_t k = 0; k < kCandidates; ++k) storeys.z.push_back(3 * (k % 2)), storeys.captures.push_back(1);
    for (int k = 0; k < 14; ++k) {
      const std::size_t a = rng() % kCandidates, b = rng() % kCandidates;
      if (a == b) continue;
      storeys.shared[std::minmax(a, b)] = rng() % 3 == 0 ? 5 : 10;
      if (a % 2 != b % 2 && rng() % 3 != 0) storeys.past.push_back(std::minmax(a, b));
    }
    constexpr double kLink = 0.1;
    const std::vector<PlacedStation> all = storeys.stations();
    CandidateTable plain(storeys.columns(), storeys.surroundings(), {}), table = plain;
    plain.add(all, {});
    table.add(std::span(all).first(kCandidates / 2), {});
    table.keep_to_stairs(storeys.past_stairs(), kLink);
    table.add(std::span(all).subspan(kCandidates / 2), {});
    const auto expect_left_out = [&](const char* when) {
      const auto counts = [&](std::size_t a, std::size_t b) { return plain.graph().linked(a, b, kLink); };
      const Components parts =
          components(kCandidates, [&](std::size_t a, std::size_t b) { return counts(a, b) && !storeys.is_past(a, b); });
      for (std::size_t a = 0; a < kCandidates; ++a)
        for (std::size_t b = 0; b < kCandidates; ++b) {
          const bool left_out = counts(a, b) && storeys.is_past(a, b) && parts.of[a] == parts.of[b];
          EXPECT_EQ(table.graph().overlap(a, b), left_out ? 0 : plain.graph().overlap(a, b))
              << when << ", round " << round << ": " << a << ", " << b;
        }
    };
    expect_left_out("as the sample shows");
    std::vector<std::size_t> some{0, 1, 2, 3, 4, 5};
    ScanOverlapMatrix exact(some.size());
    for (std::size_t i = 0; i < some.size(); ++i)
      for (std::size_t j = i + 1; j < some.size(); ++j) exact.set(i, j, rng() % 2 == 0 ? 0.05 : 0.15);
    for (CandidateTable* each : {&plain, &table}) each->take_in(some, exact);
    expect_left_out("as every ray shows");
    table.count_all_links();
    for (std::size_t a = 0; a < kCandidates; ++a)
      for (std::size_t b = 0; b < kCandidates; ++b) EXPECT_EQ(table.graph().overlap(a, b), plain.graph().overlap(a, b));
  }
}

// Two rooms of 5 × 10 m at a wall with a doorway of a metre, in which nobody may stand, nor nearer than 0.4 m to the
// wall.
struct TwoRooms {
  static constexpr double kWall = 5, kDoor = 5, kHalfWidth = 0.5, kClear = 0.4;

  static bool sees(const Vec3& a, const Vec3& b) {
    if ((a.x < kWall) == (b.x < kWall)) return true;
    const double t = (kWall - a.x) / (b.x - a.x);
    return std::abs(a.y + t * (b.y - a.y) - kDoor) < kHalfWidth;
  }
  static PlacementOracle oracle() {
    PlacementOracle site = test::toy_site();
    site.locate = [](Uv uv) -> std::optional<Vec3> { return Vec3{10 * uv.u, 10 * uv.v, 3}; };
    site.clashes = [](const Vec3& ground, double) { return std::abs(ground.x - kWall) < kClear; };
    site.sees = sees;
    return site;
  }
  static TraceColumns columns() {
    return [](std::span<const PlacedStation> stations, const Progress&) {
      constexpr std::size_t side = 40;
      CoverageMatrix matrix(std::vector<std::uint32_t>(side * side, 1), 1);
      for (const PlacedStation& station : stations) {
        std::vector<std::uint32_t> amounts(side * side);
        for (std::size_t e = 0; e < amounts.size(); ++e)
          amounts[e] = sees(station.position, {static_cast<double>(e % side) / 4 + 0.125,
                                               static_cast<double>(e / side) / 4 + 0.125, station.position.z});
        matrix.add(std::span<const std::uint32_t>(amounts));
      }
      return matrix;
    };
  }
  // Through the doorway along its lower jamb.
  static std::vector<Vec3> way(const Vec3& from, const Vec3& to) {
    if ((from.x < kWall) == (to.x < kWall)) return {from, to};
    const Vec3 jamb{kWall, kDoor - kHalfWidth + 0.05, 3};
    return {from, jamb, to};
  }
  static PlacedStation at(double x, double y) { return place_station(oracle(), {x / 10, y / 10}, 1.5); }
};

TEST(PositionsAlong, AreAllowedAndOnBothSidesOfADoorway) {
  const Vec3 from{1, 1, 3}, to{9, 1, 3};
  const std::vector<Vec3> way = TwoRooms::way(from, to);
  const auto found = positions_along(TwoRooms::oracle(), way, 1);
  double west = 10, east = 10;  // from the wall
  std::size_t along = 0;
  for (const PlacedStation& one : found) {
    EXPECT_EQ(one.status, StationStatus::ok);
    EXPECT_GE(std::abs(one.ground.x - TwoRooms::kWall), TwoRooms::kClear);
    double& side = one.ground.x < TwoRooms::kWall ? west : east;
    side = std::min(side, std::abs(one.ground.x - TwoRooms::kWall));
    along += std::abs(one.ground.y - TwoRooms::kDoor) > 1.5;
  }
  EXPECT_LT(west, TwoRooms::kClear + 0.2);
  EXPECT_LT(east, TwoRooms::kClear + 0.2);
  EXPECT_GE(along, 4u) << "every metre of two times 3 m";
  EXPECT_LE(along, 10u);
  EXPECT_TRUE(positions_along(TwoRooms::oracle(), {}, 1).empty());
}

FewestChoice in_two_rooms(double coverage) {
  FewestChoice choice{.asked = fewest_asked(floor_problem(coverage)),
                      .table = CandidateTable(TwoRooms::columns(), TwoRooms::columns(), {.nearest_m = 0.1})};
  choice.asked.link = 0.3;
  const std::vector<PlacedStation> corners{TwoRooms::at(1, 1), TwoRooms::at(3, 1), TwoRooms::at(9, 1),
                                           TwoRooms::at(7, 1)};
  choice.table.add(corners, {});
  choose(choice, {}, {});
  return choice;
}

TEST(LookAlongWays, LinksARoomBehindADoorway) {
  FewestChoice choice = in_two_rooms(0.9);
  ASSERT_GT(choice.network.violation, 0);
  EXPECT_FALSE(look_along_ways(choice, TwoRooms::oracle(), {})) << "no way is known";
  choice.way = TwoRooms::way;
  EXPECT_TRUE(look_along_ways(choice, TwoRooms::oracle(), {}));
  EXPECT_EQ(choice.network.violation, 0);
  EXPECT_GE(choice.network.coverage, 0.9);
  EXPECT_GE(choice.network.link, 0.3);
  EXPECT_LE(choice.placed(), 3u);
}

TEST(LookAlongWays, LooksAroundBothEndsWhereNoWayLeads) {
  FewestChoice choice = in_two_rooms(0.9);
  const std::size_t before = choice.table.stations().size();
  choice.way = [](const Vec3&, const Vec3&) { return std::vector<Vec3>{}; };
  look_along_ways(choice, TwoRooms::oracle(), {});
  EXPECT_GT(choice.table.stations().size(), before);
}

TEST(LookAlongWays, LeavesAChoiceThatHasWhatIsAskedAlone) {
  FewestChoice choice = in_two_rooms(0.4);
  ASSERT_EQ(choice.network.violation, 0);
  choice.way = [](const Vec3&, const Vec3&) -> std::vector<Vec3> {
    ADD_FAILURE() << "no way is looked for";
    return {};
  };
  const std::vector<std::size_t> chosen = choice.network.chosen;
  EXPECT_FALSE(look_along_ways(choice, TwoRooms::oracle(), {}));
  EXPECT_EQ(choice.network.chosen, chosen);
}

// The choice without its last stations; it may have at most `most`.
FewestChoice short_of(FewestChoice choice, std::size_t missing, std::size_t most) {
  choice.asked.most = most;
  choice.network.chosen.resize(choice.network.chosen.size() - missing);
  choice.network = evaluate_cover(cover_problem(choice), std::move(choice.network.chosen));
  return choice;
}

TEST(GrowIntoReach, TakesMoreStationsWhereLinkedOnesAreShort) {
  const FewestChoice whole = chosen(floor_problem(0.7), 12);
  ASSERT_EQ(whole.network.violation, 0);
  const std::size_t stations = whole.network.chosen.size();
  ASSERT_GT(stations, 2u);
  FewestChoice choice = short_of(whole, 2, stations + 2);
  ASSERT_GE(choice.network.link, choice.asked.link);
  ASSERT_TRUE(out_of_reach(choice));
  EXPECT_TRUE(grow_into_reach(choice, {}));
  EXPECT_EQ(choice.network.violation, 0);
  EXPECT_LE(choice.network.chosen.size(), stations + 2);

  FewestChoice few = short_of(whole, 2, stations - 2);
  const std::vector<std::size_t> before = few.network.chosen;
  EXPECT_FALSE(grow_into_reach(few, {})) << "no more are allowed";
  EXPECT_EQ(few.network.chosen, before);
  FewestChoice reached = whole;
  EXPECT_FALSE(grow_into_reach(reached, {})) << "nothing is missing";
}

}  // namespace
}  // namespace vantage
