// SPDX-License-Identifier: Apache-2.0
// States of optimisers: name of the algorithm and its members, as a sealed archive.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/archive.hpp"
#include "vantage/optimiser.hpp"

namespace vantage::optimise {

// Bound on values that points are drawn by: beyond it a search has diverged, and within it products stay finite.
inline constexpr double kModerate = 1e100;

// Like an ArchiveWriter; integers are varints, reals their bits.
class StateWriter {
 public:
  void put(std::uint64_t value) { archive_.whole(value); }
  void put(double value) { archive_.raw(value); }
  void put(bool value) { put(std::uint64_t{value}); }
  void put(std::span<const double> values) { archive_.array(values); }
  // `kind` names the optimiser, so that a state is not loaded into another. Throws Error io.
  void write(std::ostream& out, std::string_view kind) const;

 private:
  ArchiveWriter archive_;
};

// Every member throws Error malformed_file if the content is invalid.
class StateReader {
 public:
  StateReader(std::istream& in, std::string_view kind);
  // The archive refers to the payload.
  StateReader(const StateReader&) = delete;
  StateReader& operator=(const StateReader&) = delete;
  std::uint64_t integer() { return archive_.whole(); }
  // An integer below `limit`.
  std::size_t size(std::size_t limit);
  // Length of a list whose elements take at least `least_bytes` each.
  std::size_t length(std::size_t least_bytes) { return archive_.size(least_bytes); }
  double real() { return archive_.raw<double>(); }
  double finite();
  double positive();  // and within kModerate
  bool flag() { return size(2) == 1; }
  StopReason stop_reason() {
    return static_cast<StopReason>(size(static_cast<std::size_t>(StopReason::cancelled) + 1));
  }
  std::vector<double> reals();
  std::vector<double> reals(std::size_t count);  // exactly `count`
  std::vector<double> finite_reals(std::size_t count);
  // Values that points are drawn by: within ±kModerate.
  std::vector<double> moderate_reals(std::size_t count);
  // The next integer or real must equal `value`; otherwise the state belongs to another set-up. `what` names it.
  void expect(std::uint64_t value, std::string_view what);
  void expect(double value, std::string_view what);
  void expect(std::span<const double> values, std::string_view what);
  void end() const;  // everything was read

 private:
  std::string payload_;
  ArchiveReader archive_;
};

}  // namespace vantage::optimise
