// SPDX-License-Identifier: Apache-2.0
// Against all networks there are, on tables small enough to try them.
#include "plan/fewest_on_rows.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <random>

namespace vantage {
namespace {

constexpr double kGoal = 4;

struct Table {
  CaptureRows rows;
  PairTable pairs;
};

// Stations on a square of 10 m; each sees the points within 4 m, and overlaps by how near it is to another.
Table random_table(std::size_t stations, unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&] { return 10 * static_cast<double>(random()) / 4294967296.0; };
  std::vector<Vec3> at(stations);
  for (Vec3& p : at) p = {number(), number(), 0};
  constexpr int side = 10;
  Table table{.rows = CaptureRows(std::vector<std::uint32_t>(side * side, 1), kGoal), .pairs = {}};
  const auto distance = [](const Vec3& a, const Vec3& b) { return std::sqrt(dot(a - b, a - b)); };
  for (const Vec3& p : at) {
    std::vector<std::uint32_t> points;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const double away = distance(p, {i + 0.5, j + 0.5, 0});
        points.push_back(away < 4 ? static_cast<std::uint32_t>(std::ceil(6 - away)) : 0);
      }
    table.rows.add(points);
  }
  std::vector<float> overlaps;
  for (const Vec3& a : at)
    for (const Vec3& b : at) overlaps.push_back(static_cast<float>(std::max(0.0, 1 - distance(a, b) / 8)));
  table.pairs = PairTable(stations, overlaps);
  return table;
}

// Coverage and weakest link of a set by their definitions.
double coverage_of(const Table& table, std::uint32_t set) {
  std::vector<double> points(table.rows.voxels().size(), 0);
  for (std::size_t k = 0; k < table.rows.size(); ++k)
    if (set >> k & 1)
      for (const CapturedVoxel& one : table.rows.row(k)) points[one.voxel] += one.points;
  double sum = 0;
  for (const double p : points) sum += std::min(1.0, p / kGoal);
  return sum / static_cast<double>(points.size());
}
bool hangs_together(const Table& table, std::uint32_t set, double link) {
  std::uint32_t reached = set & -set;
  for (bool grows = true; grows;) {
    grows = false;
    for (std::size_t i = 0; i < table.rows.size(); ++i)
      for (std::size_t j = 0; j < table.rows.size(); ++j)
        if (i != j && (reached >> i & 1) && (set >> j & 1) && !(reached >> j & 1) &&
            static_cast<double>(table.pairs.overlap(i, j)) >= link)
          reached |= 1u << j, grows = true;
  }
  return reached == set;
}

TEST(FewestOnRows, IsTheFewestThereIs) {
  int compared = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const Table table = random_table(13, seed);
    for (const double coverage : {0.5, 0.7, 0.8}) {
      for (const double link : {0.0, 0.4, 0.6}) {
        int fewest = 100;
        for (std::uint32_t set = 1; set < 1u << 13; ++set)
          if (std::popcount(set) < fewest && coverage_of(table, set) >= coverage &&
              (link == 0 || hangs_together(table, set, link)))
            fewest = std::popcount(set);
        const RowQuestion question{
            .rows = table.rows, .pairs = table.pairs, .coverage = coverage, .link = link, .fewest = 1, .most = 13};
        const RowAnswer answer = fewest_on_rows(question);
        std::uint32_t found = 0;
        for (const std::size_t row : answer.rows) found |= 1u << row;
        ASSERT_EQ(std::popcount(found), static_cast<int>(answer.rows.size())) << "no row twice";
        EXPECT_NEAR(answer.coverage, coverage_of(table, found), 1e-12);
        if (fewest == 100) {
          EXPECT_GT(answer.missed, 0);
          continue;
        }
        ++compared;
        EXPECT_EQ(answer.missed, 0) << "seed " << seed << ", coverage " << coverage << ", link " << link;
        EXPECT_GE(coverage_of(table, found), coverage);
        if (link > 0) {
          EXPECT_TRUE(hangs_together(table, found, link));
        }
        EXPECT_EQ(std::popcount(found), fewest) << "seed " << seed << ", coverage " << coverage << ", link " << link;
      }
    }
  }
  EXPECT_GT(compared, 50);
}

TEST(FewestOnRows, KeepsWhatIsThereAndTheNumbersAsked) {
  const Table table = random_table(13, 3);
  RowQuestion question{
      .rows = table.rows, .pairs = table.pairs, .coverage = 0.7, .link = 0.3, .fixed = 2, .fewest = 1, .most = 11};
  const RowAnswer answer = fewest_on_rows(question);
  EXPECT_EQ(answer.rows[0], 0u);
  EXPECT_EQ(answer.rows[1], 1u);
  question.fixed = 0, question.fewest = 7;
  EXPECT_GE(fewest_on_rows(question).rows.size(), 7u);
  question.fewest = 1, question.most = 2;
  const RowAnswer few = fewest_on_rows(question);
  EXPECT_LE(few.rows.size(), 2u);
  EXPECT_GT(few.missed, 0) << "two circles of 4 m do not cover 70 m2 four times";
}

TEST(FewestOnRows, BetterIsNeverWorse) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Table table = random_table(40, seed);
    const RowQuestion question{.rows = table.rows, .pairs = table.pairs, .coverage = 0.8, .link = 0.4};
    const RowAnswer first = fewest_on_rows(question);
    const RowAnswer better = better_on_rows(question, first);
    EXPECT_EQ(better.rows.size(), first.rows.size());
    EXPECT_LE(better.missed, first.missed);
    if (first.missed == 0) {
      EXPECT_GE(better.link, first.link);
    }
    EXPECT_EQ(better.rows, better_on_rows(question, first).rows) << "the same, to the last row";
  }
}

TEST(FewestOnRows, GivesANetworkEvenWhenStopped) {
  const Table table = random_table(40, 1);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(
      fewest_on_rows({.rows = table.rows, .pairs = table.pairs, .coverage = 0.8, .link = 0.4}, stop.get_token())
          .rows.empty());
}

TEST(PairTable, CountsWhatBothSee) {
  CaptureRows rows(std::vector<std::uint32_t>(70, 1), 1);
  std::vector<std::uint32_t> first(70, 0), second(70, 0);
  for (int v = 0; v < 40; ++v) first[static_cast<std::size_t>(v)] = 1;
  for (int v = 30; v < 70; v += 2) second[static_cast<std::size_t>(v)] = 5;
  rows.add(first), rows.add(second);
  const std::vector<PlacedStation> stations{{.uv = {}, .position = {0, 0, 0}}, {.uv = {}, .position = {0, 0.6, 0.8}}};
  const PairTable table(rows, stations, 1.01);
  EXPECT_FLOAT_EQ(table.overlap(0, 1), 5.0F / 20);  // of the smaller scan
  EXPECT_FLOAT_EQ(table.overlap(1, 0), 5.0F / 20);
  EXPECT_TRUE(table.too_near(0, 1));
  EXPECT_FALSE(PairTable(rows, stations, 1).too_near(0, 1));
}

TEST(FewestOnRows, GrowsFromWhereItIsNotEnough) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const Table table = random_table(13, seed);
    RowQuestion question{
        .rows = table.rows, .pairs = table.pairs, .coverage = 0.4, .link = 0.3, .fewest = 1, .most = 13};
    const RowAnswer few = fewest_on_rows(question);
    ASSERT_EQ(few.missed, 0);
    question.coverage = 0.8;  // more is wanted now
    const RowAnswer more = fewest_on_rows(question, {}, judge_rows(question, few.rows));
    EXPECT_EQ(more.missed, 0);
    EXPECT_GT(more.rows.size(), few.rows.size());
    EXPECT_LE(more.rows.size(), fewest_on_rows(question).rows.size() + 1);
    question.most = few.rows.size();  // but no more stations are allowed
    EXPECT_EQ(fewest_on_rows(question, {}, judge_rows(question, few.rows)).rows.size(), few.rows.size());
  }
}

}  // namespace
}  // namespace vantage
