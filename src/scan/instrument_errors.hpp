// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "trace/tracer.hpp"
#include "vantage/scanner.hpp"

namespace vantage {

// Moves the points of consecutive rays, and their ranges, as an instrument with these errors would measure them. Other
// data of a point stay those of its ray. REQUIRES: raw.range is filled.
void apply(const InstrumentErrors& errors, const Scanner& scanner, const TraceStation& station, std::uint64_t first_ray,
           Tracer::RawChunk& raw);

}  // namespace vantage
