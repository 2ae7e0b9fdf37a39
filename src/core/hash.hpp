// SPDX-License-Identifier: Apache-2.0
// Hash that recognises equal data (multiply and xor-shift): fast, stable between runs, not cryptographic.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace vantage {

class Hash {
 public:
  void add_bytes(const void* data, std::size_t bytes) {
    const auto* p = static_cast<const unsigned char*>(data);
    for (std::size_t left = bytes; left > 0;) {
      std::uint64_t word = 0;
      const std::size_t n = left < 8 ? left : 8;
      std::memcpy(&word, p, n);
      mix(word);
      p += n, left -= n;
    }
    mix(bytes);
  }
  template <class T>
  requires std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>
  void add(const T& value) { add_bytes(&value, sizeof value); }
  // REQUIRES: T without padding.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void add_all(std::span<const T> values) { add_bytes(values.data(), values.size_bytes()); }
  template <class T>
  void add_all(const std::vector<T>& values) {
    add_all(std::span<const T>(values));
  }
  std::uint64_t value() const {
    std::uint64_t h = state_;
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9u;
    h = (h ^ (h >> 27)) * 0x94D049BB133111EBu;
    return h ^ (h >> 31);
  }

 private:
  void mix(std::uint64_t word) {
    state_ = (state_ ^ word) * 0x9E3779B97F4A7C15u;
    state_ ^= state_ >> 32;
  }
  std::uint64_t state_ = 0xCBF29CE484222325u;
};

}  // namespace vantage
