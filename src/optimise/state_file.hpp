// SPDX-License-Identifier: Apache-2.0
// Checkpoints of optimisers: magic, version, kind, length, payload, checksum; little endian, doubles by their bits.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/optimiser.hpp"

namespace vantage::optimise {

// No search gets beyond it that has not diverged, and products of what points are drawn by stay finite.
inline constexpr double kModerate = 1e100;

class StateWriter {
 public:
  void put(std::uint64_t value);
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void put(bool value) { put(std::uint64_t{value}); }
  void put(std::span<const double> values);  // with its length
  // `kind` names the optimiser, so that one is not loaded into another. Throws Error io.
  void write(std::ostream& out, std::string_view kind) const;

 private:
  std::string bytes_;
};

// Every member throws Error malformed_file where the content is not what it must be.
class StateReader {
 public:
  StateReader(std::istream& in, std::string_view kind);
  std::uint64_t integer();
  // An integer below `limit`.
  std::size_t size(std::size_t limit);
  double real();
  double finite();
  double positive();  // and moderate
  bool flag() { return size(2) == 1; }
  StopReason stop_reason() {
    return static_cast<StopReason>(size(static_cast<std::size_t>(StopReason::cancelled) + 1));
  }
  std::vector<double> reals();
  std::vector<double> reals(std::size_t count);  // exactly so many
  std::vector<double> finite_reals(std::size_t count);
  // What points are drawn by: within ±kModerate.
  std::vector<double> moderate_reals(std::size_t count);
  // The next integer or real must equal `value`, else the state belongs to another set-up; `what` names it.
  void expect(std::uint64_t value, std::string_view what);
  void expect(double value, std::string_view what);
  void expect(std::span<const double> values, std::string_view what);
  std::size_t left() const { return bytes_.size() - position_; }  // bytes
  void end() const;                                               // all read

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

}  // namespace vantage::optimise
