// SPDX-License-Identifier: Apache-2.0
// Letters between the ranks of a job. Those of one rank to another arrive whole and in the order in which they were
// sent.
#pragma once

#include <functional>

#include "ranks/wire.hpp"

namespace vantage::ranks {

class Post {
 public:
  using Receive = std::function<void(int from, Letter letter)>;

  virtual ~Post() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  // From any thread; returns at once.
  virtual void send(int to, Letter letter) = 0;
  // Who is handed each letter that arrives, on a thread of the post's own. Those that came before are kept. Called
  // once.
  virtual void deliver_to(Receive receive) = 0;
};

}  // namespace vantage::ranks
