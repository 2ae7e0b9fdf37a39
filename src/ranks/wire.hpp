// SPDX-License-Identifier: Apache-2.0
// Values as bytes and back, between processes of one program on machines of one byte order. A function that passes
// through either serves both ways, so what is written is what is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "vantage/error.hpp"

namespace vantage::ranks {

using Message = std::string;

template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

class Writer {
 public:
  template <Plain T>
  void raw(const T& value) {
    message_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  // Seven bits per byte, lowest first, since most counts are small.
  void whole(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) message_.push_back(static_cast<char>(value | 0x80));
    message_.push_back(static_cast<char>(value));
  }
  template <Plain T>
  void array(const std::vector<T>& values) {
    whole(values.size());
    message_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void wholes(const std::vector<std::uint64_t>& values) {
    whole(values.size());
    for (const std::uint64_t value : values) whole(value);
  }
  void text(std::string_view value) {
    whole(value.size());
    message_.append(value);
  }
  Message take() { return std::move(message_); }

 private:
  Message message_;
};

// Borrows the message. Throws Error device_failure if it is too short.
class Reader {
 public:
  explicit Reader(std::string_view message) : left_(message) {}

  template <Plain T>
  void raw(T& value) {
    std::memcpy(&value, next(sizeof value), sizeof value);
  }
  template <Plain T>
  T raw() {
    T value;
    raw(value);
    return value;
  }
  template <class Number>
  void whole(Number& value) {
    value = static_cast<Number>(whole());
  }
  std::uint64_t whole() {
    std::uint64_t value = 0;
    for (unsigned shift = 0;; shift += 7) {
      const auto byte = static_cast<unsigned char>(*next(1));
      value |= std::uint64_t{byte & 0x7Fu} << shift;
      if (byte < 0x80) return value;
      if (shift > 56) fail();
    }
  }
  template <Plain T>
  void array(std::vector<T>& values) {
    values.resize(size(sizeof(T)));
    if (!values.empty()) std::memcpy(values.data(), next(values.size() * sizeof(T)), values.size() * sizeof(T));
  }
  void wholes(std::vector<std::uint64_t>& values) {
    values.resize(size(1));
    for (std::uint64_t& value : values) value = whole();
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
  // Length of a list whose elements take at least `least_bytes` each; never more than the message can hold.
  std::size_t size(std::size_t least_bytes) {
    const std::uint64_t many = whole();
    if (many > left_.size() / least_bytes) fail();
    return static_cast<std::size_t>(many);
  }

 private:
  const char* next(std::size_t bytes) {
    if (bytes > left_.size()) fail();
    const char* const data = left_.data();
    left_.remove_prefix(bytes);
    return data;
  }
  [[noreturn]] static void fail() { throw Error(Errc::device_failure, "a message from another rank is cut short"); }

  std::string_view left_;
};

}  // namespace vantage::ranks
