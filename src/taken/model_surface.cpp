// SPDX-License-Identifier: Apache-2.0
#include "taken/model_surface.hpp"

#include <cmath>

#include "scene/positions.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

ModelSurface::ModelSurface(const Scene& scene)
    : scene_(scene), origin_(to_glm(scene.data().origin)), tree_(scene.data(), scene.data().opaque_count()) {}

glm::dvec3 ModelSurface::corner(std::uint32_t triangle, std::size_t k) const {
  return to_glm(scene_.data().corners(triangle)[k]);
}

glm::dvec3 ModelSurface::normal(std::uint32_t triangle) const {
  const glm::dvec3 a = corner(triangle, 0);
  return normalize(cross(corner(triangle, 1) - a, corner(triangle, 2) - a));
}

bool ModelSurface::Near::inside() const {
  constexpr double kRounding = 1e-6;  // of metres, in double on float vertices
  return distance - std::abs(height) <= kRounding;
}

std::optional<ModelSurface::Near> ModelSurface::nearest(const glm::dvec3& point, double limit) const {
  const glm::dvec3 local = point - origin_;
  const auto hit = tree_.nearest(local, limit);
  if (!hit) return std::nullopt;
  const glm::dvec3 n = normal(hit->triangle);
  return Near{scene_.data().mesh_of(hit->triangle), hit->distance, dot(local - corner(hit->triangle, 0), n), n};
}

std::optional<ModelSurface::Met> ModelSurface::first(const glm::dvec3& from, const glm::dvec3& way) const {
  const auto hit = tree_.first(from - origin_, way);
  if (!hit) return std::nullopt;
  return Met{scene_.data().mesh_of(hit->triangle), hit->distance, normal(hit->triangle)};
}

bool ModelSurface::passes(const glm::dvec3& a, const glm::dvec3& b) const {
  return !tree_.between(a - origin_, b - origin_);
}

}  // namespace vantage
