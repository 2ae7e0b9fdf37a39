// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/glm.hpp"
#include "import/floor_plan/dxf.hpp"

namespace vantage::importer {

// Returns the transform from an entity's object coordinates to the world.
glm::dmat4 world_from_object(const floor_plan::Entity& entity);

// Returns the convex faces of a line with a thickness (group 39), which extrudes LINE, ARC, CIRCLE, LWPOLYLINE and a
// flat POLYLINE. Faces stand on the line; a circle or a line with a width becomes a body. Other entities have none.
// `parts` are vertices of a POLYLINE; `metres` is the unit, 0 if it is not known.
std::vector<std::vector<glm::dvec3>> faces_of_thick_line(const floor_plan::Entity& entity,
                                                         const std::vector<floor_plan::Entity>& parts, double metres);

}  // namespace vantage::importer
