// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/text.hpp"
#include "report/chart.hpp"
#include "report/pictures.hpp"
#include "report/relief.hpp"
#include "report/search_tint.hpp"
#include "report/spread.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

constexpr double kMostWidth = 9;  // of the strongest link
constexpr double kStrong = 0.1;   // if none is stronger, a link of this overlap would be as wide
constexpr double kDisc = 10.5;    // radius of a station's number
constexpr std::size_t kPixelsPerUnit = 2, kSupersampling = 2;
constexpr Colour kStation{0.10, 0.22, 0.45}, kLink{0.16, 0.34, 0.66}, kSkipped{0.72, 0.12, 0.12};

// What the map must show: surveyed meshes, search area and stations; ground that reaches further is cut off.
Box window_of(const SceneData& scene, const SearchMesh& mesh, std::span<const PlacedStation> stations) {
  Box box;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    if (scene.meshes[m].role != Role::surveyed) continue;
    const MeshRange& range = scene.ranges[m];
    for (std::uint32_t t = range.first_triangle; t < range.first_triangle + range.triangle_count; ++t)
      for (const std::uint32_t v : scene.triangles[t])
        box.extend(scene.origin + Vec3{scene.positions[v].x, scene.positions[v].y, scene.positions[v].z});
  }
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) box.extend(mesh.positions[v]);
  for (const PlacedStation& s : stations)
    if (s.status != StationStatus::hole) box.extend(s.position);
  if (box.empty())
    throw Error(Errc::invalid_argument, "draw_plan_view: there is neither a surveyed mesh nor a search area");
  const double margin = 0.03 * std::max({box.size().x, box.size().y, 0.1});
  box.min = box.min - Vec3{margin, margin, 0}, box.max = box.max + Vec3{margin, margin, 0};
  return box;
}

// Below a roof a map would show the roof. Where most of the search area is covered, the site is cut just above the
// scanners.
double section_height(const SearchMesh& mesh, const HeightBuffer& heights, const SceneData& scene,
                      std::span<const PlacedStation> stations) {
  const MapWindow& w = heights.window;
  double covered = 0, all = 0;
  std::vector<double> grounds;
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const Vec3 centre = (a + b + c) * (1.0 / 3), n = cross(b - a, c - a);
    const double area = std::abs(n.z) / 2;
    const double column = (centre.x - w.x_min) / w.pixel_m, row = (w.y_max - centre.y) / w.pixel_m;
    if (column < 0 || row < 0 || column >= static_cast<double>(w.columns) || row >= static_cast<double>(w.rows))
      continue;
    const float top = heights.z[static_cast<std::size_t>(row) * w.columns + static_cast<std::size_t>(column)];
    all += area;
    if (double{top} + scene.origin.z > centre.z + 1.5) covered += area;
    grounds.push_back(centre.z);
  }
  if (!(covered > 0.5 * all)) return std::numeric_limits<double>::infinity();
  double head = std::numeric_limits<double>::lowest();
  for (const PlacedStation& s : stations)
    if (s.status != StationStatus::hole) head = std::max(head, s.position.z);
  if (head > std::numeric_limits<double>::lowest()) return head + 0.2;
  std::nth_element(grounds.begin(), grounds.begin() + static_cast<std::ptrdiff_t>(grounds.size() / 2), grounds.end());
  return grounds[grounds.size() / 2] + 2;
}

double link_width(double overlap, double most) { return 0.8 + (kMostWidth - 0.8) * overlap / most; }
double link_opacity(double overlap, double most) { return 0.35 + 0.55 * overlap / most; }

void draw_station(Canvas& canvas, Point at, std::size_t number, bool skipped) {
  canvas.disc(at, kDisc + 1.3, {1, 1, 1});
  if (skipped) {  // the cross sticks out from under the number
    const double r = 1.25 * kDisc;
    for (const double side : {-1.0, 1.0})
      canvas.line({at.x - r, at.y - side * r}, {at.x + r, at.y + side * r}, {.colour = kSkipped, .width = 3});
  }
  canvas.disc(at, kDisc, skipped ? Colour{0.93, 0.93, 0.94} : kStation);
  canvas.text(at, std::to_string(number),
              {.size = 11.5, .bold = true, .colour = skipped ? kSkipped : Colour{1, 1, 1}, .across = Align::middle});
}

// A bar of a round length, at most `widest` wide.
void draw_scale_bar(Canvas& canvas, Point at, double widest, double metre) {
  double length = std::pow(10.0, std::floor(std::log10(widest / metre)));
  for (const double factor : {5.0, 2.0})
    if (factor * length * metre <= widest) {
      length *= factor;
      break;
    }
  const double width = length * metre;
  canvas.line(at, {at.x + width, at.y}, {.width = 2});
  for (const double end : {at.x, at.x + width}) canvas.line({end, at.y - 4}, {end, at.y + 4}, {.width = 2});
  canvas.text({at.x + width / 2, at.y - 14}, number(length) + " m", {.size = 12.5, .across = Align::middle});
}

}  // namespace

std::unique_ptr<Canvas> plan_view_picture(const Scene& scene, const SearchArea& area,
                                          std::span<const PlacedStation> stations, const OverlapMatrix& overlap,
                                          double link_overlap, const std::string& title) {
  if (overlap.size() != stations.size() && overlap.size() != 0)
    throw Error(Errc::invalid_argument, "draw_plan_view: " + std::to_string(stations.size()) +
                                            " stations, but an overlap matrix of " + std::to_string(overlap.size()));
  const SceneData& data = scene.data();
  const SearchMesh& mesh = area.mesh();
  const Box window = window_of(data, mesh, stations);
  const double metre = std::min(700 / window.size().x, 640 / window.size().y);  // canvas units
  const Rect map{86, 68, std::floor(window.size().x * metre), std::floor(window.size().y * metre)};
  const auto count = [&](StationStatus status) {
    return std::count_if(stations.begin(), stations.end(), [&](const PlacedStation& s) { return s.status == status; });
  };
  const auto holes = count(StationStatus::hole);
  const auto skipped =
      std::count_if(stations.begin(), stations.end(), [](const PlacedStation& s) { return !active(s); }) - holes;
  constexpr double kPanel = 224;
  const double panel_height = 352 + (skipped > 0 ? 28 : 0) + (holes > 0 ? 45 : 0);  // what the legend may need
  auto page = std::make_unique<Canvas>(map.right() + 26 + kPanel, std::max(map.bottom() + 64, map.y + panel_height));
  Canvas& canvas = *page;

  const std::size_t fine = kPixelsPerUnit * kSupersampling;
  const MapWindow pixels{.x_min = window.min.x,
                         .y_max = window.max.y,
                         .pixel_m = 1 / (metre * static_cast<double>(fine)),
                         .columns = static_cast<std::size_t>(map.width) * fine,
                         .rows = static_cast<std::size_t>(map.height) * fine};
  HeightBuffer heights = look_from_above(data, pixels, std::numeric_limits<double>::infinity());
  const double cut = section_height(mesh, heights, data, stations);
  if (std::isfinite(cut)) heights = look_from_above(data, pixels, cut);
  std::string subtitle = "Site from above";
  if (std::isfinite(cut)) subtitle += ", cut at z = " + fixed(cut, 1) + " m";
  if (mesh.triangles.size() > 0 && area.derived()) subtitle += "; search area derived from walkable surfaces";
  const Chart chart(
      canvas, map, {.label = "x (m)", .low = window.min.x, .high = window.min.x + map.width / metre, .wanted_ticks = 7},
      {.label = "y (m)", .low = window.max.y - map.height / metre, .high = window.max.y, .wanted_ticks = 7}, title,
      subtitle);
  std::vector<std::uint32_t> site = shade(data, heights);
  tint_search_area(site, heights, data.origin.z, mesh);
  canvas.image(map, halve(site, pixels.columns), pixels.columns / 2);
  canvas.rectangle(map, {.colour = style::faint, .width = 1});

  // Stations: a disc with its number, moved aside with a leader where several stand close together.
  std::vector<std::size_t> shown;
  std::vector<Point> anchors;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (stations[i].status == StationStatus::hole) continue;
    shown.push_back(i);
    anchors.push_back(chart.at(stations[i].position.x, stations[i].position.y));
  }
  std::vector<Point> discs = spread(anchors, kDisc);
  for (Point& p : discs)
    p = {std::clamp(p.x, map.x + kDisc, map.right() - kDisc), std::clamp(p.y, map.y + kDisc, map.bottom() - kDisc)};

  struct Link {
    std::size_t a, b;
    double overlap;
    bool bridge;
  };
  std::vector<Link> links;
  double most = 0;
  bool any_bridge = false;
  if (overlap.size() == stations.size()) {
    const auto bridges = connectivity(overlap, link_overlap).bridges;
    for (std::size_t a = 0; a < shown.size(); ++a) {
      for (std::size_t b = a + 1; b < shown.size(); ++b) {
        const double value = overlap(shown[a], shown[b]);
        if (value < link_overlap || value <= 0) continue;
        const bool bridge = std::binary_search(bridges.begin(), bridges.end(), std::pair{shown[a], shown[b]});
        links.push_back({a, b, value, bridge});
        any_bridge = any_bridge || bridge;
        most = std::max(most, value);
      }
    }
  }
  const double scale = std::max(most, kStrong);
  std::sort(links.begin(), links.end(), [](const Link& a, const Link& b) { return a.overlap < b.overlap; });
  for (const Link& link : links) {
    const double width = link_width(link.overlap, scale);
    canvas.line(discs[link.a], discs[link.b], {.colour = {1, 1, 1}, .width = width + 1.6, .opacity = 0.45});
    canvas.line(
        discs[link.a], discs[link.b],
        {.colour = link.bridge ? style::orange : kLink, .width = width, .opacity = link_opacity(link.overlap, scale)});
  }
  for (std::size_t k = 0; k < shown.size(); ++k) {
    if (std::hypot(discs[k].x - anchors[k].x, discs[k].y - anchors[k].y) < 2) continue;
    canvas.line(anchors[k], discs[k], {.colour = kStation, .width = 1.4});
    canvas.disc(anchors[k], 3, kStation);
  }
  for (std::size_t k = 0; k < shown.size(); ++k)
    draw_station(canvas, discs[k], shown[k] + 1, !active(stations[shown[k]]));
  const double left = map.right() + 24;
  Point at{left, map.y + 8};
  const auto words = [&](const std::string& text) { canvas.text({at.x + 34, at.y}, text, {.size = 12.5}); };
  const auto swatch = [&](const Colour& colour, const std::string& text) {
    canvas.fill({at.x, at.y - 7, 24, 14}, colour);
    words(text);
    at.y += 24;
  };
  const bool blocking =
      std::any_of(data.meshes.begin(), data.meshes.end(), [](const MeshInfo& m) { return m.role == Role::blocking; });
  swatch(kSurveyedTint, "surveyed");
  if (blocking) swatch(kBlockingTint, "not surveyed");
  canvas.fill({at.x, at.y - 7, 24, 14}, kBlockingTint);
  canvas.fill({at.x, at.y - 7, 24, 14}, kSearchTint, kSearchOpacity);
  canvas.rectangle({at.x + 0.5, at.y - 6.5, 23, 13}, {.colour = kSearchTint, .width = 1, .opacity = kSearchRim});
  words("search area");
  at.y += 28;
  draw_station(canvas, {at.x + 12, at.y}, 1, false);
  words("station");
  at.y += 28;
  if (skipped > 0) {
    draw_station(canvas, {at.x + 12, at.y}, 2, true);
    words("skipped: clash");
    at.y += 28;
  }
  if (holes > 0) {
    canvas.text(at, std::to_string(holes) + (holes == 1 ? " station in a hole," : " stations in holes,"),
                {.size = 12.5});
    canvas.text({at.x, at.y + 17}, "not shown", {.size = 12.5});
    at.y += 45;
  }
  if (!links.empty()) {
    at.y += 6;
    canvas.text(at, "Overlap of two stations", {.size = 12.5, .bold = true});
    at.y += 22;
    std::vector<double> samples = nice_ticks(0, scale, 3);
    std::erase_if(samples, [&](double v) { return v < link_overlap; });
    const auto labels = tick_labels(samples);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      canvas.line(
          {at.x, at.y}, {at.x + 24, at.y},
          {.colour = kLink, .width = link_width(samples[k], scale), .opacity = link_opacity(samples[k], scale)});
      words(labels[k]);
      at.y += 22;
    }
    if (any_bridge) {
      canvas.line({at.x, at.y}, {at.x + 24, at.y}, {.colour = style::orange, .width = 3, .opacity = 0.8});
      words("the only link of two parts");
      at.y += 22;
    }
    canvas.text(at, "largest " + fixed(most, 3), {.size = 12.5, .colour = style::faint});
    canvas.text({at.x, at.y + 17}, "below " + number(link_overlap) + " not drawn",
                {.size = 12.5, .colour = style::faint});
  } else if (stations.size() > 1 && overlap.size() == stations.size()) {
    canvas.text({at.x, at.y + 6}, "no overlap above " + number(link_overlap), {.size = 12.5, .colour = style::faint});
  }
  draw_scale_bar(canvas, {left + 1, std::max(map.bottom() - 6, at.y + 60)}, kPanel - 40, metre);
  return page;
}

void draw_plan_view(const std::filesystem::path& file, const Scene& scene, const SearchArea& area,
                    std::span<const PlacedStation> stations, const OverlapMatrix& overlap, const std::string& title,
                    double link_overlap) {
  plan_view_picture(scene, area, stations, overlap, link_overlap, title)->save(file);
}

}  // namespace vantage
