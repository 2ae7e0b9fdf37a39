// SPDX-License-Identifier: Apache-2.0
#include "optimise/state_file.hpp"

#include <cmath>
#include <istream>
#include <ostream>
#include <utility>

#include "vantage/error.hpp"

namespace vantage::optimise {
namespace {

constexpr ArchiveFormat kFormat{"vantage optimiser\n", 8};

std::string message(const std::string& why) {
  return "optimiser state: " + why + "; start without it, or from an older checkpoint";
}
[[noreturn]] void malformed(const std::string& why) { throw Error(Errc::malformed_file, message(why)); }

std::string payload_of(std::istream& in) {
  Unsealed found = unseal(in, kFormat);
  switch (found.state) {
    case Unsealed::State::whole: return std::move(found.payload);
    case Unsealed::State::foreign: malformed("it does not begin as one");
    case Unsealed::State::damaged: malformed("it is damaged");
    case Unsealed::State::other_version:
      malformed("its version is " + std::to_string(found.version) + ", this library reads " +
                std::to_string(kFormat.version));
  }
  malformed("it is damaged");
}

}  // namespace

void StateWriter::write(std::ostream& out, std::string_view kind) const {
  ArchiveWriter payload;
  payload.text(kind);
  const std::string whole = sealed(kFormat, payload.take() + archive_.bytes());
  if (!out.write(whole.data(), static_cast<std::streamsize>(whole.size())))
    throw Error(Errc::io,
                "optimiser state: cannot write " + std::to_string(whole.size()) + " bytes; is the disk full?");
}

StateReader::StateReader(std::istream& in, std::string_view kind)
    : payload_(payload_of(in)), archive_(payload_, Errc::malformed_file, message("it holds too little")) {
  const std::string found = archive_.text();
  if (found != kind) malformed("it is of " + found + ", not of " + std::string(kind));
}

std::size_t StateReader::size(std::size_t limit) {
  const std::uint64_t value = integer();
  if (value >= limit) malformed("a size of " + std::to_string(value) + " is not below " + std::to_string(limit));
  return static_cast<std::size_t>(value);
}

double StateReader::finite() {
  const double value = real();
  if (!std::isfinite(value)) malformed("a number is not finite");
  return value;
}

double StateReader::positive() {
  const double value = finite();
  if (!(value > 0)) malformed("a step of " + std::to_string(value) + " is not positive");
  if (value > kModerate) malformed("a step is out of all proportion");
  return value;
}

std::vector<double> StateReader::reals() {
  std::vector<double> values;
  archive_.array(values);
  return values;
}

std::vector<double> StateReader::reals(std::size_t count) {
  auto values = reals();
  if (values.size() != count)
    malformed(std::to_string(values.size()) + " numbers stand where " + std::to_string(count) + " belong");
  return values;
}

std::vector<double> StateReader::finite_reals(std::size_t count) {
  auto values = reals(count);
  for (const double v : values)
    if (!std::isfinite(v)) malformed("a number is not finite");
  return values;
}

std::vector<double> StateReader::moderate_reals(std::size_t count) {
  auto values = reals(count);
  for (const double v : values)
    if (!(std::abs(v) <= kModerate)) malformed("a number is out of all proportion");
  return values;
}

void StateReader::expect(std::uint64_t value, std::string_view what) {
  const std::uint64_t found = integer();
  if (found != value)
    malformed("its " + std::string(what) + " is " + std::to_string(found) + ", here it is " + std::to_string(value));
}

void StateReader::expect(double value, std::string_view what) {
  const double found = real();
  if (std::bit_cast<std::uint64_t>(found) != std::bit_cast<std::uint64_t>(value))
    malformed("its " + std::string(what) + " is " + std::to_string(found) + ", here it is " + std::to_string(value));
}

void StateReader::expect(std::span<const double> values, std::string_view what) {
  expect(std::uint64_t{values.size()}, "number of " + std::string(what));
  for (const double v : values) expect(v, what);
}

void StateReader::end() const {
  if (!archive_.at_end()) malformed("it holds too much");
}

}  // namespace vantage::optimise
