// SPDX-License-Identifier: Apache-2.0
#include "trace/rays/ray_batches.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "trace/device_fault.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// A device without memory for this few rays is useless.
constexpr std::size_t kFewest = 1024;

struct Batch {
  std::size_t slot, first, count;
};

}  // namespace

RayBatches::RayBatches(Make make) : make_(std::move(make)), finder_(made()), on_device_(finder_ != nullptr) {
  if (finder_) info_ = finder_->info();
}

std::unique_ptr<RayFinder> RayBatches::made() const {
  try {
    return make_();
  } catch (const DeviceFault&) {
    return make_();
  }
}

bool RayBatches::run(std::size_t rays, const Job& job, const Progress& progress) {
  if (caller_ == std::this_thread::get_id())
    throw Error(Errc::invalid_argument, "rays: the progress of a call on a device called the same tracer again");
  const std::scoped_lock lock(alone_);
  caller_ = std::this_thread::get_id();
  const struct Leave {
    std::atomic<std::thread::id>& caller;
    ~Leave() { caller = std::thread::id(); }
  } leave{caller_};
  // A thread that waits here must not take up other work of a caller that waits for this lock.
  return tbb::this_task_arena::isolate([&] { return run_alone(rays, job, progress); });
}

bool RayBatches::run_alone(std::size_t rays, const Job& job, const Progress& progress) {
  std::size_t done = 0;
  std::optional<std::size_t> failed_at;
  for (;;) try {
      if (!finder_) finder_ = make_();
      at_once_ = std::min(at_once_, finder_->most_rays());
      return run_from(done, rays, job, progress);
    } catch (const DeviceFault& fault) {
      const bool was_made = finder_ != nullptr;
      finder_ = nullptr;
      if (was_made && fault.code() == Errc::out_of_memory && at_once_ > kFewest)
        at_once_ = std::max(kFewest, std::min(at_once_, rays - done) / 2);
      else if (!was_made || std::exchange(failed_at, done) == done)
        throw;
    }
}

bool RayBatches::run_from(std::size_t& done, std::size_t rays, const Job& job, const Progress& progress) {
  if (done == rays) return !progress.stopped();
  RayFinder& finder = *finder_;
  finder.reserve(std::min(at_once_, rays - done));
  const auto batch_at = [&](std::size_t slot, std::size_t first) {
    return Batch{slot, first, std::min(at_once_, rays - first)};
  };
  const auto fill = [&](const Batch& batch) {
    if (batch.count > 0) job.fill(batch.first, finder.rays(batch.slot).first(batch.count));
  };
  Batch now = batch_at(0, done), before{1, done, 0};
  fill(now);
  while (now.count > 0) {
    if (progress.stopped()) return false;
    const Batch next = batch_at(before.slot, now.first + now.count);
    parallel::beside([&] { finder.find(now.slot, now.count, job.question, job.end); },
                     [&] {
                       if (before.count > 0) job.take(before.first, finder.answers(before.slot).first(before.count));
                       done = now.first;
                       fill(next);
                     });
    if (before.count > 0) progress(static_cast<double>(done) / static_cast<double>(rays));
    before = now;
    now = next;
  }
  job.take(before.first, finder.answers(before.slot).first(before.count));
  done = rays;
  progress(1);
  return !progress.stopped();
}

}  // namespace vantage
