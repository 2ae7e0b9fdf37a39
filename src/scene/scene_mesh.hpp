// SPDX-License-Identifier: Apache-2.0
// Meshes as arrays, on their way into a scene.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/glm.hpp"
#include "scene/scene_data.hpp"
#include "vantage/scene_builder.hpp"

namespace vantage {

// Throws Error invalid_argument for a value out of range. Messages begin with `who`, or with the mesh's number.
void check(const Pose& pose, const std::string& who);
void check(const SceneMesh& mesh, std::size_t number);
// Removes positions that no triangle uses; the others keep their order.
void compact(SceneMesh& mesh);
// Returns the rotation. REQUIRES: a pose that passed check().
glm::dmat3 turn_of(const Pose& pose);
// Returns the mesh's positions in the survey frame.
std::vector<glm::dvec3> placed(const SceneMesh& mesh);
MeshInfo info_of(const SceneMesh& mesh, Role role);
Material material_of(const SceneMesh& mesh);

}  // namespace vantage
