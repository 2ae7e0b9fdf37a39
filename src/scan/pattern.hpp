// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "trace/tracer.hpp"
#include "vantage/scanner.hpp"

namespace vantage {

// The direction tables of a scanner, each entry made in double and rounded once. REQUIRES: scanner.check() passes.
RayPattern make_pattern(const Scanner& scanner);

}  // namespace vantage
