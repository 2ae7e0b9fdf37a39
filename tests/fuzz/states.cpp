// SPDX-License-Identifier: Apache-2.0
// Files that the program keeps for itself. Valid checksums are made, to reach the code behind them.
#include <cmath>
#include <memory>
#include <sstream>
#include <vector>

#include "core/archive.hpp"
#include "core/read_file.hpp"
#include "fuzz/target.hpp"
#include "search/checkpoint.hpp"
#include "vantage/optimiser.hpp"

namespace vantage::fuzz {
namespace {

std::unique_ptr<Optimiser> small_optimiser(std::size_t kind) {
  const OptimiserConfig config{
      .population = 6, .bounds = Bounds{{0, 0, 0, 0}, {1, 1, 1, 1}}, .blocks = {{0, 1}, {2, 3}}};
  if (kind == 0) return std::make_unique<CmaEs>(4, config);
  return std::make_unique<MoCmaEs>(4, 2, config);
}

std::string saved(const Optimiser& optimiser) {
  std::ostringstream out;
  optimiser.save(out);
  return std::move(out).str();
}

constexpr ArchiveFormat state_format{"vantage optimiser\n", 8}, checkpoint_format{"vantage checkpoint\n", 5};

// The content of a seal.
std::string payload_of(const std::string& whole, const ArchiveFormat& format) {
  std::istringstream in(whole);
  const Unsealed found = unseal(in, format);
  require(found.state == Unsealed::State::whole, "what is saved has the seal that is known here");
  return found.payload;
}

// Runs that many rounds of ask and tell.
void go_on(Optimiser& optimiser, int rounds) {
  for (int round = 0; round < rounds && optimiser.stop_reason() == StopReason::running; ++round) {
    const auto xs = optimiser.ask();
    for (const double x : xs) require(x >= 0 && x <= 1, "points keep their bounds");
    std::vector<double> values;
    for (std::size_t k = 0; k < xs.size() / 4 * optimiser.objectives(); ++k)
      values.push_back(0.25 + 0.5 * std::abs(std::sin(static_cast<double>(k) + xs[4 * (k / optimiser.objectives())])));
    optimiser.tell(values);
  }
}

void load_and_go_on(std::size_t kind, const std::string& bytes) {
  const auto optimiser = small_optimiser(kind);
  std::istringstream in(bytes);
  if (!accepts([&] { optimiser->load(in); })) return;
  // An accepted state must be usable.
  go_on(*optimiser, 2);
  const std::string again = saved(*optimiser);
  std::istringstream back(again);
  require(accepts([&] { small_optimiser(kind)->load(back); }), "what is saved can be loaded");
}

std::string checkpoint_file(const Checkpoint& checkpoint) {
  const auto file = file_of({}, "made.bin");
  write_checkpoint(file, checkpoint);
  return read_file(file);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> state_seeds() {
  static constexpr const char* names[] = {"cma_es", "mo_cma_es"};
  std::vector<std::pair<std::string, std::string>> seeds;
  Checkpoint checkpoint;
  checkpoint.identity = "seed = 1\nstations = 2\n";
  checkpoint.seconds = 1.5, checkpoint.trace_seconds = 0.5;
  for (std::size_t kind = 0; kind < std::size(names); ++kind) {
    const auto optimiser = small_optimiser(kind);
    go_on(*optimiser, 2);
    const std::string state = saved(*optimiser);
    seeds.emplace_back(std::string("optimiser_state/") + names[kind],
                       static_cast<char>(kind) + payload_of(state, state_format));
    if (kind == 1) checkpoint.snapshot.optimiser = state;
  }
  checkpoint.snapshot.drawn = 12, checkpoint.snapshot.redrawn = 1;
  checkpoint.snapshot.history = {{1, 6, 0.25, {{0.5, 0.25}}, 0.5}, {2, 12, 0.5, {{0.5, 0.125}, {0.25, 0.75}}, 1}};
  checkpoint.since = {{0.5, 0.25, 3}, {0.75, 0.125, 4}};
  seeds.emplace_back("checkpoint/search", payload_of(checkpoint_file(checkpoint), checkpoint_format));
  for (const auto& seed : message_seeds()) seeds.push_back(seed);
  return seeds;
}

void checkpoint(Bytes bytes) {
  accepts([&] { parse_checkpoint(text_of(bytes), "checkpoint.bin"); });
  const std::string whole = sealed(checkpoint_format, text_of(bytes));
  accepts([&] {
    const Checkpoint found = parse_checkpoint(whole, "checkpoint.bin");
    const auto file = file_of({}, "again.bin");
    write_checkpoint(file, found);
    require(accepts([&] { read_checkpoint(file); }), "what is written can be read");
  });
}

// The first byte chooses the optimiser, and tells if the bytes are a whole file or its sealed content.
void optimiser_state(Bytes bytes) {
  if (bytes.empty()) return;
  const std::size_t kind = bytes[0] % 2;
  const Bytes rest = bytes.subspan(1);
  if (bytes[0] & 4) return load_and_go_on(kind, text_of(rest));
  load_and_go_on(kind, sealed(state_format, text_of(rest)));
}

}  // namespace vantage::fuzz
