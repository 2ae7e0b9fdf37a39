// SPDX-License-Identifier: Apache-2.0
// PLY (Turk, The PLY Polygon File Format, 1994) without faces: text, or binary in either order of bytes.
#include <algorithm>
#include <array>
#include <cmath>

#include "import/cloud/points.hpp"
#include "import/cloud/scalar_field.hpp"

namespace vantage::importer {
namespace {

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::size_t bytes = 0;
  std::vector<ScalarField> fields;
  bool lists = false;
};

ScalarField scalar(std::string_view type, std::string_view name) {
  struct Known {
    std::string_view name, other;
    char kind;
    std::size_t bytes;
  };
  constexpr std::array kKnown{Known{"char", "int8", 'I', 1},     Known{"uchar", "uint8", 'U', 1},
                              Known{"short", "int16", 'I', 2},   Known{"ushort", "uint16", 'U', 2},
                              Known{"int", "int32", 'I', 4},     Known{"uint", "uint32", 'U', 4},
                              Known{"float", "float32", 'F', 4}, Known{"double", "float64", 'F', 8}};
  for (const Known& known : kKnown)
    if (type == known.name || type == known.other) return {std::string(name), known.kind, known.bytes};
  throw Refused("its property " + std::string(name.substr(0, 40)) + " has no type that PLY knows; export it again");
}

class PlySource final : public PointSource {
 public:
  explicit PlySource(const std::filesystem::path& path) : file_(path) {
    read_header();
    const auto vertices = std::ranges::find(elements_, "vertex", &Element::name);
    if (vertices == elements_.end()) throw Refused("it has no vertices; export it again");
    vertex_ = static_cast<std::size_t>(vertices - elements_.begin());
    for (std::size_t k = 0; k <= vertex_; ++k)
      if (elements_[k].lists) throw Refused("it has lists before or in its vertices; export its points alone");
    for (const char* name : {"x", "y", "z"}) place_.push_back(index_of(name));
    normal_ = find_fields(elements_[vertex_].fields, {"nx", "ny", "nz"});
    used_ = place_;
    used_.insert(used_.end(), normal_.begin(), normal_.end());
    data_ = file_.place();
    scans_.push_back({});
  }

  std::uint64_t announced() const override { return elements_[vertex_].count; }
  bool metric() const override { return metric_; }
  bool floats() const override { return !text_ && origin_.isZero(0) && are_floats(elements_[vertex_].fields, place_); }

  void read(const PointSink& sink) override {
    file_.seek(data_);
    BlockWriter points(sink, 0, !normal_.empty());
    for (std::size_t e = 0; e < vertex_; ++e) skip(elements_[e]);
    const Element& element = elements_[vertex_];
    if (!text_ && element.count > file_.left() / element.bytes)
      throw Refused("it is truncated: its header announces " + std::to_string(element.count) +
                    " points; copy or export it again");
    std::vector<double> values(element.fields.size());
    for (std::uint64_t k = 0; k < element.count; ++k) {
      if (text_) {
        auto line = file_.line();
        if (!line)
          throw Refused("it is truncated: it ends after " + std::to_string(k) + " of " + std::to_string(element.count) +
                        " points; copy or export it again");
        for (double& value : values) {
          const auto number = number_of(next_word(*line));
          if (!number)
            throw Refused("point " + std::to_string(k + 1) + " has no number where one belongs; export it again");
          value = *number;
        }
      } else {
        const char* record = file_.take(element.bytes);
        for (const std::size_t f : used_) values[f] = element.fields[f].value(record, big_endian_);
      }
      Eigen::Vector3f normal = Eigen::Vector3f::Zero();
      if (!normal_.empty())
        normal = Eigen::Vector3d(values[normal_[0]], values[normal_[1]], values[normal_[2]]).cast<float>();
      points.add(origin_ + Eigen::Vector3d(values[place_[0]], values[place_[1]], values[place_[2]]), normal);
    }
    points.flush();
  }

 private:
  void read_header() {
    constexpr int kMostLines = 10'000;
    bool format = false;
    for (int k = 0; k < kMostLines; ++k) {
      const auto whole = file_.line();
      if (!whole) break;
      std::string_view line = *whole;
      const std::string_view word = next_word(line);
      if (word == "format") {
        const std::string_view kind = next_word(line);
        text_ = kind == "ascii", big_endian_ = kind == "binary_big_endian", format = true;
        if (!text_ && !big_endian_ && kind != "binary_little_endian")
          throw Refused("it is of no format that PLY knows; export it again");
      } else if (word == "comment") {
        const std::string_view about = next_word(line);
        own_ |= about == "vantage";
        metric_ |= own_ || about == "crs";
        if (own_ && about == "origin") read_origin(line);
        if (about == "crs") crs_ = line.substr(std::min(line.find_first_not_of(' '), line.size()));
      } else if (word == "element") {
        Element element;
        element.name = next_word(line);
        element.count = count_of(next_word(line), "the number of its elements");
        elements_.push_back(element);
      } else if (word == "property") {
        if (elements_.empty()) throw Refused("its header names a property before any element; export it again");
        Element& element = elements_.back();
        const std::string_view type = next_word(line);
        if (type == "list") {
          element.lists = true;
          continue;
        }
        ScalarField field = scalar(type, next_word(line));
        field.at = element.bytes;
        element.bytes += field.bytes;
        element.fields.push_back(field);
      } else if (word == "end_header") {
        if (!format) throw Refused("its header names no format; export it again");
        return;
      }
    }
    throw Refused("its header does not end; copy or export it again");
  }

  void read_origin(std::string_view line) {
    for (double& value : origin_) {
      const auto number = number_of(next_word(line));
      if (!number || !std::isfinite(*number))
        throw Refused("its comment tells an origin that is no place; export it again");
      value = *number;
    }
  }

  std::size_t index_of(const char* name) const {
    const std::size_t k = find_field(elements_[vertex_].fields, name);
    if (k == elements_[vertex_].fields.size())
      throw Refused("its vertices have no " + std::string(name) + "; export it again");
    return k;
  }
  void skip(const Element& element) {
    if (text_) {
      for (std::uint64_t k = 0; k < element.count && file_.line(); ++k) {
      }
    } else if (element.bytes > 0) {
      if (element.count > file_.left() / element.bytes) throw Refused("it is truncated; copy or export it again");
      file_.seek(file_.place() + element.count * element.bytes);
    }
  }

  ByteFile file_;
  bool text_ = false, big_endian_ = false;
  bool own_ = false;  // this program wrote it
  bool metric_ = false;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  // added to what the points hold
  std::vector<Element> elements_;
  std::size_t vertex_ = 0;
  std::vector<std::size_t> place_, normal_, used_;  // fields; used_: place_ and normal_
  std::uint64_t data_ = 0;
};

}  // namespace

std::unique_ptr<PointSource> open_ply(const std::filesystem::path& file) { return std::make_unique<PlySource>(file); }

}  // namespace vantage::importer
