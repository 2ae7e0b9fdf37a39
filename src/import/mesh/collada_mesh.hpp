// SPDX-License-Identifier: Apache-2.0
// Surfaces of COLLADA's meshes (COLLADA 1.4.1, Khronos 2008; 1.5).
#pragma once

#include <map>

#include "import/cloud/xml_tree.hpp"
#include "import/mesh/model.hpp"

namespace vantage::importer {

using XmlIds = std::map<std::string, const XmlElement*>;

// Returns an attribute of an element; empty if it has none.
std::string attribute_of_element(const XmlElement& element, const char* name);

// Returns the element that a reference "#id" names; null if it is in another file or missing.
const XmlElement* find_by_reference(const XmlIds& ids, const std::string& reference);

// The triangles of one material symbol.
struct ColladaPart {
  std::string symbol;
  Part part;
};
// Returns the parts of a `mesh`. Counts lines in `lines`. Throws Refused.
std::vector<ColladaPart> collada_parts(const XmlElement& mesh, const XmlIds& ids, std::size_t& lines);

}  // namespace vantage::importer
