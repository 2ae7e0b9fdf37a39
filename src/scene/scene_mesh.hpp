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

// Throw Error invalid_argument for a value out of range. `who` begins the message; a mesh's number does.
void check(const Pose& pose, const std::string& who);
void check(const SceneMesh& mesh, std::size_t number);
// Removes positions that no triangle uses; the others keep their order.
void compact(SceneMesh& mesh);
// REQUIRES: a pose that passed check().
glm::dmat3 turn_of(const Pose& pose);
// Its positions in the survey frame.
std::vector<glm::dvec3> placed(const SceneMesh& mesh);
MeshInfo info_of(const SceneMesh& mesh, Role role);
Material material_of(const SceneMesh& mesh);

}  // namespace vantage
