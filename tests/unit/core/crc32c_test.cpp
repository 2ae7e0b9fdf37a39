// SPDX-License-Identifier: Apache-2.0
#include "core/crc32c.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

namespace vantage {
namespace {

// The definition, one bit at a time.
std::uint32_t bit_by_bit(const std::vector<std::uint8_t>& bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const std::uint8_t byte : bytes)
    for (int bit = 0; bit < 8; ++bit) {
      const bool one = ((crc ^ (byte >> bit)) & 1) != 0;
      crc = (crc >> 1) ^ (one ? 0x82F63B78u : 0u);
    }
  return ~crc;
}

// RFC 3720 (Internet Small Computer Systems Interface, 2004), appendix B.4, whose values are the bytes as sent, lowest
// first; and the check value in the catalogue of CRC algorithms.
TEST(Crc32c, GivesTheKnownValues) {
  const std::string digits = "123456789";
  EXPECT_EQ(crc32c(digits.data(), digits.size()), 0xE3069283u);
  std::vector<std::uint8_t> bytes(32, 0);
  EXPECT_EQ(crc32c(bytes.data(), bytes.size()), 0x8A9136AAu);
  bytes.assign(32, 0xFF);
  EXPECT_EQ(crc32c(bytes.data(), bytes.size()), 0x62A8AB43u);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  EXPECT_EQ(crc32c(bytes.data(), bytes.size()), 0x46DD794Eu);
  std::reverse(bytes.begin(), bytes.end());
  EXPECT_EQ(crc32c(bytes.data(), bytes.size()), 0x113FDB5Cu);
  EXPECT_EQ(crc32c(nullptr, 0), 0u);
}

TEST(Crc32c, AgreesWithTheRuleAtEveryLength) {
  std::vector<std::uint8_t> bytes;
  for (std::uint32_t k = 0; k < 70; ++k) {
    EXPECT_EQ(crc32c(bytes.data(), bytes.size()), bit_by_bit(bytes)) << k;
    bytes.push_back(static_cast<std::uint8_t>(k * 151 + 17));
  }
}

}  // namespace
}  // namespace vantage
