// SPDX-License-Identifier: Apache-2.0
// Files that the program keeps for itself. What is behind their checksums is reached with checksums made to fit.
#include <cstring>
#include <memory>
#include <sstream>
#include <vector>

#include "core/hash.hpp"
#include "fuzz/target.hpp"
#include "plan/checkpoint.hpp"
#include "vantage/optimiser.hpp"

namespace vantage::fuzz {
namespace {

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::unique_ptr<Optimiser> small_optimiser(std::size_t kind) {
  const OptimiserConfig config{
      .population = 6, .bounds = Bounds{{0, 0, 0, 0}, {1, 1, 1, 1}}, .blocks = {{0, 1}, {2, 3}}};
  switch (kind) {
    case 0: return make_optimiser(Algorithm::cma_es, 4, 1, config);
    case 1: return make_optimiser(Algorithm::mo_cma_es, 4, 2, config);
    case 2: return make_optimiser(Algorithm::nsga2, 4, 2, config);
    default: return make_optimiser(Algorithm::random_search, 4, 2, config);
  }
}

std::string saved(const Optimiser& optimiser) {
  std::ostringstream out;
  optimiser.save(out);
  return std::move(out).str();
}

// The head of a saved state up to the length of its payload, taken from one that the optimiser wrote: magic, version
// (8 bytes), length of the kind (8 bytes), kind.
std::string head_of(const std::string& state) {
  const std::size_t at = std::strlen("vantage optimiser\n") + 8;
  std::uint64_t kind = 0;
  std::memcpy(&kind, state.data() + at, 8);
  return state.substr(0, at + 8 + kind);
}

std::string signed_state(const std::string& head, Bytes payload) {
  std::string whole = head;
  append(whole, std::uint64_t{payload.size()});
  whole.append(payload.begin(), payload.end());
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a, as optimise/state_file.cpp
  for (const char c : whole) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  append(whole, hash);
  return whole;
}

void load_and_go_on(std::size_t kind, const std::string& bytes) {
  const auto optimiser = small_optimiser(kind);
  std::istringstream in(bytes);
  if (!accepts([&] { optimiser->load(in); })) return;
  // A state that was taken must be one to go on from.
  for (int round = 0; round < 2 && optimiser->stop_reason() == StopReason::running; ++round) {
    const auto xs = optimiser->ask();
    for (const double x : xs) require(x >= 0 && x <= 1, "points keep their bounds");
    std::vector<double> values;
    for (std::size_t k = 0; k < xs.size() / 4 * optimiser->objectives(); ++k)
      values.push_back(0.25 + 0.5 * std::abs(std::sin(static_cast<double>(k) + xs[4 * (k / optimiser->objectives())])));
    optimiser->tell(values);
  }
  const std::string again = saved(*optimiser);
  std::istringstream back(again);
  require(accepts([&] { small_optimiser(kind)->load(back); }), "what is saved can be loaded");
}

}  // namespace

void checkpoint(Bytes bytes) {
  accepts([&] { parse_checkpoint(text_of(bytes), "checkpoint.bin"); });
  const std::string body = text_of(bytes);
  Hash hash;
  hash.add_bytes(body.data(), body.size());
  std::string whole = "vantage checkpoint\n";
  append(whole, std::uint32_t{2}), append(whole, std::uint64_t{body.size()}), append(whole, hash.value());
  whole += body;
  accepts([&] {
    const Checkpoint found = parse_checkpoint(whole, "checkpoint.bin");
    const auto file = file_of({}, "again.bin");
    write_checkpoint(file, found);
    require(accepts([&] { read_checkpoint(file); }), "what is written can be read");
  });
}

// The first byte says of which optimiser, and whether the bytes are a whole file or what is behind the head.
void optimiser_state(Bytes bytes) {
  if (bytes.empty()) return;
  const std::size_t kind = bytes[0] % 4;
  const Bytes rest = bytes.subspan(1);
  if (bytes[0] & 4) return load_and_go_on(kind, text_of(rest));
  static const std::string heads[] = {head_of(saved(*small_optimiser(0))), head_of(saved(*small_optimiser(1))),
                                      head_of(saved(*small_optimiser(2))), head_of(saved(*small_optimiser(3)))};
  load_and_go_on(kind, signed_state(heads[kind], rest));
}

}  // namespace vantage::fuzz
