// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::importer {

// An element of an XML document, with its prefix, its own text and its children.
struct XmlElement {
  std::string name, text;
  std::map<std::string, std::string> attributes;
  std::vector<XmlElement> children;

  // Returns the first child of that name, or null.
  const XmlElement* child(std::string_view wanted) const;
  // Returns the number at a path of children; `missing` if there is none or it is empty. Throws Refused if no number.
  double number(std::initializer_list<std::string_view> path, double missing) const;
  std::string text_at(std::string_view wanted) const;
};

// Throws Refused.
XmlElement parse_xml(const std::string& text);

}  // namespace vantage::importer
