// SPDX-License-Identifier: Apache-2.0
#include "scene/load_budget.hpp"

#include <algorithm>
#include <utility>

#include "core/free_memory.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr std::uint64_t kProgram = std::uint64_t{24} << 20;  // memory of the process before loading

}  // namespace

LoadBudget::LoadBudget(std::uint64_t max_memory_bytes, std::string source)
    : limit_(memory_limit(max_memory_bytes)),
      kept_(std::min(kProgram, limit_)),
      given_(max_memory_bytes > 0),
      source_(std::move(source)) {}

void LoadBudget::keep(std::uint64_t bytes, const std::string& what) {
  require(bytes, what);
  kept_ += bytes;
}

void LoadBudget::require(std::uint64_t bytes, const std::string& what) const {
  if (bytes <= left()) return;
  throw Error(Errc::out_of_memory, source_ + ": " + what + " would take about " + bytes_text(bytes) +
                                       " of memory, beside " + bytes_text(kept_) + " that the rest takes; " +
                                       (given_ ? "the limit is " : "half of what is free is ") + bytes_text(limit_) +
                                       ". Make the scene smaller, or allow more memory");
}

}  // namespace vantage
