// SPDX-License-Identifier: Apache-2.0
#include "cover/swap_gains.hpp"

#include <gtest/gtest.h>

#include "unit/cover/random_matrix.hpp"

namespace vantage {
namespace {

using test::Chosen;
using test::random_matrix;

// Gain of each candidate without the member at `at`.
std::vector<CoverUnits> gains_without(const SwapGains& known, std::size_t at, std::size_t candidates) {
  std::vector<CoverUnits> gains(candidates);
  for (std::size_t k = 0; k < candidates; ++k) gains[k] = known.now()[k];
  for (const SwapGains::More& one : known.without(at)) gains[one.candidate] += one.gain;
  return gains;
}

TEST(SwapGains, AreThoseOfTheNetworkAfterEachSwap) {
  RandomStream random(7);
  for (const double density : {0.03, 0.3}) {
    const CoverageMatrix matrix = random_matrix(50, 150, 2, density, 9);
    const ColumnIndex columns(matrix);
    Chosen network{3, 3, 40, 17, 8, 29};  // one of them twice, which stays
    SwapGains known(matrix, columns, network);
    for (int swap = 0; swap < 60; ++swap) {
      const std::size_t at = 2 + static_cast<std::size_t>(random.uniform() * 4);
      const auto joining = static_cast<std::size_t>(random.uniform() * 50);
      network[at] = joining;
      known.replace(at, joining);
      const SwapGains anew(matrix, columns, network);
      EXPECT_EQ(known.now().value(), anew.now().value());
      for (std::size_t place = 0; place < network.size(); ++place) {
        EXPECT_EQ(known.loss(place), anew.loss(place));
        EXPECT_EQ(gains_without(known, place, 50), gains_without(anew, place, 50));
        Chosen others = network;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
        const PartialCover without(matrix, others);
        const std::vector<CoverUnits> gains = gains_without(known, place, 50);
        for (std::size_t k = 0; k < 50; ++k) EXPECT_NEAR(known.now().share(gains[k]), without.gain(k), 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace vantage
