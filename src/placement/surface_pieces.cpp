// SPDX-License-Identifier: Apache-2.0
#include "placement/surface_pieces.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/parallel.hpp"

namespace vantage {
namespace {

using Corners = std::array<glm::dvec3, 3>;

using Kind = std::uint8_t;
constexpr Kind kDropped = 0, kMixed = 255;

struct Part {
  std::uint32_t source;
  Kind kind;
  Corners corners;
};

class Splitter {
 public:
  Splitter(double spacing_m, const std::function<Kind(const glm::dvec3&)>& kind_of)
      : longest_(spacing_m * spacing_m), kind_of_(kind_of) {}

  // Appends the largest parts of one kind, unless the whole triangle is of one kind.
  Kind split(const Corners& p, std::uint32_t source, std::vector<Part>& parts, int depth = 0) const {
    std::array<double, 3> length;
    for (int e = 0; e < 3; ++e) {
      const glm::dvec3 edge = p[(e + 1) % 3] - p[e];
      length[e] = dot(edge, edge);
    }
    const int e = static_cast<int>(std::max_element(length.begin(), length.end()) - length.begin());
    if (length[e] <= longest_ || depth == kMaxDepth) return kind_of_((p[0] + p[1] + p[2]) * (1.0 / 3));
    const glm::dvec3 a = p[e], b = p[(e + 1) % 3], c = p[(e + 2) % 3], middle = (a + b) * 0.5;
    const Corners first{a, middle, c}, second{middle, b, c};
    const Kind left = split(first, source, parts, depth + 1), right = split(second, source, parts, depth + 1);
    if (left == right && left != kMixed) return left;
    if (left != kDropped && left != kMixed) parts.push_back({source, left, first});
    if (right != kDropped && right != kMixed) parts.push_back({source, right, second});
    return kMixed;
  }

 private:
  static constexpr int kMaxDepth = 40;  // halving the area 40 times reaches any spacing that callers choose
  double longest_;
  const std::function<Kind(const glm::dvec3&)>& kind_of_;
};

Corners corners_of(const SurfacePieces& pieces, std::uint32_t piece) {
  const Triangle& t = pieces.triangles[piece];
  return {pieces.points[t[0]], pieces.points[t[1]], pieces.points[t[2]]};
}

}  // namespace

SurfacePieces sort_pieces(std::vector<glm::dvec3> points, std::span<const Triangle> triangles, double spacing_m,
                          const std::function<std::uint8_t(const glm::dvec3&)>& kind_of) {
  const Splitter splitter(spacing_m, kind_of);
  std::vector<Kind> whole(triangles.size());
  tbb::enumerable_thread_specific<std::vector<Part>> collected;
  parallel::for_all(tbb::blocked_range<std::uint32_t>(0, static_cast<std::uint32_t>(triangles.size())),
                    [&](const tbb::blocked_range<std::uint32_t>& range) {
                      std::vector<Part>& parts = collected.local();
                      for (std::uint32_t t = range.begin(); t != range.end(); ++t)
                        whole[t] = splitter.split(
                            {points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]]}, t, parts);
                    });
  // Each source is done by one thread, so a stable sort by source restores the order of a single thread.
  std::vector<Part> parts;
  for (const auto& some : collected) parts.insert(parts.end(), some.begin(), some.end());
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.source < b.source; });

  SurfacePieces result;
  result.points = std::move(points);
  auto part = parts.begin();
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (whole[t] != kDropped && whole[t] != kMixed) {
      result.triangles.push_back(triangles[t]);
      result.source.push_back(t);
      result.kind.push_back(whole[t]);
    }
    for (; part != parts.end() && part->source == t; ++part) {
      const auto first = static_cast<std::uint32_t>(result.points.size());
      result.points.insert(result.points.end(), part->corners.begin(), part->corners.end());
      result.triangles.push_back({first, first + 1, first + 2});
      result.source.push_back(t);
      result.kind.push_back(part->kind);
    }
  }
  return result;
}

SurfacePieces pieces_of_kind(const SurfacePieces& pieces, std::uint8_t kind) {
  SurfacePieces result;
  result.points = pieces.points;
  for (std::size_t i = 0; i < pieces.triangles.size(); ++i) {
    if (pieces.kind[i] != kind) continue;
    result.triangles.push_back(pieces.triangles[i]);
    result.source.push_back(pieces.source[i]);
  }
  return result;
}

SurfacePieces clear_pieces(std::vector<glm::dvec3> points, std::span<const Triangle> triangles, double spacing_m,
                           const std::function<bool(const glm::dvec3&)>& clear) {
  return sort_pieces(std::move(points), triangles, spacing_m,
                     [&](const glm::dvec3& p) { return static_cast<Kind>(clear(p) ? 1 : kDropped); });
}

double piece_area(const SurfacePieces& pieces, std::uint32_t piece) {
  const Corners p = corners_of(pieces, piece);
  return 0.5 * length(cross(p[1] - p[0], p[2] - p[0]));
}

double piece_plan_area(const SurfacePieces& pieces, std::uint32_t piece) {
  const Corners p = corners_of(pieces, piece);
  return 0.5 * std::abs(cross(p[1] - p[0], p[2] - p[0]).z);
}

}  // namespace vantage
