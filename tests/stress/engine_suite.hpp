// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "support/engines.hpp"

namespace vantage::test {

class EngineSuite : public testing::TestWithParam<EngineInfo> {};

}  // namespace vantage::test

#define VANTAGE_EVERY_ENGINE(suite)                                                              \
  INSTANTIATE_TEST_SUITE_P(Engines, suite, testing::ValuesIn(::vantage::test::usable_engines()), \
                           [](const auto& instance) { return ::vantage::test::name_of(instance.param); })
