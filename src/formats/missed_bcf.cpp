// SPDX-License-Identifier: Apache-2.0
// BCF 2.1 by buildingSMART's schemas (markup.xsd, visinfo.xsd, version.xsd of release 2.1): elements of an XML file
// come in the order of its schema.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <string_view>

#include "core/atomic_file.hpp"
#include "core/hash.hpp"
#include "core/parallel.hpp"
#include "core/text.hpp"
#include "formats/e57_xml.hpp"
#include "formats/xml_text.hpp"
#include "formats/zip_file.hpp"
#include "map/missed_colours.hpp"
#include "scene/scene_data.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

constexpr double kFieldOfView_deg = 60;  // the widest of BCF 2.1
// Distance of a camera, in radii of the element: all of it is in view from two. From nearer in narrow rooms.
constexpr std::array kDistances{2.2, 1.1};
constexpr double kNearest_m = 0.5;
constexpr std::array kElevations_deg{20.0, 50.0, -20.0};
constexpr std::size_t kAzimuths = 8;
// Points of an element that a camera should see, and by how much a sight ends before them.
constexpr std::size_t kPoints = 16;
constexpr double kBefore_m = 0.01;
// Dates that the schema asks for; equal runs give equal bytes.
constexpr const char* kDate = "1980-01-01T00:00:00Z";

// A UUID of its own for each name.
std::string uuid(std::string_view name, std::uint64_t salt) {
  std::array<std::uint64_t, 2> words{};
  for (std::uint64_t k = 0; k < words.size(); ++k) {
    Hash hash;
    hash.add(2 * salt + k), hash.add_bytes(name.data(), name.size());
    words[k] = hash.value();
  }
  const std::string braced = e57_guid(words[0], words[1]);
  return braced.substr(1, braced.size() - 2);
}

std::string element(const char* name, const std::string& content) {
  return std::string("<") + name + ">" + content + "</" + name + ">";
}

constexpr const char* kXml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";

// Converts points of the survey frame to the coordinates of the model's file, if these are known.
class ModelFrame {
 public:
  explicit ModelFrame(const Scene& scene) {
    const auto defaults = nlohmann::json::parse(scene.defaults_json());
    const auto place = defaults.find("model_in_site");
    if (place == defaults.end()) return;
    known_ = place->is_array() && place->size() == 16 &&
             std::ranges::all_of(*place, [](const nlohmann::json& one) { return one.is_number(); });
    if (!known_) return;
    // The importer's matrix is of (x, z, −y), column after column: a turn about up, with scales, and a shift.
    const auto at = [&](std::size_t k) { return (*place)[k].get<double>(); };
    xx_ = at(0), yx_ = -at(2), xy_ = -at(8), yy_ = at(10), zz_ = at(5);
    shift_ = {at(12), -at(14), at(13)};
    known_ = std::abs(xx_ * yy_ - xy_ * yx_) > 0 && std::abs(zz_) > 0;
  }
  bool known() const { return known_; }
  Vec3 point(const Vec3& survey) const { return direction(survey - shift_); }
  Vec3 direction(const Vec3& d) const {
    const double determinant = xx_ * yy_ - xy_ * yx_;
    return {(yy_ * d.x - xy_ * d.y) / determinant, (xx_ * d.y - yx_ * d.x) / determinant, d.z / zz_};
  }

 private:
  bool known_ = true;
  double xx_ = 1, xy_ = 0, yx_ = 0, yy_ = 1, zz_ = 1;
  Vec3 shift_{};
};

Vec3 unit(const Vec3& v) {
  const double length = std::sqrt(dot(v, v));
  return length > 0 ? v * (1 / length) : Vec3{0, 1, 0};
}

// Surface of one element, survey frame.
struct Body {
  Vec3 centre{};
  double radius_m = 0;
  std::vector<Vec3> points = {};  // spread by area
};

Body body_of(const SceneData& scene, std::span<const std::size_t> meshes) {
  std::vector<Vec3> middles;
  std::vector<double> area_until;
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  double area = 0;
  for (const std::size_t mesh : meshes) {
    const MeshRange& range = scene.ranges[mesh];
    for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t) {
      std::array<Vec3, 3> p{};
      const auto corners = scene.corners(t);
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = widen(corners[k]) + scene.origin;
        low = {std::min(low.x, p[k].x), std::min(low.y, p[k].y), std::min(low.z, p[k].z)};
        high = {std::max(high.x, p[k].x), std::max(high.y, p[k].y), std::max(high.z, p[k].z)};
      }
      const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
      middles.push_back((p[0] + p[1] + p[2]) * (1.0 / 3));
      area_until.push_back(area += std::sqrt(dot(normal, normal)) / 2);
    }
  }
  Body body{.centre = (low + high) * 0.5, .radius_m = std::sqrt(dot(high - low, high - low)) / 2};
  for (std::size_t k = 0; k < kPoints; ++k) {
    const double wanted = (static_cast<double>(k) + 0.5) / kPoints * area;
    const auto at = std::ranges::lower_bound(area_until, wanted);
    body.points.push_back(at == area_until.end() ? body.centre
                                                 : middles[static_cast<std::size_t>(at - area_until.begin())]);
  }
  return body;
}

struct Camera {
  Vec3 eye, direction, up;
};

// Returns the place that sees most points of the element; the first place of all if none sees any.
Camera camera_at(const Body& body, const ClashChecker& clash) {
  Vec3 best{};
  std::ptrdiff_t most = -1;
  for (const double radii : kDistances)
    for (const double elevation_deg : kElevations_deg)
      for (std::size_t k = 0; k < kAzimuths; ++k) {
        const double azimuth = (static_cast<double>(k) + 0.5) / kAzimuths * 2 * std::numbers::pi,
                     elevation = elevation_deg * std::numbers::pi / 180;
        const Vec3 way{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                       std::sin(elevation)};
        const Vec3 eye = body.centre + way * std::max(radii * body.radius_m, kNearest_m);
        const auto seen = std::ranges::count_if(
            body.points, [&](const Vec3& point) { return clash.sees(eye, point + unit(eye - point) * kBefore_m); });
        if (seen > most) most = seen, best = eye;
      }
  const Vec3 direction = unit(body.centre - best);
  return {best, direction, unit(Vec3{0, 0, 1} - direction * direction.z)};
}

std::string vector_text(const char* name, const Vec3& v) {
  constexpr int kDigits = 6;
  return element(name, element("X", fixed(v.x, kDigits)) + element("Y", fixed(v.y, kDigits)) +
                           element("Z", fixed(v.z, kDigits))) +
         "\n";
}

std::string viewpoint_text(const ElementShare& of, const std::string& guid, const std::optional<Camera>& camera) {
  std::string text = std::string(kXml) + "<VisualizationInfo Guid=\"" + guid + "\">\n<Components>\n";
  text += "<Selection><Component IfcGuid=\"" + of.global_id + "\"/></Selection>\n";
  text += "<Visibility DefaultVisibility=\"true\"/>\n</Components>\n";
  if (camera) {
    text += "<PerspectiveCamera>\n" + vector_text("CameraViewPoint", camera->eye) +
            vector_text("CameraDirection", camera->direction) + vector_text("CameraUpVector", camera->up);
    text += element("FieldOfView", number(kFieldOfView_deg)) + "\n</PerspectiveCamera>\n";
  }
  return text + "</VisualizationInfo>\n";
}

// "IfcWall North wall" of "IfcWall North wall 2O2Fr$t4X7Zf8NOew3FLOH"
std::string title_of(const ElementShare& of) {
  return of.name.substr(0, of.name.size() - std::min(of.name.size(), of.global_id.size() + 1));
}

std::string description_of(const ElementShare& of, std::span<const MissedShare> shares) {
  std::string text = "Of " + fixed(of.area_m2, 2) + " m² of surface, " + percent(of.captured.value_or(0)) +
                     " of the wanted points are captured.";
  const auto share = std::ranges::find(shares, of.name, &MissedShare::node);
  if (share == shares.end()) return text;
  std::string reasons;
  for (const MissedStyle& style : kMissedStyles)
    if (const double part = share->share(style.why); style.why != WhyMissed::captured && part >= 0.0005)
      reasons += (reasons.empty() ? " The rest: " : ", ") + std::string(style.words) + " " + percent(part);
  return text + (reasons.empty() ? "" : reasons + ".");
}

std::string markup_text(const ElementShare& of, std::span<const MissedShare> shares, const std::string& topic,
                        const std::string& viewpoint, std::size_t index) {
  std::string text =
      std::string(kXml) + "<Markup>\n<Topic Guid=\"" + topic + "\" TopicType=\"Issue\" TopicStatus=\"Open\">\n";
  text += element("Title", "Not captured: " + xml_text(title_of(of))) + "\n" + element("Index", number(index)) + "\n";
  text += element("Labels", "Laser scan") + "\n" + element("CreationDate", kDate) + "\n" +
          element("CreationAuthor", "vantage") + "\n";
  text += element("Description", xml_text(description_of(of, shares))) + "\n</Topic>\n";
  text += "<Viewpoints Guid=\"" + viewpoint + "\">" + element("Viewpoint", "viewpoint.bcfv") + "</Viewpoints>\n";
  return text + "</Markup>\n";
}

}  // namespace

std::size_t write_missed_bcf(const std::filesystem::path& file, std::span<const ElementShare> elements,
                             std::span<const MissedShare> shares, Site& site, double most_captured,
                             std::size_t most_topics) {
  std::vector<const ElementShare*> missed;
  for (const ElementShare& one : elements)
    if (!one.global_id.empty() && one.captured && *one.captured < most_captured) missed.push_back(&one);
  std::ranges::stable_sort(missed, std::greater<>(), [](const ElementShare* one) { return one->area_m2; });
  missed.resize(std::min(missed.size(), most_topics));
  if (missed.empty()) return 0;

  const SceneData& scene = site.scene().data();
  std::map<std::string_view, std::vector<std::size_t>> meshes;
  for (const ElementShare* one : missed) meshes[one->name];
  for (std::size_t m = 0; m < scene.meshes.size(); ++m)
    if (const auto of = meshes.find(scene.meshes[m].name); of != meshes.end() && scene.meshes[m].role == Role::surveyed)
      of->second.push_back(m);
  const ModelFrame frame(site.scene());
  const ClashChecker& clash = site.clash();
  std::vector<std::pair<std::string, std::string>> files(1 + 2 * missed.size());
  files.front() = {"bcf.version", std::string(kXml) + "<Version VersionId=\"2.1\">" +
                                      element("DetailedVersion", "2.1") + "</Version>\n"};
  parallel::for_all(std::size_t{0}, missed.size(), [&](std::size_t k) {
    const ElementShare& of = *missed[k];
    std::optional<Camera> camera;
    if (frame.known()) {
      camera = camera_at(body_of(scene, meshes.at(of.name)), clash);
      camera =
          Camera{frame.point(camera->eye), unit(frame.direction(camera->direction)), unit(frame.direction(camera->up))};
    }
    const std::string topic = uuid(of.name, 0), viewpoint = uuid(of.name, 1);
    files[1 + 2 * k] = {topic + "/markup.bcf", markup_text(of, shares, topic, viewpoint, k)};
    files[2 + 2 * k] = {topic + "/viewpoint.bcfv", viewpoint_text(of, viewpoint, camera)};
  });
  write_atomically(file, zip_archive(files));
  return missed.size();
}

}  // namespace vantage
