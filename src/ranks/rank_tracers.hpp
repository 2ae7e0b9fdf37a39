// SPDX-License-Identifier: Apache-2.0
// Tracers over all ranks, as each rank makes them.
#pragma once

#include <functional>
#include <string>

#include "ranks/server.hpp"
#include "ranks/session.hpp"
#include "trace/tracer_maker.hpp"

namespace vantage::ranks {

// On rank 0: its own tracer and one for each other rank; they pull chunks of the work.
class Coordinator final : public TracerMaker {
 public:
  using Tell = std::function<void(const std::string&)>;
  Coordinator(std::shared_ptr<Session> session, Tell tell, Tell warn);

  std::unique_ptr<Tracer> make(std::unique_ptr<Tracer> own, const TraceScene& scene,
                               std::uint64_t fingerprint) override;
  std::size_t networks_at_once() const override { return static_cast<std::size_t>(session_->ranks()); }

 private:
  std::vector<Opened> open(const Identity& identity);
  void handshake(const std::vector<Opened>& others, const Identity& identity, const EngineInfo& own);

  std::shared_ptr<Session> session_;
  Tell tell_, warn_;
  bool shook_hands_ = false;
};

// On other ranks: its own tracer, which serves rank 0.
class Worker final : public TracerMaker {
 public:
  explicit Worker(Server& server) : server_(server) {}

  std::unique_ptr<Tracer> make(std::unique_ptr<Tracer> own, const TraceScene& scene,
                               std::uint64_t fingerprint) override;
  std::size_t networks_at_once() const override { return 1; }

 private:
  Server& server_;
};

}  // namespace vantage::ranks
