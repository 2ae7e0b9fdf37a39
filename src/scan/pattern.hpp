// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "trace/tracer.hpp"
#include "vantage/scanner.hpp"
#include "vantage/station_setup.hpp"

namespace vantage {

// Returns a scanner's direction tables, each entry rounded once from double. REQUIRES: scanner.check() passes.
RayPattern make_pattern(const Scanner& scanner);

// Returns the rotation of a setup, rounded once; empty if it does not turn.
std::optional<Turn> make_turn(const StationSetup& setup);

}  // namespace vantage
