// SPDX-License-Identifier: Apache-2.0
// E57 (ASTM E2807, Standard Specification for 3D Imaging Data Exchange, 2011): Data3D after Data3D, each moved by its
// pose. Images are passed over.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/coordinate_reference.hpp"
#include "core/utf8.hpp"
#include "import/cloud/e57_records.hpp"
#include "import/cloud/points.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

constexpr std::size_t kNone = SIZE_MAX;

struct Data3d {
  std::uint64_t section = 0, count = 0;
  std::vector<E57RecordField> fields;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  std::size_t field(std::string_view name) const {
    for (std::size_t k = 0; k < fields.size(); ++k)
      if (fields[k].name == name) return k;
    return kNone;
  }
  bool has(std::string_view name) const { return field(name) != kNone; }
};

std::uint64_t whole_number(const XmlElement& points, const char* name) {
  const auto found = points.attributes.find(name);
  std::uint64_t value = 0;
  if (found != points.attributes.end()) {
    const std::string& text = found->second;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure == std::errc() && end == text.data() + text.size()) return value;
  }
  throw Refused("its points have no " + std::string(name) + "; export it again");
}

// Converts a row or column, clamped to its type whatever a file says.
std::uint32_t index_of(double value) {
  return static_cast<std::uint32_t>(std::clamp(value, 0.0, double{std::numeric_limits<std::uint32_t>::max()}));
}

Data3d data_of(const XmlElement& element, const std::string& name) {
  Data3d data;
  const XmlElement* points = element.child("points");
  const XmlElement* prototype = points ? points->child("prototype") : nullptr;
  if (!prototype) throw Refused("its scan " + name + " has no points; export it again");
  data.section = whole_number(*points, "fileOffset"), data.count = whole_number(*points, "recordCount");
  data.fields = e57_fields(*prototype);
  data.translation = {element.number({"pose", "translation", "x"}, 0), element.number({"pose", "translation", "y"}, 0),
                      element.number({"pose", "translation", "z"}, 0)};
  const Eigen::Quaterniond rotation(
      element.number({"pose", "rotation", "w"}, 1), element.number({"pose", "rotation", "x"}, 0),
      element.number({"pose", "rotation", "y"}, 0), element.number({"pose", "rotation", "z"}, 0));
  const double length = rotation.norm();
  if (!data.translation.allFinite() || !std::isfinite(length))
    throw Refused("the pose of its scan " + name + " is not finite; export it again");
  if (length > 0) data.rotation = rotation.normalized();
  return data;
}

class E57Source final : public PointSource {
 public:
  explicit E57Source(const std::filesystem::path& file) : pages_(file) {
    const XmlElement root = parse_xml(pages_.xml());
    take_system(to_utf8(root.text_at("coordinateMetadata")));
    const XmlElement* all = root.child("data3D");
    for (const XmlElement& element : all ? all->children : std::vector<XmlElement>()) {
      CloudScan scan;
      scan.name = to_utf8(element.text_at("name"));
      if (scan.name.empty()) scan.name = "scan " + std::to_string(data_.size() + 1);
      scan.sensor = to_utf8(element.text_at("sensorModel"));
      data_.push_back(data_of(element, scan.name));
      const Data3d& data = data_.back();
      scan.position = data.translation, scan.rotation = data.rotation;
      // A merged cloud has the pose of its frame, so that a pose without translation needs more evidence of a scanner.
      scan.posed = data.translation.norm() > 0 || data.has("sphericalRange") ||
                   (data.has("rowIndex") && data.has("columnIndex"));
      scans_.push_back(scan);
    }
    // Two scans with the same pose have points in a common frame, so that neither pose is the scanner's.
    for (std::size_t a = 0; a < scans_.size(); ++a)
      for (std::size_t b = a + 1; b < scans_.size() && b < a + 64; ++b)
        if (scans_[a].position == scans_[b].position && scans_[a].rotation.coeffs() == scans_[b].rotation.coeffs())
          scans_[a].posed = scans_[b].posed = false;
    if (data_.empty()) throw Refused("it holds no scan; export it again, with its points");
  }

  std::uint64_t announced() const override {
    std::uint64_t sum = 0;
    for (const Data3d& data : data_) sum += data.count;
    return sum;
  }

  void read(const PointSink& sink) override {
    for (std::size_t k = 0; k < data_.size(); ++k)
      read_scan(data_[k], scans_[k].name, static_cast<std::uint32_t>(k), sink);
  }

 private:
  // Lengths of E57 are metres, whatever unit the coordinate system has.
  void take_system(const std::string& text) {
    const auto system = text.empty() ? std::nullopt : read_coordinate_reference(text);
    crs_ = text;
    if (!system) return;
    if (system->kind == CoordinateReference::Kind::geocentric)
      throw Refused("its coordinates are counted from the middle of the earth; project them to metres, e.g. UTM");
    crs_.clear();
    if (system->kind != CoordinateReference::Kind::projected || !system->has_usual_axes()) {
      if (system->kind != CoordinateReference::Kind::local)
        notes_.push_back("its coordinate system " + to_utf8(system->name) +
                         " is left out, as it has not metres with axes east and north");
      return;
    }
    const bool metres = system->first.factor == 1 && (!system->height || system->height->factor == 1);
    crs_ = metres ? (text.starts_with("PROJCS[") || text.starts_with("COMPD_CS[") ? text : system->text)
                  : to_utf8(system->in_metres);
    if (!metres)
      notes_.emplace_back("its coordinate system is not in metres; its points are, as E57 has it, and are taken so");
  }

  // Places, among the fields read, of the first of three coordinates and of the field that marks them as invalid.
  struct Coordinates {
    std::optional<std::size_t> first, state;
  };

  static std::size_t want(const Data3d& data, const std::string& name, const char* field,
                          std::vector<std::size_t>& wanted) {
    const std::size_t k = data.field(field);
    if (data.fields[k].type == E57RecordField::Type::text)
      throw Refused("the field " + std::string(field) + " of its scan " + name + " is a text; export it again");
    wanted.push_back(k);
    return wanted.size() - 1;
  }

  static Coordinates want_coordinates(const Data3d& data, const std::string& name,
                                      const std::array<const char*, 3>& fields, const char* state,
                                      std::vector<std::size_t>& wanted) {
    Coordinates out;
    if (!data.has(fields[0])) return out;
    for (const char* field : fields) {
      if (!data.has(field)) throw Refused("its scan " + name + " has no " + field + "; export it again");
      const std::size_t place = want(data, name, field, wanted);
      if (!out.first) out.first = place;
    }
    if (data.has(state)) out.state = want(data, name, state, wanted);
    return out;
  }

  void read_scan(const Data3d& data, const std::string& name, std::uint32_t scan, const PointSink& sink) {
    std::vector<std::size_t> wanted;
    // Records may have Cartesian and spherical coordinates, each with their own state.
    const Coordinates cartesian =
        want_coordinates(data, name, {"cartesianX", "cartesianY", "cartesianZ"}, "cartesianInvalidState", wanted);
    Coordinates spherical;
    if (!cartesian.first || cartesian.state)
      spherical = want_coordinates(data, name, {"sphericalRange", "sphericalAzimuth", "sphericalElevation"},
                                   "sphericalInvalidState", wanted);
    if (!cartesian.first && !spherical.first)
      throw Refused("its scan " + name + " has neither cartesianX nor sphericalRange; export it again");
    const bool normals = data.has("nor:normalX") && data.has("nor:normalY") && data.has("nor:normalZ");
    const std::size_t first_normal = wanted.size();
    if (normals)
      for (const char* field : {"nor:normalX", "nor:normalY", "nor:normalZ"}) want(data, name, field, wanted);
    const std::size_t first_cell = wanted.size();
    const bool cells = cells_ && data.has("rowIndex") && data.has("columnIndex");
    if (cells) want(data, name, "rowIndex", wanted), want(data, name, "columnIndex", wanted);
    BlockWriter points(sink, scan, normals);
    const Eigen::Matrix3d turn = data.rotation.toRotationMatrix();
    const auto valid = [](const Coordinates& kind, std::span<const double> v) {
      return kind.first && (!kind.state || v[*kind.state] == 0);
    };
    try {
      read_e57_records(pages_, data.section, data.count, data.fields, wanted, [&](std::span<const double> v) {
        Eigen::Vector3d p = Eigen::Vector3d::Zero();
        if (valid(cartesian, v)) {
          const std::size_t at = *cartesian.first;
          p = {v[at], v[at + 1], v[at + 2]};
        } else if (valid(spherical, v)) {
          const std::size_t at = *spherical.first;
          p = v[at] * Eigen::Vector3d(std::cos(v[at + 2]) * std::cos(v[at + 1]),
                                      std::cos(v[at + 2]) * std::sin(v[at + 1]), std::sin(v[at + 2]));
        }
        if (p == Eigen::Vector3d::Zero()) return;  // no return: nothing is that near to a scanner
        const double* n = v.data() + first_normal;
        const Eigen::Vector3f normal =
            normals ? (turn * Eigen::Vector3d(n[0], n[1], n[2])).cast<float>().eval() : Eigen::Vector3f::Zero().eval();
        std::optional<std::array<std::uint32_t, 2>> cell;
        if (cells) cell = {index_of(v[first_cell]), index_of(v[first_cell + 1])};
        points.add(turn * p + data.translation, normal, cell);
      });
    } catch (const Refused& why) {
      throw Refused("scan " + name + ": " + why.what());
    }
    points.flush();
  }

  E57Pages pages_;
  std::vector<Data3d> data_;
};

}  // namespace

std::unique_ptr<PointSource> open_e57(const std::filesystem::path& file) { return std::make_unique<E57Source>(file); }

}  // namespace vantage::importer
