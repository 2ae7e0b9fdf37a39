// SPDX-License-Identifier: Apache-2.0
#include "core/disjoint_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/person.hpp"
#include "core/philox.hpp"
#include "vantage/placement.hpp"

namespace vantage {
namespace {

// Against labels that are rewritten one by one.
TEST(DisjointSets, AreNamedByTheirSmallestMembers) {
  constexpr std::size_t kMembers = 200;
  RandomStream random(7);
  DisjointSets sets(kMembers);
  EXPECT_EQ(sets.size(), kMembers);
  std::vector<std::uint32_t> label = first_numbers<std::uint32_t>(kMembers);
  for (int k = 0; k < 300; ++k) {
    const auto a = static_cast<std::size_t>(random.uniform() * kMembers),
               b = static_cast<std::size_t>(random.uniform() * kMembers);
    const std::uint32_t low = std::min(label[a], label[b]), high = std::max(label[a], label[b]);
    EXPECT_EQ(sets.join(a, b), low != high);
    std::ranges::replace(label, high, low);
    for (std::size_t m = 0; m < kMembers; ++m) ASSERT_EQ(sets.find(m), label[m]) << k << " " << m;
  }
  EXPECT_LT(std::ranges::count(label, 0u), static_cast<std::ptrdiff_t>(kMembers)) << "else the test shows little";
  EXPECT_GT(std::ranges::count(label, 0u), 1);
}

// The public header states the figure, since it cannot include the other.
TEST(Person, TakesTheSameStepEverywhere) { EXPECT_EQ(WalkableOptions().climb_m, person::kStep_m); }

}  // namespace
}  // namespace vantage
