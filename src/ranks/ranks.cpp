// SPDX-License-Identifier: Apache-2.0
#include "ranks/ranks.hpp"

#include <unistd.h>

#include <array>
#include <list>
#include <utility>

#include "ranks/mpi_transport.hpp"
#include "ranks/rank_tracers.hpp"

namespace vantage::ranks {
namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "a host without a name";
}

class Rank0 final : public Ranks {
 public:
  explicit Rank0(std::unique_ptr<MpiTransport> transport)
      : transport_(std::move(transport)), session_(std::make_shared<Session>(*transport_)) {}
  // The transport is destroyed first: until then it may deliver messages.
  ~Rank0() override {
    session_->end();
    transport_.reset();
  }

  bool first() const override { return true; }
  int size() const override { return transport_->size(); }
  std::shared_ptr<TracerMaker> share(std::function<void(const std::string&)> tell,
                                     std::function<void(const std::string&)> warn) override {
    return std::make_shared<Coordinator>(session_, std::move(tell), std::move(warn));
  }
  void serve(const Simulator&) override {}
  void fail(Errc code, const std::string& why) override { throw Error(code, why); }

 private:
  std::unique_ptr<MpiTransport> transport_;
  std::shared_ptr<Session> session_;
};

class Other final : public Ranks {
 public:
  explicit Other(std::unique_ptr<MpiTransport> transport)
      : transport_(std::move(transport)), server_(*transport_, host_name(), [this] { transport_->leave(0); }) {}
  // Waits in any case: rank 0 ends the job, and until then the transport delivers messages.
  ~Other() override { wait(); }

  bool first() const override { return false; }
  int size() const override { return transport_->size(); }
  std::shared_ptr<TracerMaker> share(std::function<void(const std::string&)>,
                                     std::function<void(const std::string&)>) override {
    return std::make_shared<Worker>(server_);
  }
  // Simulators that a plan makes besides its own are made here, too, on request.
  void serve(const Simulator& simulator) override {
    std::list<Simulator> more;
    server_.serve([&] {
      if (more.empty()) more.push_back(surroundings_of(simulator));
    });
    wait();
  }
  void fail(Errc code, const std::string& why) override {
    server_.fail(code, why);
    wait();
  }

 private:
  // Waits for the transport's thread to end the process.
  [[noreturn]] static void wait() {
    for (;;) pause();
  }

  std::unique_ptr<MpiTransport> transport_;
  Server server_;
};

}  // namespace

std::unique_ptr<Ranks> join() {
  if (!started_as_job()) return nullptr;
  std::unique_ptr<MpiTransport> transport = join_job();
  if (transport->size() == 1) return nullptr;
  if (transport->rank() == 0) return std::make_unique<Rank0>(std::move(transport));
  return std::make_unique<Other>(std::move(transport));
}

}  // namespace vantage::ranks
