// SPDX-License-Identifier: Apache-2.0
// Surfaces of X3D's geometry nodes (ISO/IEC 19775-1).
#pragma once

#include <functional>
#include <optional>

#include "import/cloud/xml_tree.hpp"
#include "import/mesh/model.hpp"

namespace vantage::importer {

// Gives the element that another one stands for, by USE; itself if it has none.
using X3dResolver = std::function<const XmlElement&(const XmlElement&)>;

struct X3dUnits {
  double metres = 1;  // in a unit of length, which decides how finely round shapes are cut
  double radians = 1;
};

enum class X3dGeometry { surface, lines_or_points, unknown };
X3dGeometry x3d_kind(std::string_view node);

// The triangles of a geometry node, which wind as its ccw says. REQUIRES: a surface. Throws Refused.
Part x3d_surface(const XmlElement& geometry, const X3dResolver& resolve, const X3dUnits& units);

// An attribute of an element, or what holds without it. Throws Refused if it is of another type.
std::vector<double> x3d_numbers(const XmlElement& element, const char* name, std::vector<double> missing);
double x3d_number(const XmlElement& element, const char* name, double missing);
bool x3d_truth(const XmlElement& element, const char* name, bool missing);

}  // namespace vantage::importer
