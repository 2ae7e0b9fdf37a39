// SPDX-License-Identifier: Apache-2.0
// Ground and floors that were drawn face down, as modellers draw a first rectangle: what they show from above is a
// back.
#pragma once

#include <cstdint>
#include <vector>

#include "placement/mesh_tree.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

// The triangles of open sheets that face down and that a person stands on, rising. A sheet is a connected part of a
// mesh of which hardly anything faces up, so the underside of a solid is none. A person of this height has room on most
// of it, below the sky or a face that looks down at it, unlike inside of a solid. A ceiling under the sky is none
// either: something lies below a ceiling. Survey frame's lengths.
std::vector<std::uint32_t> sheets_facing_down(const SceneData& scene, const MeshTree& tree, double height_m);

}  // namespace vantage
