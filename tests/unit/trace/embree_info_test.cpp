// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>

#include "trace/embree/embree_tracer.hpp"

namespace vantage {
namespace {

// Anyone comparing results must see that another instruction set was forced.
TEST(EmbreeInfo, TellsOfAForcedInstructionSet) {
  const char* const before = std::getenv("VANTAGE_EMBREE_ISA");
  const std::string kept = before ? before : "";
  setenv("VANTAGE_EMBREE_ISA", "sse2", 1);
  EXPECT_NE(embree_engine_info().reason.find("held to sse2 by VANTAGE_EMBREE_ISA"), std::string::npos);
  unsetenv("VANTAGE_EMBREE_ISA");
  EXPECT_EQ(embree_engine_info().reason.find("held to"), std::string::npos);
  if (before) setenv("VANTAGE_EMBREE_ISA", kept.c_str(), 1);
}

}  // namespace
}  // namespace vantage
