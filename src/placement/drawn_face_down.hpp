// SPDX-License-Identifier: Apache-2.0
// Finds surfaces that a person stands on although they were drawn face down: ground, as modellers draw a first
// rectangle, and solids that are inside out, as mirrored copies are.
#pragma once

#include <cstdint>
#include <vector>

#include "placement/mesh_tree.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

// Returns the triangles of such connected parts of a mesh, rising: of open sheets of which hardly anything faces up,
// and of closed ones whose faces show inwards, if they are not as high inside as a person. Somebody of this height, in
// metres, has room on most of what faces down, below the sky or a face that looks down at it, unlike inside of a solid.
// A ceiling under the sky is none: something lies below a ceiling. A sheet that lies close over one that faces up is a
// floor whatever the face above it looks at: both sides of a floor between storeys are drawn the wrong way around. Of
// meshes that are wound either way, as sketching
// tools leave them, all that faces down with such room above.
std::vector<std::uint32_t> drawn_face_down(const SceneData& scene, const MeshTree& tree, double height_m);

}  // namespace vantage
