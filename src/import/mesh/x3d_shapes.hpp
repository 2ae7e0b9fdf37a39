// SPDX-License-Identifier: Apache-2.0
// Surfaces of X3D's geometry nodes (ISO/IEC 19775-1).
#pragma once

#include <functional>
#include <optional>

#include "import/cloud/xml_tree.hpp"
#include "import/mesh/model.hpp"

namespace vantage::importer {

// Returns the element that a USE refers to; the element itself if it has none.
using X3dResolver = std::function<const XmlElement&(const XmlElement&)>;

struct X3dUnits {
  double metres = 1;  // in a unit of length; decides how finely round shapes are cut
  double radians = 1;
};

enum class X3dGeometry { surface, lines_or_points, unknown };
X3dGeometry x3d_kind(std::string_view node);

// Returns the triangles of a geometry node, wound as its ccw says. REQUIRES: a surface. Throws Refused.
Part x3d_surface(const XmlElement& geometry, const X3dResolver& resolve, const X3dUnits& units);

// Returns an attribute of an element, or `missing` without it. Throws Refused if it is of another type.
std::vector<double> x3d_numbers(const XmlElement& element, const char* name, std::vector<double> missing);
double x3d_number(const XmlElement& element, const char* name, double missing);
bool x3d_truth(const XmlElement& element, const char* name, bool missing);

}  // namespace vantage::importer
