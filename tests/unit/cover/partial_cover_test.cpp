// SPDX-License-Identifier: Apache-2.0
#include "cover/partial_cover.hpp"

#include <gtest/gtest.h>

#include "unit/cover/random_matrix.hpp"

namespace vantage {
namespace {

using test::Chosen;
using test::coverage_by_definition;
using test::random_matrix;

TEST(PartialCover, KeepsTheCoverageOfItsCandidates) {
  const CoverageMatrix matrix = random_matrix(12, 80, 1, 0.3, 4);
  PartialCover cover(matrix);
  Chosen chosen;
  for (const std::size_t k : {3u, 7u, 1u, 3u}) {
    const double before = cover.value(), gain = cover.gain(k);
    cover.add(k);
    chosen.push_back(k);
    EXPECT_NEAR(cover.value(), coverage_by_definition(matrix, chosen), 1e-12);
    EXPECT_NEAR(cover.value() - before, gain, 1e-12);
    EXPECT_NEAR(cover.loss(k), gain, 1e-12);
  }
  EXPECT_EQ(matrix.coverage(chosen), cover.value());
  cover.remove(7);
  EXPECT_NEAR(cover.value(), coverage_by_definition(matrix, Chosen{3, 1, 3}), 1e-12);
}

TEST(CoverGains, KnowsWhatCandidatesGainWithoutOneThatLeaves) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const CoverageMatrix matrix = random_matrix(20, 90, seed, 0.3, 3);
    const Chosen chosen{2, 11, 7, 2, 19};  // one of them twice
    const ColumnIndex columns(matrix);
    const CoverGains known(matrix, columns, chosen);
    for (std::size_t at = 0; at < chosen.size(); ++at) {
      Chosen others = chosen;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(at));
      const PartialCover without(matrix, others);
      std::vector<CoverUnits> gains(matrix.candidates());
      for (std::size_t k = 0; k < gains.size(); ++k) gains[k] = known[k];
      known.for_gains_without(chosen[at], [&](std::size_t k, CoverUnits gained) { gains[k] += gained; });
      for (std::size_t k = 0; k < gains.size(); ++k)
        EXPECT_NEAR(known.share(gains[k]), without.gain(k), 1e-12) << k << " without " << chosen[at];
      EXPECT_NEAR(known.share(known.loss(chosen[at])), known.cover().loss(chosen[at]), 1e-12);
    }
  }
}

TEST(CoverGains, AreThoseOfTheSetAfterEachChange) {
  RandomStream random(5);
  const CoverageMatrix matrix = random_matrix(40, 200, 3, 0.05, 9);
  const ColumnIndex columns(matrix);
  Chosen chosen{4, 17};
  CoverGains known(matrix, columns, chosen);
  for (int change = 0; change < 60; ++change) {
    const auto joining = static_cast<std::size_t>(random.uniform() * 40);
    if (change % 3 == 0) {
      known.add(joining);
      chosen.push_back(joining);
    } else {
      const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(chosen.size()));
      known.replace(chosen[at], joining);
      chosen[at] = joining;
    }
    const CoverGains anew(matrix, columns, chosen);
    EXPECT_EQ(known.value(), anew.value()) << "exactly: rounding must not tell equal candidates apart";
    EXPECT_NEAR(known.share(known.value()), matrix.coverage(chosen), 1e-12);
    for (std::size_t k = 0; k < matrix.candidates(); ++k) {
      EXPECT_EQ(known[k], anew[k]);
      EXPECT_NEAR(known.share(known[k]), anew.cover().gain(k), 1e-12);
    }
  }
}

TEST(CoverGains, OfElementsWithGoalsOfTheirOwn) {
  CoverageMatrix matrix = random_matrix(15, 60, 4, 0.4, 5);
  std::vector<double> goals(60);
  for (std::size_t e = 0; e < goals.size(); ++e) goals[e] = 0.7 * static_cast<double>(e % 9);  // some are 0
  matrix.set_goals(goals);
  const ColumnIndex columns(matrix);
  CoverGains known(matrix, columns, Chosen{1});
  Chosen chosen{1};
  for (const std::size_t k : {4u, 9u, 2u}) {
    const PartialCover cover(matrix, chosen);
    for (std::size_t j = 0; j < matrix.candidates(); ++j) EXPECT_NEAR(known.share(known[j]), cover.gain(j), 1e-12);
    known.add(k), chosen.push_back(k);
  }
  Chosen all(matrix.candidates());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  const CoverGains whole(matrix, columns, all);
  EXPECT_NEAR(whole.share(whole.value()), matrix.coverage(all), 1e-12);
}

}  // namespace
}  // namespace vantage
