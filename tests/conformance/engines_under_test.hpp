// SPDX-License-Identifier: Apache-2.0
// Engines under test: every engine known to make_tracer on every device that it can use, several devices together, and
// the engine of this folder.
#pragma once

#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "trace/tracer.hpp"

namespace vantage::test {

struct EngineUnderTest {
  std::string name;  // letters, digits and _ only
  std::function<std::unique_ptr<Tracer>(const TraceScene&)> make;
};
void PrintTo(const EngineUnderTest& engine, std::ostream* out);

std::vector<EngineUnderTest> engines_under_test();

}  // namespace vantage::test
