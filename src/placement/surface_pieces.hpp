// SPDX-License-Identifier: Apache-2.0
// Pieces of the scene's triangles on which one could stand.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/glm.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

// A triangle soup in the local frame, in double. A piece is a whole source triangle or a part of it.
struct SurfacePieces {
  std::vector<glm::dvec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> source;    // per piece; pieces of one source are consecutive
  std::vector<std::uint8_t> kind = {};  // per piece, from sort_pieces(); empty otherwise
};

// Cuts triangles up by the kind that `kind_of` gives to places, and drops kind 0. Each triangle is halved across its
// longest edge until no edge exceeds `spacing_m`; a remaining piece has its centroid's kind, and halves of one kind are
// merged again. Parallel; `kind_of` is called from several threads and returns kinds below 255.
SurfacePieces sort_pieces(std::vector<glm::dvec3> points, std::span<const Triangle> triangles, double spacing_m,
                          const std::function<std::uint8_t(const glm::dvec3&)>& kind_of);
// Returns the pieces of one kind.
SurfacePieces pieces_of_kind(const SurfacePieces& pieces, std::uint8_t kind);
// Returns the clear parts of the triangles.
SurfacePieces clear_pieces(std::vector<glm::dvec3> points, std::span<const Triangle> triangles, double spacing_m,
                           const std::function<bool(const glm::dvec3&)>& clear);

double piece_area(const SurfacePieces& pieces, std::uint32_t piece);       // true area
double piece_plan_area(const SurfacePieces& pieces, std::uint32_t piece);  // seen from above

}  // namespace vantage
