// SPDX-License-Identifier: Apache-2.0
// Work of a rank other than 0: answers requests until rank 0 ends the job.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

#include "ranks/messages.hpp"
#include "ranks/transport.hpp"
#include "trace/tracer.hpp"

namespace vantage::ranks {

class Server {
 public:
  // Borrows the transport. `on_end`: called on the transport's thread when rank 0 ends the job, whatever is under way.
  Server(Transport& transport, std::string host, std::function<void()> on_end);

  // Adds a tracer that rank 0 may use; the first is of the scene as loaded. Borrowed.
  void offer(Tracer& tracer, const Identity& identity);
  // Called for a tracer that is requested but was not offered; it makes and offers it.
  using More = std::function<void()>;
  // Serves until the job ends. Throws Error device_failure for a message that cannot be rank 0's.
  void serve(const More& more);
  // Replaces serve() if there is nothing to serve: tells rank 0 why.
  void fail(Errc code, const std::string& why);

 private:
  struct Offered {
    Tracer* tracer;
    Identity identity;
    std::vector<std::uint32_t> sample = {};
    RegistrationJob registration = {};
  };
  void receive(Message message);
  bool next(Message& message, Head& head);
  void handle(const Head& head, Reader& reader, const More& more);
  Opened open(const Identity& asked, const More& more);
  Message answer(Kind kind, Offered& offered, Reader& reader, const Progress& progress);
  void send(Kind kind, std::uint64_t serial, const std::function<void(Writer&)>& write);

  Transport& transport_;
  std::string host_;
  std::function<void()> on_end_;
  std::vector<Offered> offered_;

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Message> messages_;
  std::uint64_t given_up_ = 0;  // the last abandoned request
  std::uint64_t current_ = 0;
  std::stop_source stop_;  // of the current request
  bool ended_ = false;
  std::exception_ptr broken_;  // a message that has no head
};

}  // namespace vantage::ranks
