// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "trace/tracer.hpp"
#include "vantage/scanner.hpp"
#include "vantage/station_setup.hpp"

namespace vantage {

// Direction tables of a scanner; each entry is computed in double and rounded once. REQUIRES: scanner.check() passes.
RayPattern make_pattern(const Scanner& scanner);

// Rotation of a setup, rounded once; empty if it does not turn.
std::optional<Turn> make_turn(const StationSetup& setup);

}  // namespace vantage
