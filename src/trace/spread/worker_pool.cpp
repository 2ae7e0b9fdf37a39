// SPDX-License-Identifier: Apache-2.0
#include "trace/spread/worker_pool.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <numeric>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "core/seconds_since.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using Clock = std::chrono::steady_clock;

// Returns true for failures that another device may not share.
bool of_the_device(const Error& error) {
  return error.code() == Errc::device_failure || error.code() == Errc::out_of_memory;
}

}  // namespace

WorkerPool::WorkerPool(std::vector<std::unique_ptr<Tracer>> tracers, Warn warn)
    : tracers_(std::move(tracers)), warn_(std::move(warn)) {
  assert(!tracers_.empty());
  for (const auto& tracer : tracers_)
    names_.push_back(to_string(tracer->info().engine) + " on device " + std::to_string(tracer->info().device_index) +
                     ", " + tracer->info().device);
}

std::size_t WorkerPool::left() const {
  return static_cast<std::size_t>(
      std::count_if(tracers_.begin(), tracers_.end(), [](const auto& tracer) { return tracer != nullptr; }));
}

std::size_t WorkerPool::fastest(const WorkerRates& rates) const {
  std::size_t best = tracers_.size();
  for (std::size_t k = 0; k < tracers_.size(); ++k)
    if (tracers_[k] &&
        (best == tracers_.size() || rates.of_workers[k].items_a_second() > rates.of_workers[best].items_a_second()))
      best = k;
  return best;
}

void WorkerPool::drop(std::size_t k, const std::string& why) {
  tracers_[k] = nullptr;
  if (warn_) warn_(names_[k] + " is dropped, its work done again by the " + std::to_string(left()) + " left: " + why);
}

// One call of work() by several workers: their shared state, behind one mutex.
class WorkerPool::Run {
 public:
  Run(WorkerPool& pool, std::size_t items, WorkerRates& rates, const Progress& progress, const Do& job)
      : pool_(pool),
        job_(job),
        rates_(rates),
        progress_(progress),
        items_(items),
        queue_(items, rates.of_rest),
        under_way_(pool.size(), 0),
        failures_(pool.size()),
        outside_(progress.stop, [this] { stop_.request_stop(); }) {}

  // Runs until nothing is left to take, or no worker is left. Returns true if work may be left.
  bool run_workers() {
    std::vector<std::jthread> threads;
    threads.reserve(pool_.size());
    try {
      for (std::size_t k = 0; k < pool_.size(); ++k) {
        if (!pool_.worker(k)) continue;
        set_working(+1);
        threads.emplace_back([this, k] { serve(k); });
      }
    } catch (...) {  // no more threads: answer the running ones until they stop
      give_up(std::current_exception());
      set_working(-1);
    }
    answer();
    threads.clear();
    if (thrown_) std::rethrow_exception(thrown_);
    for (std::size_t k = 0; k < failures_.size(); ++k) {
      if (!failures_[k]) continue;
      if (pool_.left() == 1) throw *std::exchange(failures_[k], std::nullopt);
      pool_.drop(k, std::exchange(failures_[k], std::nullopt)->what());
    }
    return !queue_.empty() && !stop_.stop_requested();
  }
  bool finished() const { return queue_.empty() && !cut_; }

 private:
  struct Question {
    const std::function<void()>* what;
    std::exception_ptr thrown;
    bool answered = false;
  };
  struct QuestionThrew {};

  void set_working(int change) {
    const std::lock_guard lock(mutex_);
    working_ += static_cast<std::size_t>(change);
    wake_.notify_all();
  }

  void serve(std::size_t k) {
    try {
      serve_chunks(k);
    } catch (...) {
      give_up(std::current_exception());
    }
    set_working(-1);
  }

  void serve_chunks(std::size_t k) {
    try {
      for (std::optional<Chunk> chunk = next(k); chunk; chunk = next(k)) {
        const auto start = Clock::now();
        const bool done =
            job_(*pool_.worker(k), *chunk, {[&](double part) { note(k, part, *chunk); }, stop_.get_token()},
                 [this](const std::function<void()>& what) { ask(what); });
        finish(k, *chunk, done, seconds_since(start));
      }
    } catch (const QuestionThrew&) {
      stop_.request_stop();
    } catch (const Error& error) {
      fail(k, error);
    }
  }

  std::optional<Chunk> next(std::size_t k) {
    const std::lock_guard lock(mutex_);
    if (queue_.empty() || stop_.stop_requested()) return std::nullopt;
    std::vector<double> rates(pool_.size(), 0);
    std::size_t workers = 0;
    bool known = true;
    for (std::size_t i = 0; i < pool_.size(); ++i) {
      if (!pool_.worker(i) || failures_[i]) continue;
      ++workers;
      rates[i] = rates_.of_workers[i].items_a_second();
      known &= rates[i] > 0;
    }
    if (known) follow_rates(rates_.shares, rates);
    own_chunk_[k] = queue_.take(known ? rates_.shares[k] : 1.0 / static_cast<double>(workers), known);
    return own_chunk_[k];
  }

  void note(std::size_t k, double part, const Chunk& chunk) {
    const std::lock_guard lock(mutex_);
    under_way_[k] = part * static_cast<double>(chunk.size());
    news_ = true;
    wake_.notify_all();
  }

  void finish(std::size_t k, const Chunk& chunk, bool done, double seconds) {
    const std::lock_guard lock(mutex_);
    under_way_[k] = 0;
    if (done) {
      done_ += chunk.size();
      rates_.of_workers[k].learn(chunk.size(), seconds);
    } else {
      cut_ = true;
    }
    news_ = true;
    wake_.notify_all();
  }

  void fail(std::size_t k, const Error& error) {
    if (!of_the_device(error)) return give_up(std::make_exception_ptr(error));
    const std::lock_guard lock(mutex_);
    failures_[k] = error;
    queue_.give_back(own_chunk_[k]);
    under_way_[k] = 0;
  }

  void give_up(std::exception_ptr thrown) {
    const std::lock_guard lock(mutex_);
    if (!thrown_) thrown_ = std::move(thrown);
    stop_.request_stop();
  }

  // Called on a worker's thread.
  void ask(const std::function<void()>& what) {
    Question question{&what, nullptr};
    std::unique_lock lock(mutex_);
    questions_.push_back(&question);
    wake_.notify_all();
    wake_.wait(lock, [&] { return question.answered; });
    if (!question.thrown) return;
    if (!thrown_) thrown_ = question.thrown;
    throw QuestionThrew{};
  }

  // Runs on the caller's thread until all workers are done.
  void answer() {
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [&] { return working_ == 0 || news_ || !questions_.empty(); });
      if (!questions_.empty()) {
        Question& question = *questions_.front();
        questions_.pop_front();
        lock.unlock();
        try {
          (*question.what)();
        } catch (...) {
          question.thrown = std::current_exception();
        }
        lock.lock();
        question.answered = true;
        wake_.notify_all();
      } else if (news_) {
        news_ = false;
        told_ = std::max(told_, std::accumulate(under_way_.begin(), under_way_.end(), static_cast<double>(done_)));
        const double share = told_ / static_cast<double>(items_);
        lock.unlock();
        try {
          progress_(share);
        } catch (...) {
          give_up(std::current_exception());
        }
        lock.lock();
      } else {
        return;
      }
    }
  }

  WorkerPool& pool_;
  const Do& job_;
  WorkerRates& rates_;
  const Progress& progress_;
  std::size_t items_;

  std::mutex mutex_;
  std::condition_variable wake_;
  WorkQueue queue_;
  std::vector<Chunk> own_chunk_ = std::vector<Chunk>(pool_.size());
  std::vector<double> under_way_;  // items in each worker's current chunk
  std::vector<std::optional<Error>> failures_;
  std::deque<Question*> questions_;
  std::exception_ptr thrown_;
  std::size_t working_ = 0, done_ = 0;
  double told_ = 0;
  bool news_ = false, cut_ = false;
  std::stop_source stop_;
  std::stop_callback<std::function<void()>> outside_;
};

bool WorkerPool::work(std::size_t items, WorkerRates& rates, const Progress& progress, const Do& job) {
  rates.of_workers.resize(size());
  if (items == 0) return true;
  if (items == 1 || left() == 1) return work_alone(items, rates, progress, job);
  Run run(*this, items, rates, progress, job);
  while (run.run_workers()) {
  }
  return run.finished();
}

// Works without threads, as one worker does everything.
bool WorkerPool::work_alone(std::size_t items, WorkerRates& rates, const Progress& progress, const Do& job) {
  for (;;) {
    const std::size_t k = fastest(rates);
    try {
      const auto start = Clock::now();
      const bool done = job(*tracers_[k], {0, items}, progress, [](const std::function<void()>& what) { what(); });
      if (done) rates.of_workers[k].learn(items, seconds_since(start));
      return done;
    } catch (const Error& error) {
      if (!of_the_device(error) || left() == 1) throw;
      drop(k, error.what());
    }
  }
}

}  // namespace vantage
