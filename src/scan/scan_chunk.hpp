// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene_data.hpp"
#include "trace/tracer.hpp"
#include "vantage/scanner.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Returns the engine's outputs for the requested outputs and for the sums of a scan, which are always computed.
std::uint32_t raw_outputs(const ScanOptions& options);

// Turns an engine's rays into the requested outputs, deriving mesh and colour. Adds to `summary`. `scanner` is the
// station's. `ghost`: per ray, 1 for a ghost; `returns`: the number of the ray's returns. The rays and the number of
// the return are set in `chunk` already; its arrays are overwritten.
void fill_chunk(ScanChunk& chunk, Tracer::RawChunk& raw, const std::vector<std::uint8_t>& ghost,
                const std::vector<std::uint8_t>& returns, const ScanOptions& options, const SceneData& scene,
                const Scanner& scanner, ScanSummary& summary);

}  // namespace vantage
