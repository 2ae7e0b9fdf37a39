// SPDX-License-Identifier: Apache-2.0
// Message transport between the ranks of a job. Messages from one rank to another arrive whole and in order.
#pragma once

#include <functional>

#include "ranks/wire.hpp"

namespace vantage::ranks {

class Transport {
 public:
  using Receive = std::function<void(int from, Message message)>;

  virtual ~Transport() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  // Callable from any thread; returns at once.
  virtual void send(int to, Message message) = 0;
  // Sets the receiver of arriving messages, called on the transport's own thread. Earlier messages are kept for it.
  // Call once.
  virtual void deliver_to(Receive receive) = 0;
};

}  // namespace vantage::ranks
