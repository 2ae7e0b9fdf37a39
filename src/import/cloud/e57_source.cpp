// SPDX-License-Identifier: Apache-2.0
// E57 (ASTM E2807, Standard Specification for 3D Imaging Data Exchange, 2011): Data3D after Data3D, each moved by its
// pose. Images are passed over.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

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

// A row or column, held within its type whatever a file says.
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
    crs_ = to_utf8(root.text_at("coordinateMetadata"));
    const XmlElement* all = root.child("data3D");
    for (const XmlElement& element : all ? all->children : std::vector<XmlElement>()) {
      CloudScan scan;
      scan.name = to_utf8(element.text_at("name"));
      if (scan.name.empty()) scan.name = "scan " + std::to_string(data_.size() + 1);
      scan.sensor = to_utf8(element.text_at("sensorModel"));
      data_.push_back(data_of(element, scan.name));
      const Data3d& data = data_.back();
      scan.position = data.translation, scan.rotation = data.rotation;
      // A cloud that was merged has a pose, too: that of its frame.
      scan.posed = data.translation.norm() > 0 || data.has("sphericalRange") ||
                   (data.has("rowIndex") && data.has("columnIndex"));
      scans_.push_back(scan);
    }
    // Scans are not taken from one place; where it seems so, their points were moved into a common frame.
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
  void read_scan(const Data3d& data, const std::string& name, std::uint32_t scan, const PointSink& sink) {
    const bool cartesian = data.has("cartesianX");
    const std::array<const char*, 3> names =
        cartesian ? std::array{"cartesianX", "cartesianY", "cartesianZ"}
                  : std::array{"sphericalRange", "sphericalAzimuth", "sphericalElevation"};
    const bool normals = data.has("nor:normalX") && data.has("nor:normalY") && data.has("nor:normalZ");
    const char* state = cartesian ? "cartesianInvalidState" : "sphericalInvalidState";
    std::vector<std::size_t> wanted;
    for (const char* field : names) {
      if (!data.has(field)) throw Refused("its scan " + name + " has no " + field + "; export it again");
      wanted.push_back(data.field(field));
    }
    if (normals)
      for (const char* field : {"nor:normalX", "nor:normalY", "nor:normalZ"}) wanted.push_back(data.field(field));
    const std::size_t first_cell = wanted.size();
    const bool cells = cells_ && data.has("rowIndex") && data.has("columnIndex");
    if (cells) wanted.push_back(data.field("rowIndex")), wanted.push_back(data.field("columnIndex"));
    const bool stated = data.has(state);
    if (stated) wanted.push_back(data.field(state));
    for (const std::size_t field : wanted)
      if (data.fields[field].type == E57RecordField::Type::text)
        throw Refused("the field " + data.fields[field].name + " of its scan " + name + " is a text; export it again");
    BlockWriter points(sink, scan, normals);
    const Eigen::Matrix3d turn = data.rotation.toRotationMatrix();
    try {
      read_e57_records(pages_, data.section, data.count, data.fields, wanted, [&](std::span<const double> v) {
        if (stated && v.back() != 0) return;
        Eigen::Vector3d p(v[0], v[1], v[2]);
        if (!cartesian)
          p = v[0] * Eigen::Vector3d(std::cos(v[2]) * std::cos(v[1]), std::cos(v[2]) * std::sin(v[1]), std::sin(v[2]));
        const Eigen::Vector3f normal =
            normals ? (turn * Eigen::Vector3d(v[3], v[4], v[5])).cast<float>().eval() : Eigen::Vector3f::Zero().eval();
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
