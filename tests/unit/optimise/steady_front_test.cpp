// SPDX-License-Identifier: Apache-2.0
#include "optimise/steady_front.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "optimise/hypervolume.hpp"
#include "optimise/mo_common.hpp"
#include "optimise/normal_stream.hpp"

namespace vantage::optimise {
namespace {

// Compares ranks and contributions, after each newcomer, with a full recount.
void compare(std::size_t m, double reference, bool coarse, std::uint64_t seed) {
  NormalStream random(seed);
  const std::size_t mu = 20;
  const std::vector<double> corner(m, reference);
  const auto draw = [&](double shrink) {
    std::vector<double> f(m);
    double sum = 0;
    for (double& v : f) sum += v = random.uniform() + 0.01;
    for (double& v : f) {
      v = v / sum * (1 + shrink * random.uniform());
      if (coarse) v = std::round(8 * v) / 8;
    }
    if (random.uniform() < 0.01) f.assign(m, std::numeric_limits<double>::infinity());
    return f;
  };
  std::vector<double> fitness;
  for (std::size_t i = 0; i < mu; ++i) {
    const auto f = draw(1.5);
    fitness.insert(fitness.end(), f.begin(), f.end());
  }
  SteadyFront front(m, corner);
  front.assign(fitness);
  std::size_t kept = 0;
  for (int step = 0; step < 400; ++step) {
    const auto f = draw(1.5 / (1 + 0.02 * step));
    auto all = fitness;
    all.insert(all.end(), f.begin(), f.end());
    const auto rank = ranks({all, m});
    const std::size_t parent = random.index(mu + 1);
    const auto [removed, newcomer, of_parent] = front.offer(f, parent);
    EXPECT_EQ(newcomer, rank[mu]);
    EXPECT_EQ(of_parent, rank[parent]);
    const std::size_t worst = *std::max_element(rank.begin(), rank.end());
    EXPECT_EQ(rank[removed], worst);
    std::vector<double> last;
    std::vector<std::size_t> index;
    for (std::size_t i = 0; i <= mu; ++i) {
      if (rank[i] != worst) continue;
      index.push_back(i);
      last.insert(last.end(), all.begin() + static_cast<std::ptrdiff_t>(i * m),
                  all.begin() + static_cast<std::ptrdiff_t>((i + 1) * m));
    }
    const auto counted = contributions({last, m}, reach_over(last, corner));
    const auto position = static_cast<std::size_t>(std::ranges::find(index, removed) - index.begin());
    EXPECT_LE(counted[position], *std::ranges::min_element(counted) + 1e-13 * std::pow(reference + 1, m))
        << "step " << step;
    if (removed != mu) {
      ++kept;
      std::copy(f.begin(), f.end(), fitness.begin() + static_cast<std::ptrdiff_t>(removed * m));
    }
    const auto now = ranks({fitness, m});
    std::vector<double> first;
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < mu; ++i) {
      ASSERT_EQ(front.rank(i), now[i]) << "step " << step;
      if (now[i] == 0) members.push_back(i);
      if (now[i] == 0)
        first.insert(first.end(), fitness.begin() + static_cast<std::ptrdiff_t>(i * m),
                     fitness.begin() + static_cast<std::ptrdiff_t>((i + 1) * m));
    }
    const auto expected = contributions({first, m}, reach_over(first, corner));
    for (std::size_t k = 0; k < members.size(); ++k)
      ASSERT_NEAR(front.contributions()[members[k]], expected[k], 1e-13 * std::pow(reference + 1, m) + 1e-12)
          << "step " << step;
  }
  EXPECT_GT(kept, 20u);
}

TEST(SteadyFront, AgreesWithCountingFromNothing) {
  for (const std::size_t m : {1, 2, 3, 4})
    for (const double reference : {0.4, 5.0})
      for (std::uint64_t seed = 1; seed <= 4; ++seed) compare(m, reference, false, seed);
}

TEST(SteadyFront, AgreesWhereManyAreEqual) {
  for (const std::size_t m : {2, 3, 4})
    for (const double reference : {0.4, 5.0})
      for (std::uint64_t seed = 1; seed <= 4; ++seed) compare(m, reference, true, seed);
}

}  // namespace
}  // namespace vantage::optimise
