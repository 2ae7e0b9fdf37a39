// SPDX-License-Identifier: Apache-2.0
#include "core/parallel.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <stdexcept>
#include <vector>

namespace vantage::parallel {
namespace {

constexpr std::size_t parts = 4096;

// Runs `inner` in tasks of a loop, until one of them throws; returns the times that `inner` came back.
std::size_t returns_of(const std::function<void()>& inner) {
  tbb::task_arena threads(8);
  std::atomic<std::size_t> begun{0}, returned{0};
  EXPECT_THROW(threads.execute([&] {
    for_all(std::size_t{0}, std::size_t{400}, [&](std::size_t) {
      if (begun++ == 20) throw std::runtime_error("no more");
      inner();
      ++returned;
    });
  }),
               std::runtime_error);
  return returned;
}

TEST(ParallelLoops, DoTheirWholeWorkOrThrowInsideALoopThatAnErrorEnds) {
  std::atomic<std::size_t> undone{0};
  for (int round = 0; round < 20; ++round)
    EXPECT_LT(returns_of([&] {
                std::vector<int> done(parts, 0);
                for_all(std::size_t{0}, parts, [&](std::size_t k) { done[k] = 1; });
                undone += static_cast<std::size_t>(std::ranges::count(done, 0));
              }),
              400u);
  EXPECT_EQ(undone, 0u);
}

TEST(ParallelLoops, ReduceToTheWholeOrThrow) {
  std::atomic<std::size_t> wrong{0};
  for (int round = 0; round < 20; ++round)
    returns_of([&] {
      const std::size_t sum = reduce(
          tbb::blocked_range<std::size_t>(0, parts, 1), std::size_t{0},
          [](const tbb::blocked_range<std::size_t>& range, std::size_t so_far) { return so_far + range.size(); },
          std::plus<>());
      if (sum != parts) ++wrong;
    });
  EXPECT_EQ(wrong, 0u);
}

TEST(ParallelLoops, TakeBothHalvesOrThrow) {
  std::atomic<std::size_t> undone{0};
  for (int round = 0; round < 20; ++round)
    returns_of([&] {
      std::atomic<int> halves{0};
      both([&] { ++halves; }, [&] { ++halves; });
      if (halves != 2) ++undone;
    });
  EXPECT_EQ(undone, 0u);
}

TEST(ParallelLoops, SortAsOneThreadDoes) {
  std::vector<int> numbers(10000);
  for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = static_cast<int>(k * 7919 % 10007);
  std::vector<int> sorted = numbers;
  std::ranges::sort(sorted, std::greater<>());
  sort(numbers.begin(), numbers.end(), std::greater<>());
  EXPECT_EQ(numbers, sorted);
}

TEST(ParallelLoops, KeepAnErrorOfTheirOwn) {
  EXPECT_THROW(for_all(0, 100,
                       [](int k) {
                         if (k == 50) throw std::out_of_range("50");
                       }),
               std::out_of_range);
  tbb::task_group group;
  group.run([] { throw std::out_of_range("in a group"); });
  EXPECT_THROW(wait(group), std::out_of_range);
}

}  // namespace
}  // namespace vantage::parallel
