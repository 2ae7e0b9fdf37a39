// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scene/scene_data.hpp"
#include "trace/tracer.hpp"
#include "vantage/scanner.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Outputs of the engine for the requested outputs and for the sums of a scan, which are always computed.
std::uint32_t raw_outputs(const ScanOptions& options);

// Turns an engine's rays into the requested outputs, deriving mesh and colour. Adds to `summary`. `scanner` is the
// station's. `chunk.first_ray` and `chunk.ray_count` are set already; its other arrays are overwritten.
void fill_chunk(ScanChunk& chunk, Tracer::RawChunk& raw, const ScanOptions& options, const SceneData& scene,
                const Scanner& scanner, ScanSummary& summary);

}  // namespace vantage
