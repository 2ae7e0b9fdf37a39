// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/xml_tree.hpp"

#include <expat.h>

#include <memory>

#include "import/cloud/byte_file.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

constexpr std::size_t kDeepest = 64;

struct Builder {
  XmlElement root;
  std::vector<XmlElement*> open{&root};  // addresses of open elements hold while children are added
  XML_Parser parser = nullptr;
  bool too_deep = false;
};

void begin_element(void* user, const XML_Char* name, const XML_Char** attributes) {
  auto& builder = *static_cast<Builder*>(user);
  if (builder.open.size() > kDeepest) {
    builder.too_deep = true;
    XML_StopParser(builder.parser, XML_FALSE);
    return;
  }
  XmlElement& element = builder.open.back()->children.emplace_back();
  element.name = name;
  for (; attributes[0]; attributes += 2) element.attributes[attributes[0]] = attributes[1];
  builder.open.push_back(&element);
}

void end_element(void* user, const XML_Char*) { static_cast<Builder*>(user)->open.pop_back(); }

void add_text(void* user, const XML_Char* characters, int length) {
  static_cast<Builder*>(user)->open.back()->text.append(characters, static_cast<std::size_t>(length));
}

std::string_view trimmed(std::string_view value) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const auto first = value.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return value.substr(first, value.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace

const XmlElement* XmlElement::child(std::string_view wanted) const {
  for (const XmlElement& element : children)
    if (element.name == wanted) return &element;
  return nullptr;
}

double XmlElement::number(std::initializer_list<std::string_view> path, double missing) const {
  const XmlElement* element = this;
  std::string where;
  for (const std::string_view step : path) {
    element = element->child(step);
    if (!element) return missing;
    if (!where.empty()) where += '/';
    where += step;
  }
  const std::string_view value = trimmed(element->text);
  if (value.empty()) return missing;
  const auto parsed = number_of(value);
  if (!parsed) throw Refused("in its description, " + where + " is no number; export it again");
  return *parsed;
}

std::string XmlElement::text_at(std::string_view wanted) const {
  const XmlElement* element = child(wanted);
  return element ? std::string(trimmed(element->text)) : std::string();
}

XmlElement parse_xml(const std::string& text_of_file) {
  const std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr),
                                                                                             &XML_ParserFree);
  if (!parser) throw std::bad_alloc();
  Builder builder;
  builder.parser = parser.get();
  XML_SetUserData(parser.get(), &builder);
  XML_SetElementHandler(parser.get(), begin_element, end_element);
  XML_SetCharacterDataHandler(parser.get(), add_text);
  if (XML_Parse(parser.get(), text_of_file.data(), static_cast<int>(text_of_file.size()), 1) != XML_STATUS_OK) {
    const XML_Error error = XML_GetErrorCode(parser.get());
    if (error == XML_ERROR_NO_MEMORY) throw std::bad_alloc();
    throw Refused("its description (XML) cannot be read at line " +
                  std::to_string(XML_GetCurrentLineNumber(parser.get())) + ": " +
                  (builder.too_deep ? "it is nested too deeply" : XML_ErrorString(error)) + "; export it again");
  }
  if (builder.root.children.empty()) throw Refused("its description is empty; export it again");
  return std::move(builder.root.children.front());
}

}  // namespace vantage::importer
