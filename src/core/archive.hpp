// SPDX-License-Identifier: Apache-2.0
// Values as bytes and back, for states of optimisers, checkpoints, and messages between ranks. Values keep the
// machine's byte order. Writer and reader have the same calls, so one function template over both passes a struct's
// members, and reading matches writing.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "vantage/error.hpp"

namespace vantage {

template <class T>
concept PlainBytes = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

class ArchiveWriter {
 public:
  template <PlainBytes T>
  void raw(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  // Seven bits per byte, lowest first, since most counts are small.
  void whole(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_.push_back(static_cast<char>(value | 0x80));
    bytes_.push_back(static_cast<char>(value));
  }
  template <PlainBytes T>
  void array(std::span<const T> values) {
    whole(values.size());
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }
  template <PlainBytes T>
  void array(const std::vector<T>& values) {
    array(std::span<const T>(values));
  }
  void wholes(const std::vector<std::uint64_t>& values) {
    list(values, 1, [this](std::uint64_t value) { whole(value); });
  }
  void text(std::string_view value) { array(std::span<const char>(value)); }
  // `each` writes one value; see the reader's list() for `least_bytes`.
  template <class T, class Each>
  void list(const std::vector<T>& values, [[maybe_unused]] std::size_t least_bytes, Each each) {
    whole(values.size());
    for (const T& value : values) each(value);
  }
  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::exchange(bytes_, {}); }

 private:
  std::string bytes_;
};

// Throws `Error(code, message)`, both given to the constructor, if bytes are missing or cannot be right. Never
// allocates more than the remaining bytes can hold.
class ArchiveReader {
 public:
  // Borrows the bytes.
  ArchiveReader(std::string_view bytes, Errc code, std::string message)
      : left_(bytes), code_(code), message_(std::move(message)) {}

  template <PlainBytes T>
  void raw(T& value) {
    std::memcpy(&value, next(sizeof value), sizeof value);
  }
  void raw(bool& value) {
    const auto byte = static_cast<unsigned char>(*next(1));
    if (byte > 1) fail();
    value = byte == 1;
  }
  template <PlainBytes T>
  T raw() {
    T value;
    raw(value);
    return value;
  }
  template <std::integral Number>
  void whole(Number& value) {
    value = static_cast<Number>(whole());
  }
  std::uint64_t whole() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      const auto byte = static_cast<unsigned char>(*next(1));
      value |= std::uint64_t{byte & 0x7Fu} << shift;
      if (byte < 0x80) return value;
    }
    fail();
  }
  template <PlainBytes T>
  void array(std::vector<T>& values) {
    values.resize(size(sizeof(T)));
    if (!values.empty()) std::memcpy(values.data(), next(values.size() * sizeof(T)), values.size() * sizeof(T));
  }
  void wholes(std::vector<std::uint64_t>& values) {
    list(values, 1, [this](std::uint64_t& value) { value = whole(); });
  }
  void text(std::string& value) {
    const std::size_t bytes = size(1);
    value.assign(next(bytes), bytes);
  }
  std::string text() {
    std::string value;
    text(value);
    return value;
  }
  // `each` reads one value of at least `least_bytes`.
  template <class T, class Each>
  void list(std::vector<T>& values, std::size_t least_bytes, Each each) {
    values.resize(size(least_bytes));
    for (T& value : values) each(value);
  }
  // Returns the length of a list whose elements take at least `least_bytes` each.
  std::size_t size(std::size_t least_bytes) {
    const std::uint64_t many = whole();
    if (many > left_.size() / least_bytes) fail();
    return static_cast<std::size_t>(many);
  }
  bool at_end() const { return left_.empty(); }
  [[noreturn]] void fail() const { throw Error(code_, message_); }

 private:
  const char* next(std::size_t bytes) {
    if (bytes > left_.size()) fail();
    const char* const data = left_.data();
    left_.remove_prefix(bytes);
    return data;
  }

  std::string_view left_;
  Errc code_;
  std::string message_;
};

// Format of a sealed file: magic, version, length, payload, and a checksum (CRC-32C) over all of it, so that any
// changed bit is detected.
struct ArchiveFormat {
  std::string_view magic;
  std::uint32_t version;
};
std::string sealed(const ArchiveFormat& format, std::string_view payload);

struct Unsealed {
  enum class State { whole, foreign, other_version, damaged } state = State::foreign;
  std::uint32_t version = 0;  // as found; 0: foreign
  std::string payload = {};   // if whole
};
// Reads the result of sealed(), and nothing after it.
Unsealed unseal(std::istream& in, const ArchiveFormat& format);

}  // namespace vantage
