// SPDX-License-Identifier: Apache-2.0
// Requests of rank 0 to the other ranks, and their answers. Thread-safe; each rank has at most one open request.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ranks/messages.hpp"
#include "ranks/transport.hpp"
#include "vantage/progress.hpp"

namespace vantage::ranks {

// Bodies are messages without heads, which are added here.
class Session {
 public:
  // Borrows the transport.
  explicit Session(Transport& transport);

  int ranks() const { return transport_.size(); }
  // Sends a message without an answer.
  void send(int rank, Kind kind, const Message& body);
  // Sends a request and returns its number, for `answer`.
  std::uint64_t request(int rank, Kind kind, const Message& body);
  // Waits for an answer. Empty if stopped, which abandons the request. Throws, as Error, what the other rank threw, and
  // its failure before it served.
  std::optional<Message> answer(int rank, std::uint64_t serial, const Progress& progress);
  // Ends all other ranks.
  void end();

  // Returns the sample as a copy shared by all that remember having sent it.
  using Sample = std::shared_ptr<const std::vector<std::uint32_t>>;
  Sample kept(std::span<const std::uint32_t> sample);

 private:
  struct Inbox {
    std::mutex mutex;
    std::condition_variable wake;
    std::deque<Message> messages;
    std::uint64_t serial = 0;  // number of the last request
  };
  void receive(int from, Message message);

  Transport& transport_;
  std::vector<std::unique_ptr<Inbox>> inboxes_;  // by rank; that of rank 0 stays empty
  std::mutex sample_mutex_;
  Sample sample_;
};

}  // namespace vantage::ranks
