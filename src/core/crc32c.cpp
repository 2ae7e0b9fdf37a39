// SPDX-License-Identifier: Apache-2.0
// After Kounavis and Berry: A Systematic Approach to Building High Performance Software-based CRC Generators, 2005.
#include "core/crc32c.hpp"

#include <array>
#include <cstring>

namespace vantage {
namespace {

constexpr std::uint32_t kPolynomial = 0x82F63B78;  // bits reversed: the lowest bit is the highest power

// Row k: contribution to the remainder of a byte followed by k more bytes.
constexpr std::array<std::array<std::uint32_t, 256>, 8> remainders() {
  std::array<std::array<std::uint32_t, 256>, 8> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder >> 1) ^ (remainder & 1 ? kPolynomial : 0);
    table[0][byte] = remainder;
  }
  for (std::size_t k = 1; k < 8; ++k)
    for (std::size_t byte = 0; byte < 256; ++byte)
      table[k][byte] = (table[k - 1][byte] >> 8) ^ table[0][table[k - 1][byte] & 255];
  return table;
}
constexpr auto kTable = remainders();

}  // namespace

std::uint32_t crc32c(const void* data, std::size_t bytes) {
  const auto* p = static_cast<const unsigned char*>(data);
  std::uint32_t crc = 0xFFFFFFFF;
  for (; bytes >= 8; bytes -= 8, p += 8) {
    std::uint64_t word;
    std::memcpy(&word, p, sizeof word);
    word ^= crc;
    crc = 0;
    for (std::size_t k = 0; k < 8; ++k) crc ^= kTable[7 - k][(word >> (8 * k)) & 255];
  }
  for (; bytes > 0; --bytes, ++p) crc = (crc >> 8) ^ kTable[0][(crc ^ *p) & 255];
  return ~crc;
}

}  // namespace vantage
