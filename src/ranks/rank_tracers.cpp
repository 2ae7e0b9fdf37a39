// SPDX-License-Identifier: Apache-2.0
#include "ranks/rank_tracers.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "ranks/remote_tracer.hpp"
#include "trace/spread/spread_tracer.hpp"

namespace vantage::ranks {

Coordinator::Coordinator(std::shared_ptr<Session> session, Tell tell, Tell warn)
    : session_(std::move(session)), tell_(std::move(tell)), warn_(std::move(warn)) {}

std::vector<Opened> Coordinator::open(const Identity& identity) {
  Writer writer;
  pass(writer, identity);
  const Message body = writer.take();
  std::vector<std::uint64_t> asked;
  for (int rank = 1; rank < session_->ranks(); ++rank) asked.push_back(session_->request(rank, Kind::open, body));
  std::vector<Opened> others(asked.size());
  for (std::size_t k = 0; k < others.size(); ++k) {
    const auto answer = session_->answer(static_cast<int>(k) + 1, asked[k], {});
    Reader reader(*answer);
    pass(reader, others[k]);
  }
  return others;
}

// The first simulator is the plan's, and every rank must have it.
void Coordinator::handshake(const std::vector<Opened>& others, const Identity& identity, const EngineInfo& own) {
  shook_hands_ = true;
  std::map<std::string, std::size_t> hosts;
  for (std::size_t k = 0; k < others.size(); ++k) {
    const Opened& other = others[k];
    const std::string name = "rank " + std::to_string(k + 1) + " on " + other.host;
    if (!other.known) throw Error(Errc::invalid_argument, name + ": " + difference(identity, other.own));
    if (other.engine != own.engine)
      warn_(name + " traces with " + to_string(other.engine) + " and rank 0 with " + to_string(own.engine) +
            ": engines differ by rounding at edges, and so may results from run to run");
    ++hosts[other.host + " (" + to_string(other.engine) + ", " + other.device + ")"];
  }
  std::string text;
  for (const auto& [host, many] : hosts) text += (text.empty() ? "" : "; ") + std::to_string(many) + " on " + host;
  tell_(std::to_string(session_->ranks()) + " ranks share the work; beside this one " + text);
}

std::unique_ptr<Tracer> Coordinator::make(std::unique_ptr<Tracer> own, const TraceScene& scene,
                                          std::uint64_t fingerprint) {
  const Identity identity = identity_of(scene, fingerprint);
  const std::vector<Opened> others = open(identity);
  if (!shook_hands_) handshake(others, identity, own->info());
  // A simulator that the others do not make, such as a panorama's, works on this rank alone.
  if (!std::ranges::all_of(others, &Opened::known)) return own;
  std::vector<std::uint64_t> scan_rays;
  for (std::uint32_t k = 0; k < scene.scanners.size(); ++k) scan_rays.push_back(own->preferred_scan_rays(k));
  const EngineInfo info = own->info();
  std::vector<std::unique_ptr<Tracer>> all;
  all.push_back(std::move(own));
  for (std::size_t k = 0; k < others.size(); ++k) {
    EngineInfo there = info;
    there.engine = others[k].engine, there.device = others[k].device + " on " + others[k].host;
    all.push_back(
        std::make_unique<RemoteTracer>(session_, static_cast<int>(k) + 1, others[k].tracer, there, scan_rays));
  }
  // Output does not mention the helpers, so it is the same for any number of ranks.
  return std::make_unique<SpreadTracer>(std::move(all), scene, warn_, SpreadTracer::Options{.info = info});
}

std::unique_ptr<Tracer> Worker::make(std::unique_ptr<Tracer> own, const TraceScene& scene, std::uint64_t fingerprint) {
  server_.offer(*own, identity_of(scene, fingerprint));
  return own;
}

}  // namespace vantage::ranks
