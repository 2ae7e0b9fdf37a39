// SPDX-License-Identifier: Apache-2.0
#include "generate/shapes.hpp"

#include <algorithm>
#include <cmath>

namespace vantage::built_in {
namespace {

constexpr int kMostSides = 4096;

dvec3 rotated(const dvec3& v, const dvec3& axis, double angle) {  // Rodrigues' formula; axis of unit length
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

}  // namespace

void add_rectangle(Mesh& mesh, const dvec3& corner, const dvec3& across, const dvec3& up, int columns, int rows) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const Float3 normal = to_float3(normalize(cross(across, up)));
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      mesh.positions.push_back(
          to_float3(corner + across * (static_cast<double>(i) / columns) + up * (static_cast<double>(j) / rows)));
      mesh.normals.push_back(normal);
    }
  const auto width = static_cast<std::uint32_t>(columns) + 1;
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j)
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
      const std::uint32_t a = first + j * width + i, b = a + 1, c = a + width, d = c + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
    }
}

int Detail::around(double radius) const {
  const int fewest = radius < 0.015 ? 4 : radius < 0.03 ? 5 : radius < 0.2 ? 6 : 10;
  return std::clamp(static_cast<int>(std::ceil(kPi * std::sqrt(radius / (2 * sagitta_m)))), fewest, kMostSides);
}
// Curvature needs no rows; they keep triangles from becoming needles, in proportion to the circles.
int Detail::along(double length) const {
  return std::clamp(static_cast<int>(std::lround(length / (600 * sagitta_m))), 1, 100'000);
}
int Detail::across(double length) const {
  return std::clamp(static_cast<int>(std::lround(length / (1800 * sagitta_m))), 1, 100'000);
}

Frame frame_along(const dvec3& origin, const dvec3& direction) {
  const dvec3 z = normalize(direction);
  const dvec3 y = std::abs(z.z) > 0.999 ? dvec3{0, 1, 0} : normalize(cross({0, 0, 1}, z));
  const dvec3 x = normalize(cross(y, z));
  return {origin, x, cross(z, x), z};
}

Frame turned(const Frame& frame, const dvec3& centre, const dvec3& axis, double angle) {
  return {centre + rotated(frame.origin - centre, axis, angle), rotated(frame.x, axis, angle),
          rotated(frame.y, axis, angle), rotated(frame.z, axis, angle)};
}

void Shaper::skin(std::span<const Ring> rings, int sides) {
  for (std::size_t i = 0; i + 1 < rings.size(); ++i)
    triangles_ += static_cast<std::size_t>(sides) * (rings[i].radius > 0 && rings[i + 1].radius > 0 ? 2 : 1);
  if (counting_) return;
  const auto first = static_cast<std::uint32_t>(mesh_.positions.size()), n = static_cast<std::uint32_t>(sides);
  for (const Ring& ring : rings)
    for (std::uint32_t i = 0; i < n; ++i) {
      const double angle = 2 * kPi * i / n;
      const dvec3 out = ring.frame.x * std::cos(angle) + ring.frame.y * std::sin(angle);
      mesh_.positions.push_back(to_float3(ring.frame.origin + out * ring.radius));
      mesh_.normals.push_back(to_float3(normalize(out * ring.normal_out + ring.frame.z * ring.normal_ahead)));
    }
  for (std::uint32_t j = 0; j + 1 < rings.size(); ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = first + j * n + i, b = first + j * n + (i + 1) % n, c = a + n, d = b + n;
      if (rings[j].radius > 0) mesh_.indices.insert(mesh_.indices.end(), {a, b, rings[j + 1].radius > 0 ? d : c});
      if (rings[j + 1].radius > 0) mesh_.indices.insert(mesh_.indices.end(), {a, d, c});
    }
}

void Shaper::turn(const Frame& frame, std::span<const ProfilePoint> profile, int sides) {
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const ProfilePoint &a = profile[i], &b = profile[i + 1];
    const double ahead = b.ahead - a.ahead, out = b.radius - a.radius, length = std::hypot(ahead, out);
    const int rows = ahead == 0 ? detail_.across(length) : detail_.along(length);
    std::vector<Ring> rings;
    for (int k = 0; k <= rows; ++k) {
      const double t = static_cast<double>(k) / rows;
      rings.push_back({frame.ahead(a.ahead + ahead * t), a.radius + out * t, ahead / length, -out / length});
    }
    skin(rings, sides);
  }
}

void Shaper::cylinder(const Frame& frame, double radius, double length, bool close_start, bool close_end) {
  std::vector<ProfilePoint> profile;
  if (close_start) profile.push_back({0, 0});
  profile.push_back({0, radius});
  profile.push_back({length, radius});
  if (close_end) profile.push_back({length, 0});
  turn(frame, profile, detail_.around(radius));
}

void Shaper::rod(const dvec3& from, const dvec3& to, double radius, bool close) {
  cylinder(frame_along(from, to - from), radius, glm::length(to - from), close, close);
}

void Shaper::head(const Frame& frame, double radius, double height, int sides) {
  const int rows = std::max(2, sides / 6);
  std::vector<Ring> rings;
  for (int k = 0; k <= rows; ++k) {
    const double angle = kPi / 2 * k / rows;
    rings.push_back({frame.ahead(height * std::sin(angle)), k == rows ? 0 : radius * std::cos(angle),
                     std::cos(angle) / radius, std::sin(angle) / height});
  }
  skin(rings, sides);
}

void Shaper::hoop(const Frame& frame, double radius, double tube_radius, double angle) {
  const int steps = std::max(3, static_cast<int>(std::ceil(detail_.around(radius) * std::abs(angle) / (2 * kPi))));
  const Frame start{frame.origin + frame.x * radius, frame.x, -frame.z, frame.y};
  std::vector<Ring> rings;
  for (int k = 0; k <= steps; ++k)
    rings.push_back({turned(start, frame.origin, frame.z, angle * k / steps), tube_radius});
  skin(rings, detail_.around(tube_radius));
}

void Shaper::prism(const Frame& frame, double radius, double height, int sides) {
  const auto corner = [&](int i) {
    return frame.point(radius * std::cos(2 * kPi * i / sides), radius * std::sin(2 * kPi * i / sides), 0);
  };
  const dvec3 up = frame.z * height;
  for (int i = 0; i < sides; ++i) strip(corner(i), corner(i + 1), up, cross(corner(i + 1) - corner(i), up));
  triangles_ += static_cast<std::size_t>(sides) - 2;
  if (counting_) return;
  const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
  for (int i = 0; i < sides; ++i) {
    mesh_.positions.push_back(to_float3(corner(i) + up));
    mesh_.normals.push_back(to_float3(frame.z));
  }
  for (std::uint32_t i = 1; i + 1 < static_cast<std::uint32_t>(sides); ++i)
    mesh_.indices.insert(mesh_.indices.end(), {first, first + i, first + i + 1});
}

// One quadrilateral from the edge a–b over `ahead`, undivided.
void Shaper::strip(const dvec3& a, const dvec3& b, const dvec3& ahead, const dvec3& normal) {
  triangles_ += 2;
  if (counting_) return;
  const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
  for (const dvec3& p : {a, b, b + ahead, a + ahead}) {
    mesh_.positions.push_back(to_float3(p));
    mesh_.normals.push_back(to_float3(normalize(normal)));
  }
  mesh_.indices.insert(mesh_.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
}

void Shaper::triangle(const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 normal = cross(b - a, c - a);
  if (dot(normal, normal) < 1e-16) return;
  ++triangles_;
  if (counting_) return;
  const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
  for (const dvec3& p : {a, b, c}) {
    mesh_.positions.push_back(to_float3(p));
    mesh_.normals.push_back(to_float3(normalize(normal)));
  }
  mesh_.indices.insert(mesh_.indices.end(), {first, first + 1, first + 2});
}

void Shaper::face(const dvec3& corner, const dvec3& across, const dvec3& up) {
  const int columns = detail_.across(glm::length(across)), rows = detail_.across(glm::length(up));
  triangles_ += static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) * 2;
  if (!counting_) add_rectangle(mesh_, corner, across, up, columns, rows);
}

void Shaper::box(const Frame& f, const dvec3& low, const dvec3& high, unsigned omitted) {
  const dvec3 x = f.x * (high.x - low.x), y = f.y * (high.y - low.y), z = f.z * (high.z - low.z);
  const dvec3 base = f.point(low.x, low.y, low.z), tip = f.point(high.x, high.y, high.z);
  if (!(omitted & kLeft)) face(base, z, y);
  if (!(omitted & kFront)) face(base, x, z);
  if (!(omitted & kBottom)) face(base, y, x);
  if (!(omitted & kRight)) face(tip, -y, -z);
  if (!(omitted & kBack)) face(tip, -z, -x);
  if (!(omitted & kTop)) face(tip, -x, -y);
}

void Shaper::bar(const dvec3& from, const dvec3& to, double width, double height) {
  const Frame f = frame_along(from, to - from);  // y horizontal, x upright (downward)
  const double length = glm::length(to - from);
  box(f, {-height / 2, -width / 2, 0}, {height / 2, width / 2, length});
}

void Shaper::wide_flange(const Frame& f, double width, double depth, double length, bool close_start, bool close_end) {
  if (detail_.rough())
    return box(f, {-0.5 * width, -0.5 * depth, 0}, {0.5 * width, 0.5 * depth, length},
               (close_start ? 0U : kBottom) | (close_end ? 0U : kTop));
  const double w = width / 2, d = depth / 2, web = 0.05 * width, flange = 0.08 * depth;
  // Counter-clockwise outline.
  const double outline[12][2] = {
      {-w, -d}, {w, -d}, {w, -d + flange}, {web, -d + flange}, {web, d - flange},   {w, d - flange},
      {w, d},   {-w, d}, {-w, d - flange}, {-web, d - flange}, {-web, -d + flange}, {-w, -d + flange}};
  for (int i = 0; i < 12; ++i) {
    const dvec3 a = f.point(outline[i][0], outline[i][1], 0),
                b = f.point(outline[(i + 1) % 12][0], outline[(i + 1) % 12][1], 0);
    face(a, b - a, f.z * length);
  }
  const double plates[3][4] = {{-w, -d, w, -d + flange}, {-web, -d + flange, web, d - flange}, {-w, d - flange, w, d}};
  for (const auto& p : plates) {
    const dvec3 x = f.x * (p[2] - p[0]), y = f.y * (p[3] - p[1]);
    if (close_start) face(f.point(p[0], p[1], 0), y, x);
    if (close_end) face(f.point(p[0], p[1], length), x, y);
  }
}

}  // namespace vantage::built_in
