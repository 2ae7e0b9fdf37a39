// SPDX-License-Identifier: Apache-2.0
// Criteria for an engine's scan to agree with the reference.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "support/reference_tracer.hpp"
#include "trace/tracer.hpp"

namespace vantage::test {

// Closer than this to an edge or a voxel face, rounding may decide differently; one ray in 100 000 is at most.
inline constexpr double undecided_m = 1e-4;
inline double most_undecided(std::size_t rays) { return std::ceil(1e-5 * static_cast<double>(rays)); }

inline constexpr std::uint32_t all_outputs = Tracer::range | Tracer::position | Tracer::normal | Tracer::reflectivity |
                                             Tracer::primitive | Tracer::barycentric | Tracer::voxel;

// Compares ray by ray, as gtest expectations, and counts rays decided by rounding. `chunk` has all outputs.
void compare_with_reference(const SceneData& scene, const std::vector<ReferenceHit>& reference,
                            const Tracer::RawChunk& chunk, std::size_t& undecided);

}  // namespace vantage::test
