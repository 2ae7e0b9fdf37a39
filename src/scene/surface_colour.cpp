// SPDX-License-Identifier: Apache-2.0
#include "scene/surface_colour.hpp"

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

// The two texels around x, and the position of x between them. x is in texels, with whole numbers at their centres.
struct Texels {
  std::uint32_t first, second;
  float share;
};

Texels texels_at(float coordinate, std::uint32_t size, bool repeat) {
  if (!std::isfinite(coordinate)) return {0, 0, 0};
  const double extent = size;
  double x = static_cast<double>(coordinate);
  x = (repeat ? x - std::floor(x) : std::clamp(x, 0.0, 1.0)) * extent - 0.5;
  const double low = std::floor(x);
  const auto place = [&](double texel) {
    if (texel < 0) return repeat ? size - 1 : 0u;
    if (texel >= extent) return repeat ? 0u : size - 1;
    return static_cast<std::uint32_t>(texel);
  };
  return {place(low), place(low + 1), static_cast<float>(x - low)};
}

LinearColour texel(const Image& image, std::uint32_t x, std::uint32_t y) {
  const std::uint8_t* p = image.rgba.data() + (std::size_t{y} * image.width + x) * 4;
  return {linear_from_srgb8(p[0]), linear_from_srgb8(p[1]), linear_from_srgb8(p[2]), static_cast<float>(p[3]) / 255.0f};
}

// Unlike GLM's mix, returns the common value exactly if both ends agree.
LinearColour between(const LinearColour& a, const LinearColour& b, float share) { return a + (b - a) * share; }

LinearColour vertex_colour(std::uint32_t packed) {
  LinearColour c;
  for (int i = 0; i < 4; ++i) c[i] = static_cast<float>(packed >> (8 * i) & 255u) / 255.0f;
  return c;
}

}  // namespace

LinearColour material_colour(const SceneData& scene, const Material& material, const Float2& texcoord) {
  const LinearColour colour = glm::make_vec4(material.base_colour.data());
  if (material.image < 0) return colour;
  const Image& image = scene.images[static_cast<std::size_t>(material.image)];
  if (image.width == 0 || image.height == 0) return colour;
  const Texels u = texels_at(texcoord.x, image.width, material.repeat_u),
               v = texels_at(texcoord.y, image.height, material.repeat_v);
  const LinearColour texture =
      between(between(texel(image, u.first, v.first), texel(image, u.second, v.first), u.share),
              between(texel(image, u.first, v.second), texel(image, u.second, v.second), u.share), v.share);
  return colour * texture;
}

std::uint32_t surface_colour(const SceneData& scene, std::uint32_t mesh, std::uint32_t triangle,
                             const Float2& barycentric) {
  const Triangle corners = scene.attributes(triangle);
  const float weights[3] = {1 - barycentric.x - barycentric.y, barycentric.x, barycentric.y};
  Float2 texcoord;
  if (!scene.texcoords.empty()) {
    for (int c = 0; c < 3; ++c) {
      texcoord.x += weights[c] * scene.texcoords[corners[c]].x;
      texcoord.y += weights[c] * scene.texcoords[corners[c]].y;
    }
  }
  LinearColour colour = material_colour(scene, scene.materials[scene.ranges[mesh].material], texcoord);
  if (!scene.colours.empty()) {
    LinearColour vertex(0);
    for (int c = 0; c < 3; ++c) vertex += weights[c] * vertex_colour(scene.colours[corners[c]]);
    colour *= vertex;
  }
  return pack_srgb(colour);
}

}  // namespace vantage
