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

TEST(CoverGains, KnowsWhatCandidatesGainWithoutAMember) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const CoverageMatrix matrix = random_matrix(20, 90, seed, 0.3, 3);
    const Chosen chosen{2, 11, 7, 19};
    const ColumnIndex columns(matrix);
    const CoverGains known(matrix, columns, chosen);
    std::vector<double> more;
    for (std::size_t at = 0; at < chosen.size(); ++at) {
      Chosen others = chosen;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(at));
      const PartialCover without(matrix, others);
      known.gains_without(chosen[at], more);
      for (std::size_t k = 0; k < matrix.candidates(); ++k)
        EXPECT_NEAR(known[k] + more[k], without.gain(k), 1e-12) << k << " without " << chosen[at];
    }
  }
}

TEST(CoverGains, AreThoseOfTheSetAfterEachChange) {
  RandomStream random(5);
  CoverageMatrix matrix = random_matrix(40, 200, 3, 0.05, 9);
  std::vector<double> goals;  // of their own, some of them 0
  for (std::size_t e = 0; e < matrix.elements(); ++e) goals.push_back(e % 7 == 0 ? 0 : 3 + 20 * random.uniform());
  matrix.set_goals(goals);
  const ColumnIndex columns(matrix);
  Chosen chosen{4, 17};
  CoverGains known(matrix, columns, chosen);
  std::vector<double> more;
  for (int change = 0; change < 200; ++change) {
    const auto some = static_cast<std::size_t>(random.uniform() * 40);
    if (const auto member = std::ranges::find(chosen, some); member != chosen.end()) {
      known.gains_without(some, more);
      known.remove(some, more);
      chosen.erase(member);
    } else {
      known.add(some);
      chosen.push_back(some);
    }
    const PartialCover cover(matrix, chosen);
    EXPECT_NEAR(known.value(), cover.value(), 1e-12);
    for (std::size_t k = 0; k < matrix.candidates(); ++k) EXPECT_NEAR(known[k], cover.gain(k), 1e-12);
    for (const std::size_t k : chosen) EXPECT_NEAR(known.loss(k), cover.loss(k), 1e-12);
  }
}

}  // namespace
}  // namespace vantage
