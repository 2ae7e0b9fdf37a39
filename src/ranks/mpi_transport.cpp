// SPDX-License-Identifier: Apache-2.0
// The only file that uses MPI. One thread makes all calls, so the library needs no locks of its own. It polls for
// messages with growing pauses, since a blocking receive would keep a core busy.
#include "ranks/mpi_transport.hpp"

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <future>
#include <list>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace vantage::ranks {
namespace {

// MPI counts bytes in an int, so a long message travels in parts; the tag marks the last one.
constexpr std::size_t kLargestPart = std::size_t{1} << 30;
constexpr int kTagLast = 0, kTagMore = 1;

constexpr std::chrono::microseconds kShortestPause{10}, kLongestPause{200};

class Joined final : public MpiTransport {
 public:
  Joined() : thread_([this] { work(); }) { std::tie(rank_, size_) = joined_.get_future().get(); }
  ~Joined() override {
    {
      const std::lock_guard lock(mutex_);
      leaving_ = true;
    }
    wake_.notify_all();
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void send(int to, Message message) override {
    {
      const std::lock_guard lock(mutex_);
      outgoing_.emplace_back(to, std::move(message));
    }
    wake_.notify_all();
  }

  void deliver_to(Receive receive) override {
    {
      const std::lock_guard lock(mutex_);
      receive_ = std::move(receive);
    }
    wake_.notify_all();
  }

  void leave(int exit_code) override {
    {
      const std::lock_guard lock(mutex_);
      leaving_ = true, exit_code_ = exit_code;
    }
    wake_.notify_all();
  }

 private:
  struct Sending {
    Message message;
    std::vector<MPI_Request> parts;
  };

  void work() {
    int given = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
    int rank = 0, size = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    partial_.resize(static_cast<std::size_t>(size));
    joined_.set_value({rank, size});
    for (auto pause = kShortestPause;;) {
      const bool sent = send_waiting();
      const bool received = receive_one();
      deliver_all();
      std::unique_lock lock(mutex_);
      if (leaving_ && outgoing_.empty() && sending_.empty()) break;
      if (sent || received) {
        pause = kShortestPause;
        continue;
      }
      wake_.wait_for(lock, pause, [&] { return !outgoing_.empty() || (receive_ && !arrived_.empty()); });
      pause = std::min(2 * pause, kLongestPause);
    }
    MPI_Finalize();
    // The rest of the process may have work under way, but nobody waits for it.
    if (exit_code_) std::_Exit(*exit_code_);
  }

  bool send_waiting() {
    std::deque<std::pair<int, Message>> messages;
    {
      const std::lock_guard lock(mutex_);
      messages.swap(outgoing_);
    }
    for (auto& [to, message] : messages) {
      Sending& sending = sending_.emplace_back();
      sending.message = std::move(message);
      const std::size_t bytes = sending.message.size();
      std::size_t at = 0;
      do {
        const std::size_t part = std::min(kLargestPart, bytes - at);
        MPI_Isend(sending.message.data() + at, static_cast<int>(part), MPI_BYTE, to,
                  at + part < bytes ? kTagMore : kTagLast, MPI_COMM_WORLD, &sending.parts.emplace_back());
        at += part;
      } while (at < bytes);
    }
    sending_.remove_if([](Sending& sending) {
      int done = 0;
      MPI_Testall(static_cast<int>(sending.parts.size()), sending.parts.data(), &done, MPI_STATUSES_IGNORE);
      return done != 0;
    });
    return !messages.empty();
  }

  bool receive_one() {
    int there = 0;
    MPI_Message probed = MPI_MESSAGE_NULL;
    MPI_Status status;
    MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &probed, &status);
    if (!there) return false;
    int bytes = 0;
    MPI_Get_count(&status, MPI_BYTE, &bytes);
    Message& message = partial_[static_cast<std::size_t>(status.MPI_SOURCE)];
    const std::size_t before = message.size();
    message.resize(before + static_cast<std::size_t>(bytes));
    MPI_Mrecv(message.data() + before, bytes, MPI_BYTE, &probed, MPI_STATUS_IGNORE);
    if (status.MPI_TAG == kTagLast) arrived_.emplace_back(status.MPI_SOURCE, std::exchange(message, {}));
    return true;
  }

  void deliver_all() {
    {
      const std::lock_guard lock(mutex_);
      if (!receive_) return;
    }
    for (; !arrived_.empty(); arrived_.pop_front())
      receive_(arrived_.front().first, std::move(arrived_.front().second));
  }

  std::promise<std::pair<int, int>> joined_;
  int rank_ = 0, size_ = 1;

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::pair<int, Message>> outgoing_;
  Receive receive_;
  bool leaving_ = false;
  std::optional<int> exit_code_;

  // Used only by the thread.
  std::list<Sending> sending_;
  std::vector<Message> partial_;
  std::deque<std::pair<int, Message>> arrived_;

  std::jthread thread_;  // last member: everything above outlives it
};

}  // namespace

// Reads the environment, since a program that joins alone would start a server beside itself and wait for it.
bool started_as_job() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"})
    if (std::getenv(name)) return true;
  return false;
}

std::unique_ptr<MpiTransport> join_job() { return std::make_unique<Joined>(); }

}  // namespace vantage::ranks
