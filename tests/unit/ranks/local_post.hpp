// SPDX-License-Identifier: Apache-2.0
// A job whose ranks are threads of this process.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "ranks/post.hpp"

namespace vantage::ranks::test {

class LocalPost final : public Post {
 public:
  LocalPost(int rank, const std::vector<std::unique_ptr<LocalPost>>& all) : rank_(rank), all_(all) {}
  ~LocalPost() override { close(); }

  int rank() const override { return rank_; }
  int size() const override { return static_cast<int>(all_.size()); }
  void send(int to, Letter letter) override { all_[static_cast<std::size_t>(to)]->put(rank_, std::move(letter)); }
  void deliver_to(Receive receive) override {
    thread_ = std::jthread([this, receive = std::move(receive)](const std::stop_token& stop) {
      for (;;) {
        std::unique_lock lock(mutex_);
        if (!wake_.wait(lock, stop, [&] { return !letters_.empty(); })) return;
        auto [from, letter] = std::move(letters_.front());
        letters_.pop_front();
        lock.unlock();
        bytes_ += letter.size();
        receive(from, std::move(letter));
      }
    });
  }
  // The receiver of messages exists until now.
  void close() { thread_ = {}; }
  std::size_t bytes() const { return bytes_; }  // delivered so far

 private:
  void put(int from, Letter letter) {
    {
      const std::lock_guard lock(mutex_);
      letters_.emplace_back(from, std::move(letter));
    }
    wake_.notify_all();
  }

  int rank_;
  const std::vector<std::unique_ptr<LocalPost>>& all_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::deque<std::pair<int, Letter>> letters_;
  std::size_t bytes_ = 0;
  std::jthread thread_;
};

}  // namespace vantage::ranks::test
