// SPDX-License-Identifier: Apache-2.0
// Loops of oneTBB that do their whole work or throw. Once an error ends a loop, oneTBB also ends the loops inside it.
// They return as usual with part of their work undone, and code after them would read values that were never written.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_group.h>

#include <utility>

namespace vantage::parallel {

// Thrown by a loop that was cut short, in a task of the loop that the error ends; oneTBB drops it and keeps the error.
// It is no std::exception, so that nobody handles it as an error of its own.
struct CutShort {};

// tbb::parallel_for.
template <class... Arguments>
void for_all(Arguments&&... arguments) {
  tbb::task_group_context context;
  tbb::parallel_for(std::forward<Arguments>(arguments)..., context);
  if (context.is_group_execution_cancelled()) throw CutShort{};
}

// tbb::parallel_reduce.
template <class... Arguments>
auto reduce(Arguments&&... arguments) {
  tbb::task_group_context context;
  auto result = tbb::parallel_reduce(std::forward<Arguments>(arguments)..., context);
  if (context.is_group_execution_cancelled()) throw CutShort{};
  return result;
}

// tbb::parallel_deterministic_reduce.
template <class... Arguments>
auto reduce_in_order(Arguments&&... arguments) {
  tbb::task_group_context context;
  auto result = tbb::parallel_deterministic_reduce(std::forward<Arguments>(arguments)..., context);
  if (context.is_group_execution_cancelled()) throw CutShort{};
  return result;
}

// tbb::parallel_sort.
template <class... Arguments>
void sort(Arguments&&... arguments) {
  tbb::parallel_sort(std::forward<Arguments>(arguments)...);
  if (tbb::is_current_task_group_canceling()) throw CutShort{};
}

// tbb::parallel_invoke.
template <class One, class Other>
void both(const One& one, const Other& other) {
  tbb::task_group_context context;
  tbb::parallel_invoke(one, other, context);
  if (context.is_group_execution_cancelled()) throw CutShort{};
}

inline void wait(tbb::task_group& group) {
  if (group.wait() == tbb::canceled) throw CutShort{};
}

// Runs `other` in a task while this thread runs `own`, whose loops do not take that task up.
template <class Other, class Own>
void beside(const Other& other, const Own& own) {
  tbb::task_group group;
  group.run(other);
  try {
    tbb::this_task_arena::isolate(own);
  } catch (...) {
    group.wait();
    throw;
  }
  wait(group);
}

}  // namespace vantage::parallel
