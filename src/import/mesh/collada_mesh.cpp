// SPDX-License-Identifier: Apache-2.0
#include "import/mesh/collada_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "import/mesh/polygon.hpp"
#include "import/mesh/text.hpp"

namespace vantage::importer {
namespace {

// Rows of an accessor; each row has as many numbers as the accessor names.
struct Rows {
  std::vector<double> values;
  std::size_t offset = 0, stride = 1, count = 0;
  std::vector<std::size_t> places;  // of the named parameters in a row

  double at(std::size_t row, std::size_t parameter) const { return values[offset + row * stride + places[parameter]]; }
};

std::size_t whole_of(const XmlElement& element, const char* name, std::size_t missing) {
  const std::string text = attribute_of_element(element, name);
  if (text.empty()) return missing;
  const auto value = value_of<std::uint32_t>(trimmed_text(text));
  if (!value)
    throw Refused("the " + std::string(name) + " of an element " + element.name + " is no number; export it again");
  return *value;
}

class Primitives {
 public:
  Primitives(const XmlElement& mesh, const XmlIds& ids, std::size_t& lines) : mesh_(mesh), ids_(ids), lines_(lines) {}

  std::vector<ColladaPart> run() {
    constexpr std::array<std::string_view, 5> kSurfaces{"triangles", "polylist", "polygons", "tristrips", "trifans"};
    for (const XmlElement& element : mesh_.children) {
      if (element.name == "lines" || element.name == "linestrips") lines_ += whole_of(element, "count", 1);
      if (std::ranges::find(kSurfaces, element.name) == kSurfaces.end()) continue;
      open(element);
      read(element);
      out_.push_back({attribute_of_element(element, "material"), std::move(part_)});
    }
    return std::move(out_);
  }

 private:
  Rows rows_of(const XmlElement& source) const {
    const XmlElement* technique = source.child("technique_common");
    const XmlElement* accessor = technique ? technique->child("accessor") : nullptr;
    if (!accessor) throw Refused("a source of a mesh has no accessor; export it again");
    const XmlElement* array = find_by_reference(ids_, attribute_of_element(*accessor, "source"));
    if (!array) array = source.child("float_array");
    if (!array) throw Refused("a source of a mesh has no numbers; export it again");
    Rows rows;
    rows.values = values_of<double>(array->text, "an array of numbers");
    rows.offset = whole_of(*accessor, "offset", 0), rows.stride = whole_of(*accessor, "stride", 1);
    rows.count = whole_of(*accessor, "count", 0);
    // A parameter without a name is skipped, unless none has one.
    std::size_t place = 0;
    bool named = false;
    for (const XmlElement& child : accessor->children)
      named |= child.name == "param" && child.attributes.contains("name");
    for (const XmlElement& child : accessor->children) {
      if (child.name != "param") continue;
      if (!named || child.attributes.contains("name")) rows.places.push_back(place);
      ++place;
    }
    if (place == 0)
      for (; place < rows.stride; ++place) rows.places.push_back(place);
    const std::size_t width = rows.places.empty() ? 1 : rows.places.back() + 1;
    if (rows.count > 0 && rows.offset + (rows.count - 1) * rows.stride + width > rows.values.size())
      throw Refused("a source of a mesh announces " + std::to_string(rows.count) + " rows, and has " +
                    std::to_string(rows.values.size()) + " numbers; export it again");
    return rows;
  }
  const Rows* input_rows(const std::string& reference, std::size_t least) {
    const XmlElement* source = find_by_reference(ids_, reference);
    if (!source)
      throw Refused("a mesh takes numbers from " + reference + ", which is not in the file; export it again");
    const auto known = rows_.try_emplace(source);
    if (known.second) known.first->second = rows_of(*source);
    return known.first->second.places.size() < least ? nullptr : &known.first->second;
  }

  struct Input {
    const Rows* rows = nullptr;
    std::size_t offset = 0;
  };

  void open(const XmlElement& primitive) {
    position_ = normal_ = colour_ = {};
    width_ = 1;
    part_ = {};
    const auto take = [&](const XmlElement& input, std::size_t offset) {
      const std::string semantic = attribute_of_element(input, "semantic"),
                        source = attribute_of_element(input, "source");
      if (semantic == "POSITION") position_ = {input_rows(source, 3), offset};
      if (semantic == "NORMAL") normal_ = {input_rows(source, 3), offset};
      if (semantic == "COLOR" && !colour_.rows) colour_ = {input_rows(source, 3), offset};
    };
    for (const XmlElement& input : primitive.children) {
      if (input.name != "input") continue;
      const std::size_t offset = whole_of(input, "offset", 0);
      width_ = std::max(width_, offset + 1);
      if (attribute_of_element(input, "semantic") != "VERTEX") {
        take(input, offset);
        continue;
      }
      const XmlElement* vertices = find_by_reference(ids_, attribute_of_element(input, "source"));
      if (!vertices) throw Refused("a mesh has no vertices; export it again");
      for (const XmlElement& inner : vertices->children)
        if (inner.name == "input") take(inner, offset);
    }
    if (!position_.rows) throw Refused("a mesh has no positions of x, y and z; export it again");
  }

  std::vector<std::uint32_t> tuple_numbers(const XmlElement& list) const {
    return values_of<std::uint32_t>(list.text, "the list " + list.name + " of a mesh");
  }

  std::size_t row_of(const Input& input, const std::uint32_t* tuple) const {
    const std::size_t row = tuple[input.offset];
    if (row >= input.rows->count)
      throw Refused("a face names row " + std::to_string(row) + " of " + std::to_string(input.rows->count) +
                    "; export it again");
    return row;
  }

  std::uint32_t add_corner(const std::uint32_t* tuple) {
    const std::size_t row = row_of(position_, tuple);
    part_.positions.emplace_back(position_.rows->at(row, 0), position_.rows->at(row, 1), position_.rows->at(row, 2));
    if (normal_.rows) {
      const std::size_t n = row_of(normal_, tuple);
      part_.normals.push_back(
          glm::vec3(glm::dvec3(normal_.rows->at(n, 0), normal_.rows->at(n, 1), normal_.rows->at(n, 2))));
    }
    if (colour_.rows) {
      const std::size_t c = row_of(colour_, tuple);
      Rgba rgba{0, 0, 0, 255};
      for (std::size_t k = 0; k < std::min<std::size_t>(4, colour_.rows->places.size()); ++k) {
        const double share = colour_.rows->at(c, k);
        rgba[k] = std::isfinite(share) ? static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))) : 0;
      }
      part_.colours.push_back(rgba);
    }
    return static_cast<std::uint32_t>(part_.positions.size() - 1);
  }

  // Adds a polygon. Its loops of tuples are an outline and its holes.
  void add_polygon(const std::vector<std::vector<std::uint32_t>>& loops) {
    const std::size_t first = part_.positions.size();
    std::vector<std::size_t> sizes;
    for (const std::vector<std::uint32_t>& loop : loops) {
      sizes.push_back(loop.size() / width_);
      for (std::size_t k = 0; k + width_ <= loop.size(); k += width_) add_corner(&loop[k]);
    }
    std::vector<std::uint32_t> cut;
    cut_into_triangles(std::span(part_.positions).subspan(first), sizes, cut);
    for (const std::uint32_t c : cut) part_.indices.push_back(static_cast<std::uint32_t>(first + c));
  }

  void read(const XmlElement& primitive) {
    std::vector<std::uint32_t> counts;
    for (const XmlElement& list : primitive.children) {
      if (list.name == "vcount") counts = tuple_numbers(list);
      if (list.name == "ph") {
        std::vector<std::vector<std::uint32_t>> loops;
        for (const XmlElement& loop : list.children) {
          if (loop.name == "p") loops.insert(loops.begin(), tuple_numbers(loop));
          if (loop.name == "h") loops.push_back(tuple_numbers(loop));
        }
        add_polygon(loops);
      }
      if (list.name != "p") continue;
      const std::vector<std::uint32_t> tuples = tuple_numbers(list);
      if (primitive.name == "polygons") {
        add_polygon({tuples});
      } else if (primitive.name == "polylist") {
        std::size_t at = 0;
        for (const std::uint32_t count : counts) {
          if (count * width_ > tuples.size() - at) throw Refused("a polylist is cut off; export it again");
          add_polygon({{tuples.begin() + static_cast<std::ptrdiff_t>(at),
                        tuples.begin() + static_cast<std::ptrdiff_t>(at + count * width_)}});
          at += count * width_;
        }
      } else {
        add_run(primitive.name, tuples);
      }
    }
  }

  void add_run(const std::string& kind, const std::vector<std::uint32_t>& tuples) {
    const auto first = static_cast<std::uint32_t>(part_.positions.size());
    for (std::size_t k = 0; k + width_ <= tuples.size(); k += width_) add_corner(&tuples[k]);
    const auto n = static_cast<std::uint32_t>(part_.positions.size()) - first;
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      part_.indices.insert(part_.indices.end(), {first + a, first + b, first + c});
    };
    for (std::uint32_t k = 0; k + 2 < n; k += kind == "triangles" ? 3 : 1) {
      if (kind == "trifans")
        triangle(0, k + 1, k + 2);
      else if (kind == "tristrips" && k % 2 == 1)
        triangle(k + 1, k, k + 2);
      else
        triangle(k, k + 1, k + 2);
    }
  }

  const XmlElement& mesh_;
  const XmlIds& ids_;
  std::size_t& lines_;
  std::map<const XmlElement*, Rows> rows_;
  Input position_, normal_, colour_;
  std::size_t width_ = 1;
  Part part_;
  std::vector<ColladaPart> out_;
};

}  // namespace

std::string attribute_of_element(const XmlElement& element, const char* name) {
  const auto found = element.attributes.find(name);
  return found == element.attributes.end() ? std::string() : found->second;
}

const XmlElement* find_by_reference(const XmlIds& ids, const std::string& reference) {
  if (!reference.starts_with('#')) return nullptr;
  std::string id = reference.substr(1);
  if (const auto known = ids.find(id); known != ids.end()) return known->second;
  // A reference is a URI, in which other characters may stand as %XX.
  std::string decoded;
  for (std::size_t k = 0; k < id.size(); ++k) {
    unsigned value = 0;
    if (id[k] == '%' && k + 2 < id.size() &&
        std::from_chars(id.data() + k + 1, id.data() + k + 3, value, 16).ptr == id.data() + k + 3) {
      decoded += static_cast<char>(value);
      k += 2;
    } else {
      decoded += id[k];
    }
  }
  const auto known = ids.find(decoded);
  return known == ids.end() ? nullptr : known->second;
}

std::vector<ColladaPart> collada_parts(const XmlElement& mesh, const XmlIds& ids, std::size_t& lines) {
  return Primitives(mesh, ids, lines).run();
}

}  // namespace vantage::importer
