// SPDX-License-Identifier: Apache-2.0
// What a rank other than 0 does: counts what it is asked for, until it is sent home.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

#include "ranks/messages.hpp"
#include "ranks/post.hpp"
#include "trace/tracer.hpp"

namespace vantage::ranks {

class Server {
 public:
  // Borrows the post. `on_end`: called on the post's thread when rank 0 ends the job, whatever is under way.
  Server(Post& post, std::string host, std::function<void()> on_end);

  // A tracer that can be asked for; the first is of the scene as it was loaded. Borrowed.
  void offer(Tracer& tracer, const Identity& identity);
  // Makes what is asked for and was not offered, by offering it.
  using More = std::function<void()>;
  // Until the job ends.
  void serve(const More& more);
  // In place of serve(), for want of anything to serve: rank 0 is told why.
  void fail(Errc code, const std::string& why);

 private:
  struct Offered {
    Tracer* tracer;
    Identity identity;
    std::vector<std::uint32_t> sample = {};
    RegistrationJob registration = {};
  };
  void receive(Letter letter);
  bool next(Letter& letter, Head& head);
  void handle(const Head& head, Reader& reader, const More& more);
  Opened open(const Identity& asked, const More& more);
  Letter answer(Kind kind, Offered& offered, Reader& reader, const Progress& progress);
  void send(Kind kind, std::uint64_t serial, const std::function<void(Writer&)>& write);

  Post& post_;
  std::string host_;
  std::function<void()> on_end_;
  std::vector<Offered> offered_;

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Letter> letters_;
  std::uint64_t given_up_ = 0;  // the last question that nobody waits for
  std::uint64_t current_ = 0;
  std::stop_source stop_;  // of the current question
  bool ended_ = false;
};

}  // namespace vantage::ranks
