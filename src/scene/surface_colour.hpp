// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "image/srgb.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

// Returns the colour of a material at texture coordinates, linear: base colour times bilinear texture (filtered in
// linear light; the first row of an image is v = 0). White without a texture.
LinearColour material_colour(const SceneData& scene, const Material& material, const Float2& texcoord);

// Returns the colour of a point on a triangle, 0xAABBGGRR in sRGB: material times interpolated vertex colour.
// `barycentric`: weights of the triangle's second and third vertex.
std::uint32_t surface_colour(const SceneData& scene, std::uint32_t mesh, std::uint32_t triangle,
                             const Float2& barycentric);

}  // namespace vantage
