// SPDX-License-Identifier: Apache-2.0
// Finds surfaces that a person stands on although they were drawn face down: ground, if a modeller drew its first
// rectangle that way, and inside-out solids, such as mirrored copies.
#pragma once

#include <cstdint>
#include <vector>

#include "placement/mesh_tree.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

// Returns the triangles, ascending, of two kinds of components of a mesh: open sheets of which hardly any area faces
// up, and closed ones whose faces show inwards and whose inside is lower than a person. A person of this height, in
// metres, must have room on most of the faces that look down, below the sky or a face that looks down at it, unlike
// inside a solid. A ceiling under the sky does not count: something lies below a ceiling. A sheet close above one that
// faces up is a floor whatever the face above it does, as both sides of a floor between storeys are then drawn the
// wrong way around. For meshes whose winding tells nothing, as from sketching tools, it returns all triangles that face
// down with such room above.
std::vector<std::uint32_t> drawn_face_down(const SceneData& scene, const MeshTree& tree, double height_m);

}  // namespace vantage
