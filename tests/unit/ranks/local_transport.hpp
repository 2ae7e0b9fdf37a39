// SPDX-License-Identifier: Apache-2.0
// A job whose ranks are threads of this process.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "ranks/transport.hpp"

namespace vantage::ranks::test {

class LocalTransport final : public Transport {
 public:
  LocalTransport(int rank, const std::vector<std::unique_ptr<LocalTransport>>& all) : rank_(rank), all_(all) {}
  ~LocalTransport() override { close(); }

  int rank() const override { return rank_; }
  int size() const override { return static_cast<int>(all_.size()); }
  void send(int to, Message message) override { all_[static_cast<std::size_t>(to)]->put(rank_, std::move(message)); }
  void deliver_to(Receive receive) override {
    thread_ = std::jthread([this, receive = std::move(receive)](const std::stop_token& stop) {
      for (;;) {
        std::unique_lock lock(mutex_);
        if (!wake_.wait(lock, stop, [&] { return !messages_.empty(); })) return;
        auto [from, message] = std::move(messages_.front());
        messages_.pop_front();
        lock.unlock();
        bytes_ += message.size();
        receive(from, std::move(message));
      }
    });
  }
  // The receiver of messages exists until now.
  void close() { thread_ = {}; }
  std::size_t bytes() const { return bytes_; }  // delivered so far

 private:
  void put(int from, Message message) {
    {
      const std::lock_guard lock(mutex_);
      messages_.emplace_back(from, std::move(message));
    }
    wake_.notify_all();
  }

  int rank_;
  const std::vector<std::unique_ptr<LocalTransport>>& all_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::deque<std::pair<int, Message>> messages_;
  std::size_t bytes_ = 0;
  std::jthread thread_;
};

}  // namespace vantage::ranks::test
