// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/glm.hpp"
#include "import/floor_plan/dxf.hpp"

namespace vantage::importer {

// The world from an entity's object coordinates.
glm::dmat4 world_from_object(const floor_plan::Entity& entity);

// The convex faces of a line with a thickness (group 39), by which LINE, ARC, CIRCLE, LWPOLYLINE and a flat POLYLINE
// are extruded: faces that stand on the line, and a body if it is a circle or has a width. Empty for what has none.
// `parts` are vertices of a POLYLINE; `metres` is the unit, 0 if it is not known.
std::vector<std::vector<glm::dvec3>> faces_of_thick_line(const floor_plan::Entity& entity,
                                                         const std::vector<floor_plan::Entity>& parts, double metres);

}  // namespace vantage::importer
