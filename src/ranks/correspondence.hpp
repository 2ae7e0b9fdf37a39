// SPDX-License-Identifier: Apache-2.0
// Rank 0's questions to the others, and their answers. Thread-safe; one question at a time is open with each rank.
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
#include "ranks/post.hpp"
#include "vantage/progress.hpp"

namespace vantage::ranks {

// Bodies are letters without their heads, which are put before them.
class Correspondence {
 public:
  // Borrows the post.
  explicit Correspondence(Post& post);

  int ranks() const { return post_.size(); }
  // What is not answered.
  void tell(int rank, Kind kind, const Letter& body);
  // The number that `answer` waits for.
  std::uint64_t ask(int rank, Kind kind, const Letter& body);
  // Empty where stopped: the question is given up then. Throws what the other rank threw, and its failure before it
  // served, as Error.
  std::optional<Letter> answer(int rank, std::uint64_t serial, const Progress& progress);
  // Ends all other ranks.
  void end();

  // The sample, as one copy for all who remember that they have sent it.
  using Sample = std::shared_ptr<const std::vector<std::uint32_t>>;
  Sample kept(std::span<const std::uint32_t> sample);

 private:
  struct Inbox {
    std::mutex mutex;
    std::condition_variable wake;
    std::deque<Letter> letters;
    std::uint64_t serial = 0;  // given last
  };
  void receive(int from, Letter letter);

  Post& post_;
  std::vector<std::unique_ptr<Inbox>> inboxes_;  // by rank; that of rank 0 stays empty
  std::mutex sample_mutex_;
  Sample sample_;
};

}  // namespace vantage::ranks
