// SPDX-License-Identifier: Apache-2.0
#include "optimise/state_file.hpp"

#include <cmath>
#include <istream>
#include <ostream>

#include "vantage/error.hpp"

namespace vantage::optimise {
namespace {

constexpr std::string_view kMagic = "vantage optimiser\n";
constexpr std::uint64_t kVersion = 7;
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 32;

void append(std::string& bytes, std::uint64_t value) {
  for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<char>(value >> (8 * i)));
}

std::uint64_t parse(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i) value |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
  return value;
}

// FNV-1a, 64 bits.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

[[noreturn]] void malformed(const std::string& why) {
  throw Error(Errc::malformed_file, "optimiser state: " + why + "; start without it, or from an older checkpoint");
}

std::string take(std::istream& in, std::uint64_t count) {
  // In pieces, so that a damaged length does not ask for memory that the file cannot fill.
  constexpr std::uint64_t kPiece = 1 << 20;
  std::string bytes;
  while (bytes.size() < count) {
    const std::size_t begin = bytes.size(), wanted = static_cast<std::size_t>(std::min(kPiece, count - begin));
    bytes.resize(begin + wanted);
    in.read(bytes.data() + begin, static_cast<std::streamsize>(wanted));
    if (static_cast<std::size_t>(in.gcount()) != wanted) malformed("it ends early");
  }
  return bytes;
}

}  // namespace

void StateWriter::put(std::uint64_t value) { append(bytes_, value); }

void StateWriter::put(std::span<const double> values) {
  put(std::uint64_t{values.size()});
  for (const double v : values) put(v);
}

void StateWriter::write(std::ostream& out, std::string_view kind) const {
  std::string whole(kMagic);
  append(whole, kVersion);
  append(whole, kind.size());
  whole += kind;
  append(whole, bytes_.size());
  whole += bytes_;
  append(whole, checksum(whole));
  if (!out.write(whole.data(), static_cast<std::streamsize>(whole.size())))
    throw Error(Errc::io,
                "optimiser state: cannot write " + std::to_string(whole.size()) + " bytes; is the disk full?");
}

StateReader::StateReader(std::istream& in, std::string_view kind) {
  std::string whole = take(in, kMagic.size());
  if (whole != kMagic) malformed("it does not begin as one");
  const auto number = [&] {
    const std::string bytes = take(in, 8);
    whole += bytes;
    return parse(bytes);
  };
  const std::uint64_t version = number();
  if (version != kVersion)
    malformed("its version is " + std::to_string(version) + ", this library reads " + std::to_string(kVersion));
  const std::uint64_t kind_size = number();
  if (kind_size > 64) malformed("its kind is damaged");
  const std::string found = take(in, kind_size);
  whole += found;
  const std::uint64_t size = number();
  if (size > kMaxBytes) malformed("its length is damaged");
  bytes_ = take(in, size);
  whole += bytes_;
  if (parse(take(in, 8)) != checksum(whole)) malformed("its checksum is wrong, it is damaged");
  if (found != kind) malformed("it is of " + found + ", not of " + std::string(kind));
}

std::uint64_t StateReader::integer() {
  if (left() < 8) malformed("it holds too little");
  const std::uint64_t value = parse(std::string_view(bytes_).substr(position_, 8));
  position_ += 8;
  return value;
}

std::size_t StateReader::size(std::size_t limit) {
  const std::uint64_t value = integer();
  if (value >= limit) malformed("a size of " + std::to_string(value) + " is not below " + std::to_string(limit));
  return static_cast<std::size_t>(value);
}

double StateReader::real() { return std::bit_cast<double>(integer()); }

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
  const std::size_t count = size(left() / 8 + 1);
  std::vector<double> values(count);
  for (double& v : values) v = real();
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
  if (position_ != bytes_.size()) malformed("it holds too much");
}

}  // namespace vantage::optimise
