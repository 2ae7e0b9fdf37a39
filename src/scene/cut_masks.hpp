// SPDX-License-Identifier: Apache-2.0
// Cuts the holes of masked textures out of triangles, so that later stages meet only opaque surfaces.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/load_budget.hpp"
#include "scene/raw_scene.hpp"

namespace vantage {

// Widest texel on a surface, in metres, at which a mask is cut: about a beam's footprint some metres away.
constexpr double kMaskTexel_m = 0.01;
// Most triangles that replace masked ones; a coarser mask is cut if there would be more.
constexpr std::size_t kMostMaskTriangles = std::size_t{1} << 22;

// Replaces each triangle of a masked material by the parts of it on which alpha reaches the material's cut-off.
// `cutoffs` has one for each of raw.materials, 0 for opaque ones. Alpha combines texture, base colour and vertex
// colours. The texture is averaged until its texels are at most `texel_m`, and more than half of that, wide on the
// surface. The cut-off of each average keeps the filled share of the full texture; alpha is linear between texels. New
// vertices get interpolated attributes. A note says what was cut, or left opaque because it does not fit into `budget`.
// REQUIRES: lengths in metres.
void cut_masks(RawScene& raw, const std::vector<double>& cutoffs, const LoadBudget& budget,
               double texel_m = kMaskTexel_m, std::size_t most_triangles = kMostMaskTriangles);

}  // namespace vantage
