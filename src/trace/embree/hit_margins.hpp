// SPDX-License-Identifier: Apache-2.0
// Margins of distances that SampledVoxelCounter computes in float, so that it leaves out only what is certain.
#pragma once

#include "trace/embree/seen_triangle.hpp"

namespace vantage {

// Bound on the relative error of any distance computed in float, on any tested plane at any slant.
inline constexpr double kTrust = 0x1p-7;
// Below this cosine, over slenderness, the plane may not determine the point's distance (see Planes).
inline constexpr float kGrazing = 0x1p-10f;
// A head may be higher above a plane than this share of the distance, over slenderness. A more grazing ray then meets
// the plane well beyond the voxel, whatever the rounding.
inline constexpr float kSureHeight = 1.5f * kGrazing;
// Error of distances to planes in float, as a share of the farthest distance, over the cosine; the true error is less.
// Embree's allowance is at least eight times as large, so its margin is 1.5 times.
inline constexpr float kFloatDoubt = 0x1p-21f;
inline constexpr auto kEdgeDoubt = static_cast<float>(SeenTriangle::kEdgeDoubt * 1.5);
// Embree's distance has a relative error of some 2^−19 · slenderness / cosine, since slivers give inaccurate normals.
// If cosine / slenderness is above `kSteep`, that error is less than `kSteepPart` allows for.
inline constexpr float kSteep = 0x1p-5f, kSteepPart = 1 - 0x1.8p-13f;

}  // namespace vantage
