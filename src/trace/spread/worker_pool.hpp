// SPDX-License-Identifier: Apache-2.0
// Tracers that share one work, each on its own thread. A worker that fails is dropped, and the others repeat its chunk.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "trace/spread/rate.hpp"
#include "trace/spread/work_queue.hpp"
#include "trace/tracer.hpp"

namespace vantage {

// Measured speed of each worker for one kind of work. It sizes chunks and never affects results.
struct WorkerRates {
  std::vector<Rate> of_workers = {};
  std::vector<double> shares = {};  // of all work, from these rates
  // Part of the remaining items handed out in one round; 1 if all items cost the same, so that rates hold.
  double of_rest = WorkQueue::kFactored;
};

class WorkerPool {
 public:
  using Warn = std::function<void(const std::string&)>;
  // REQUIRES: at least one tracer.
  WorkerPool(std::vector<std::unique_ptr<Tracer>> tracers, Warn warn);

  // Runs a worker's request on the thread that called work(); the worker waits for the answer.
  using OnCaller = std::function<void(const std::function<void()>&)>;
  // Does items [first, end) of the work. Returns false if it was stopped before the end.
  using Do = std::function<bool(Tracer& tracer, const Chunk& chunk, const Progress& progress, const OnCaller& ask)>;

  // Does each of `items` items once; another worker repeats a failed worker's chunk. Returns true if all are done,
  // false if the caller stopped it. Throws exceptions of a worker that are no failure of its device, and the failure of
  // the last worker.
  bool work(std::size_t items, WorkerRates& rates, const Progress& progress, const Do& job);

  std::size_t size() const { return tracers_.size(); }  // including dropped workers
  std::size_t left() const;
  // Returns null if the worker was dropped.
  Tracer* worker(std::size_t k) const { return tracers_[k].get(); }

 private:
  class Run;
  bool work_alone(std::size_t items, WorkerRates& rates, const Progress& progress, const Do& job);
  std::size_t fastest(const WorkerRates& rates) const;
  void drop(std::size_t k, const std::string& why);

  std::vector<std::unique_ptr<Tracer>> tracers_;
  std::vector<std::string> names_;
  Warn warn_;
};

}  // namespace vantage
