// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "trace/tracer.hpp"
#include "vantage/scanner.hpp"
#include "vantage/station_setup.hpp"

namespace vantage {

// The direction tables of a scanner, each entry made in double and rounded once. REQUIRES: scanner.check() passes.
RayPattern make_pattern(const Scanner& scanner);

// How the setup turns directions, rounded once; none where it does not.
std::optional<Turn> make_turn(const StationSetup& setup);

}  // namespace vantage
