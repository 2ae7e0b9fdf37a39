// SPDX-License-Identifier: Apache-2.0
#include "cli/console.hpp"

#include <gtest/gtest.h>

namespace vantage::cli {
namespace {

// A name may clear the screen, change the title, or make a file look like another.
TEST(Console, NamesDoNotReachTheTerminalAsOrders) {
  EXPECT_EQ(printable("\x1b]0;owned\x07\x1b[2J\r\b"), "\\u001b]0;owned\\u0007\\u001b[2J\\u000d\\u0008");
  EXPECT_EQ(printable("a\x7f\xc2\x9b"), "a\\u007f\\u009b");
  EXPECT_EQ(printable("a\u202egnp\u2066b\u2069"), "a\\u202egnp\\u2066b\\u2069");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\u0000");
}

TEST(Console, TextStaysAsItIs) {
  for (const std::string text :
       {"", "line\n\tnext", "Tür – 5 m² …", "\u202f\u2065\u206a\u00a0", "\xff\xc2", "\xe2\x80"})
    EXPECT_EQ(printable(text), text);
}

}  // namespace
}  // namespace vantage::cli
