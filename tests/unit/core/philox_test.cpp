// SPDX-License-Identifier: Apache-2.0
#include "core/philox.hpp"

#include <gtest/gtest.h>

namespace vantage {
namespace {

// Known answers published with Random123 (Salmon et al. 2011), philox4x32 with 10 rounds.
TEST(Philox, KnownAnswers) {
  EXPECT_EQ(philox4x32(0, {0, 0, 0, 0}),
            (std::array<std::uint32_t, 4>{0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u}));
  EXPECT_EQ(philox4x32(0xffffffffffffffffull, {0xffffffffu, 0xffffffffu, 0xffffffffu, 0xffffffffu}),
            (std::array<std::uint32_t, 4>{0x408f276du, 0x41c83b0eu, 0xa20bc7c6u, 0x6d5451fdu}));
}

TEST(RandomStream, SeeksToTheSameNumbers) {
  RandomStream a(7, 3);
  for (int i = 0; i < 5; ++i) a.uniform();
  RandomStream b(7, 3);
  b.seek(a.count());
  for (int i = 0; i < 9; ++i) EXPECT_EQ(a.bits(), b.bits());
}

}  // namespace
}  // namespace vantage
