// SPDX-License-Identifier: Apache-2.0
// PLY (Turk, The PLY Polygon File Format, 1994) with faces or strips: text, or binary in either order of bytes.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/text.hpp"
#include "import/mesh/polygon.hpp"
#include "import/mesh/sources.hpp"
#include "import/mesh/text.hpp"

namespace vantage::importer {
namespace {

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::f32;
  std::optional<PlyType> counted_by = std::nullopt;  // a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::size_t place_of(std::initializer_list<std::string_view> names, bool list = false) const {
    const auto found = std::ranges::find_if(properties, [&](const PlyProperty& property) {
      return property.counted_by.has_value() == list && std::ranges::find(names, property.name) != names.end();
    });
    return static_cast<std::size_t>(found - properties.begin());
  }
};

class PlyReader {
 public:
  explicit PlyReader(const std::filesystem::path& file) : bytes_(read_whole(file)), rest_(bytes_) {}

  Model read() {
    read_header();
    for (const PlyElement& element : elements_) {
      if (element.name == "vertex")
        read_vertices(element);
      else
        read_others(element);
    }
    Model model;
    const auto beyond =
        std::ranges::find_if(part_.indices, [&](std::uint32_t v) { return v >= part_.positions.size(); });
    if (beyond != part_.indices.end())
      throw Refused("a face names vertex " + std::to_string(*beyond) + "; there are " +
                    std::to_string(part_.positions.size()));
    cut_polygons();
    model.rounded = rounded_;
    if (part_.indices.empty()) model.lines_or_points = part_.positions.size();
    model.nodes[0].meshes.push_back(model.add_mesh({{}, {}}));
    model.meshes[0].parts.push_back(std::move(part_));
    model.left_out = std::move(left_out_);
    return model;
  }

 private:
  static PlyType type_of(std::string_view word) {
    struct Known {
      std::string_view name, other;
    };
    constexpr std::array kKnown{Known{"char", "int8"},     Known{"uchar", "uint8"},   Known{"short", "int16"},
                                Known{"ushort", "uint16"}, Known{"int", "int32"},     Known{"uint", "uint32"},
                                Known{"float", "float32"}, Known{"double", "float64"}};
    for (std::size_t k = 0; k < kKnown.size(); ++k)
      if (word == kKnown[k].name || word == kKnown[k].other) return static_cast<PlyType>(k);
    throw Refused("its header has the type " + std::string(word.substr(0, 40)) +
                  ", which PLY has not; export it again");
  }

  void read_header() {
    bool format = false;
    // The data begin right behind the line end of end_header, of the kind that the first line shows: a first byte
    // that looks like a line end belongs to the data.
    const std::size_t first = rest_.find_first_of("\r\n");
    const bool returns = first != rest_.npos && rest_[first] == '\r' && !rest_.substr(first).starts_with("\r\n");
    const char end = returns ? '\r' : '\n';
    while (!rest_.empty()) {
      const std::size_t at = std::min(rest_.find(end), rest_.size());
      std::string_view line = rest_.substr(0, at);
      rest_.remove_prefix(std::min(at + 1, rest_.size()));
      const std::string_view word = take_word(line);
      if (word == "format") {
        const std::string_view kind = take_word(line);
        text_ = kind == "ascii", big_endian_ = kind == "binary_big_endian", format = true;
        if (!text_ && !big_endian_ && kind != "binary_little_endian")
          throw Refused("it is of no format that PLY knows; export it again");
      } else if (word == "element") {
        PlyElement element;
        element.name = take_word(line);
        const auto count = value_of<std::uint64_t>(take_word(line));
        if (!count)
          throw Refused("its header does not say how many of " + element.name + " there are; export it again");
        element.count = *count;
        elements_.push_back(std::move(element));
      } else if (word == "property") {
        if (elements_.empty()) throw Refused("its header names a property before any element; export it again");
        PlyProperty property;
        std::string_view type = take_word(line);
        if (type == "list") {
          property.counted_by = type_of(take_word(line));
          type = take_word(line);
        }
        property.type = type_of(type);
        property.name = lower_case(std::string(take_word(line)));  // some writers put capitals
        elements_.back().properties.push_back(std::move(property));
      } else if (word == "end_header") {
        if (!format) throw Refused("its header names no format; export it again");
        return;
      }
    }
    throw Refused("its header does not end; copy or export it again");
  }

  template <class T>
  double binary() {
    if (rest_.size() < sizeof(T)) throw_truncated();
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    if (big_endian_) std::ranges::reverse(bytes);
    return static_cast<double>(std::bit_cast<T>(bytes));
  }
  double value(PlyType type) {
    if (text_) {
      const std::string_view word = take_word(rest_);
      if (word.empty()) throw_truncated();
      const auto value = value_of<double>(word);
      if (!value)
        throw Refused("it has \"" + std::string(word.substr(0, 40)) + "\" where a number belongs; export it again");
      return *value;
    }
    switch (type) {
      case PlyType::i8: return binary<std::int8_t>();
      case PlyType::u8: return binary<std::uint8_t>();
      case PlyType::i16: return binary<std::int16_t>();
      case PlyType::u16: return binary<std::uint16_t>();
      case PlyType::i32: return binary<std::int32_t>();
      case PlyType::u32: return binary<std::uint32_t>();
      case PlyType::f32: return binary<float>();
      case PlyType::f64: return binary<double>();
    }
    return 0;
  }
  [[noreturn]] static void throw_truncated() {
    throw Refused("it is truncated: its header announces more than it holds; copy or export it again");
  }

  // No value takes less than a byte.
  void check_count(double count) const {
    if (!(count <= static_cast<double>(rest_.size()) + 1)) throw_truncated();
  }

  void read_vertices(const PlyElement& element) {
    check_count(static_cast<double>(element.count));
    const std::size_t none = element.properties.size();
    const std::array<std::size_t, 3> place{element.place_of({"x"}), element.place_of({"y"}), element.place_of({"z"})},
        normal{element.place_of({"nx"}), element.place_of({"ny"}), element.place_of({"nz"})};
    const std::array<std::size_t, 4> colour{
        element.place_of({"red", "diffuse_red", "r"}), element.place_of({"green", "diffuse_green", "g"}),
        element.place_of({"blue", "diffuse_blue", "b"}), element.place_of({"alpha", "diffuse_alpha", "a"})};
    const auto given = [&](const auto& places, std::size_t n) {
      return std::all_of(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(n),
                         [&](std::size_t k) { return k < none; });
    };
    if (!given(place, 3)) throw Refused("its vertices have no x, y and z; export it again");
    rounded_ =
        !text_ && std::ranges::all_of(place, [&](std::size_t k) { return element.properties[k].type == PlyType::f32; });
    const bool normals = given(normal, 3), colours = given(colour, 3);
    std::vector<double> row(none);
    for (std::uint64_t k = 0; k < element.count; ++k) {
      for (std::size_t p = 0; p < none; ++p) row[p] = scalar_or_skipped(element.properties[p]);
      part_.positions.emplace_back(row[place[0]], row[place[1]], row[place[2]]);
      if (normals) part_.normals.push_back(glm::vec3(glm::dvec3(row[normal[0]], row[normal[1]], row[normal[2]])));
      if (colours) {
        Rgba rgba{0, 0, 0, 255};
        for (std::size_t c = 0; c < 4; ++c)
          if (colour[c] < none) rgba[c] = byte_of(row[colour[c]], element.properties[colour[c]].type);
        part_.colours.push_back(rgba);
      }
    }
  }

  double scalar_or_skipped(const PlyProperty& property) {
    if (!property.counted_by) return value(property.type);
    const double count = value(*property.counted_by);
    check_count(count);
    for (double k = 0; k < count; ++k) value(property.type);
    return 0;
  }

  // Floats are shares of 1; integers are shares of their type's largest value.
  static std::uint8_t byte_of(double value, PlyType type) {
    const double largest = type == PlyType::f32 || type == PlyType::f64 ? 1
                           : type == PlyType::u16                       ? 65535
                           : type == PlyType::u32                       ? 4294967295.0
                                                                        : 255;
    return std::isfinite(value) ? static_cast<std::uint8_t>(std::lround(255 * std::clamp(value / largest, 0.0, 1.0)))
                                : 0;
  }

  // Reads faces and strips; the lists of vertices are kept until all vertices are read.
  void read_others(const PlyElement& element) {
    check_count(element.properties.empty() ? 0 : static_cast<double>(element.count));
    const std::size_t list = element.place_of({"vertex_indices", "vertex_index"}, true);
    const bool faces = element.name == "face", strips = element.name == "tristrips";
    if ((faces || strips) && element.count > 0 && list == element.properties.size())
      throw Refused("its " + element.name + " have no list vertex_indices; export it again");
    if (!faces && !strips && element.name != "edge" && element.count > 0 && list < element.properties.size())
      left_out_[element.name] += element.count;
    for (std::uint64_t k = 0; k < element.count && !element.properties.empty(); ++k)
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        if (p != list || (!faces && !strips))
          scalar_or_skipped(element.properties[p]);
        else if (faces)
          read_face(element.properties[p]);
        else
          read_strip(element.properties[p]);
      }
  }

  std::uint32_t corner(PlyType type) {
    const double v = value(type);
    if (!(v >= 0 && v < 4294967295.0))
      throw Refused("a face names a vertex by a number that is no index; export it again");
    return static_cast<std::uint32_t>(v);
  }

  void read_face(const PlyProperty& property) {
    const double count = value(*property.counted_by);
    check_count(count);
    if (count == 3) {
      for (int c = 0; c < 3; ++c) part_.indices.push_back(corner(property.type));
      return;
    }
    polygon_ends_.push_back(polygons_.size() + static_cast<std::size_t>(std::max(count, 0.0)));
    while (polygons_.size() < polygon_ends_.back()) polygons_.push_back(corner(property.type));
  }

  // Every other triangle of a strip winds the other way; a negative number ends a strip.
  void read_strip(const PlyProperty& property) {
    const double count = value(*property.counted_by);
    check_count(count);
    std::uint32_t a = 0, b = 0;
    std::size_t length = 0;
    for (double k = 0; k < count; ++k) {
      const double given = value(property.type);
      // Unsigned types write the separator as their largest number.
      if (given < 0 || (property.type == PlyType::u32 && given == 4294967295.0)) {
        length = 0;
        continue;
      }
      const auto c = static_cast<std::uint32_t>(std::min(given, 4294967294.0));
      if (length >= 2 && a != b && b != c && c != a) {
        if (length % 2 == 0)
          part_.indices.insert(part_.indices.end(), {a, b, c});
        else
          part_.indices.insert(part_.indices.end(), {b, a, c});
      }
      a = b, b = c, ++length;
    }
  }

  void cut_polygons() {
    std::size_t first = 0;
    std::vector<glm::dvec3> points;
    std::vector<std::uint32_t> cut;
    for (const std::size_t end : polygon_ends_) {
      points.clear(), cut.clear();
      for (std::size_t k = first; k < end; ++k) {
        if (polygons_[k] >= part_.positions.size())
          throw Refused("a face names vertex " + std::to_string(polygons_[k]) + "; there are " +
                        std::to_string(part_.positions.size()));
        points.push_back(part_.positions[polygons_[k]]);
      }
      const std::size_t size = points.size();
      cut_into_triangles(points, {&size, 1}, cut);
      for (const std::uint32_t c : cut) part_.indices.push_back(polygons_[first + c]);
      first = end;
    }
  }

  const std::string bytes_;
  std::string_view rest_;
  bool text_ = false, big_endian_ = false, rounded_ = false;
  std::vector<PlyElement> elements_;
  Part part_;
  std::vector<std::uint32_t> polygons_;
  std::vector<std::size_t> polygon_ends_;
  std::map<std::string, std::size_t> left_out_;
};

}  // namespace

Model read_ply(const std::filesystem::path& file) { return PlyReader(file).read(); }

}  // namespace vantage::importer
