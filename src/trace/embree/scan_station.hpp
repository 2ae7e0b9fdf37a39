// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "trace/embree/station_rays.hpp"

namespace vantage {

// Tracer::scan on the CPU.
void scan_station(const StationRays& scanner, const TraceStation& station, std::uint64_t first_ray,
                  std::uint64_t ray_count, std::uint32_t outputs, Tracer::RawChunk& chunk);

}  // namespace vantage
