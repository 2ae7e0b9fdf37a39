// SPDX-License-Identifier: Apache-2.0
#include "optimise/index_set.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>

namespace vantage::optimise {
namespace {

RC_GTEST_PROP(IndexSet, BehavesAsAnOrderedSet, ()) {
  const auto size = *rc::gen::element<std::size_t>(1, 63, 64, 65, 4096, 4097, 300000);
  IndexSet ours(size);
  std::set<std::size_t> theirs;
  for (int step = 0; step < 200; ++step) {
    const auto i = *rc::gen::inRange<std::size_t>(0, size);
    if (*rc::gen::arbitrary<bool>()) {
      ours.insert(i);
      theirs.insert(i);
    } else {
      ours.erase(i);
      theirs.erase(i);
    }
    const auto q = *rc::gen::inRange<std::size_t>(0, size);
    const auto above = theirs.upper_bound(q), below = theirs.lower_bound(q);
    RC_ASSERT(ours.next(q) == (above == theirs.end() ? IndexSet::kNone : *above));
    RC_ASSERT(ours.previous(q) == (below == theirs.begin() ? IndexSet::kNone : *std::prev(below)));
  }
}

}  // namespace
}  // namespace vantage::optimise
