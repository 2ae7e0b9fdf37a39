// SPDX-License-Identifier: Apache-2.0
#include "export/plan_map.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/text.hpp"
#include "export/chart.hpp"
#include "export/covered_floor.hpp"
#include "export/left_out_hatch.hpp"
#include "export/place_discs.hpp"
#include "export/relief.hpp"
#include "export/search_tint.hpp"
#include "export/section.hpp"
#include "export/shown_links.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr double kLeastWidth = 0.8, kMostWidth = 9;  // of links without overlap, and at the end of the scale
constexpr std::size_t kPixelsPerUnit = 2, kSupersampling = 2;
constexpr Colour kStation{0.10, 0.22, 0.45}, kKept{0.42, 0.16, 0.44}, kLink{0.16, 0.34, 0.66},
    kSkipped{0.72, 0.12, 0.12};
// A plan is cut at 1.2 m above the floor, between window sills and lintels, for a scanner at 1.85 m. Other head
// heights, as in models of unusual size, scale it.
constexpr double kCutHeight = 1.2, kCutShare = 1.2 / 1.85;

double cut_above(std::span<const PlacedStation> stations) {
  std::vector<double> heights;
  for (const PlacedStation& s : stations)
    if (s.status != StationStatus::hole && s.position.z > s.ground.z) heights.push_back(s.position.z - s.ground.z);
  if (heights.empty()) return kCutHeight;
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return kCutShare * *middle;
}

SearchMesh mesh_of(const SearchMesh& mesh, const PlanLevel& level) {
  SearchMesh part{.positions = mesh.positions, .uvs = mesh.uvs, .triangles = {}};
  for (const auto& t : mesh.triangles)
    if (level.holds((mesh.positions[t[0]].z + mesh.positions[t[1]].z + mesh.positions[t[2]].z) / 3))
      part.triangles.push_back(t);
  return part;
}

void paint_section(std::vector<std::uint32_t>& pixels, const Section& section, const MapWindow& window) {
  const auto c = to_bytes(kCutTint);
  const std::uint32_t fill = 0xFF000000u | std::uint32_t{c[0]} << 16 | std::uint32_t{c[1]} << 8 | c[2];
  for (std::size_t k = 0; k < pixels.size(); ++k)
    if (section.solid[k]) pixels[k] = fill;
  constexpr double kHalf = 0.5 * kPixelsPerUnit * kSupersampling;  // a line of one unit
  for (const auto& [a, b] : section.outlines) {
    const int steps = static_cast<int>(std::ceil(std::max(std::abs(b.x - a.x), std::abs(b.y - a.y)))) + 1;
    for (int s = 0; s <= steps; ++s) {
      const double t = static_cast<double>(s) / steps, x = a.x + t * (b.x - a.x), y = a.y + t * (b.y - a.y);
      const auto [x0, x1] = pixels_between(x - kHalf, x + kHalf, window.columns);
      const auto [y0, y1] = pixels_between(y - kHalf, y + kHalf, window.rows);
      for (std::size_t j = y0; j < y1; ++j)
        for (std::size_t i = x0; i < x1; ++i) pixels[j * window.columns + i] = fill;
    }
  }
}

// The stations of one map, with their links.
class Stations {
 public:
  Stations(Canvas& canvas, const Chart& chart, const PlanView& view, const PlanLevel* level)
      : canvas_(canvas), map_(chart.area()), view_(view), level_(level) {
    for (std::size_t i = 0; i < view.stations.size(); ++i) {
      const PlacedStation& s = view.stations[i];
      if (s.status == StationStatus::hole) continue;
      shown_.push_back(i);
      spots_.push_back(chart.at(s.position.x, s.position.y));
    }
    std::vector<Point> here;
    for (std::size_t k = 0; k < shown_.size(); ++k)
      if (on_level(k)) here.push_back(spots_[k]);
    const auto placed = place_discs(here, kDisc, map_);
    discs_ = spots_;
    for (std::size_t k = 0, next = 0; k < shown_.size(); ++k)
      if (on_level(k)) discs_[k] = placed[next++];
  }

  void draw(PlanMapContent& content) {
    draw_links(content);
    draw_ellipses();
    for (std::size_t k = 0; k < shown_.size(); ++k)
      if (!on_level(k)) draw_elsewhere(canvas_, spots_[k], name(k)), content.elsewhere = true;
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      if (!moved(k)) continue;
      content.moved = true;
      canvas_.line(spots_[k], discs_[k], {.colour = {1, 1, 1}, .width = 3.4, .opacity = 0.8});
      canvas_.line(spots_[k], discs_[k], {.colour = colour(k), .width = 1.5});
    }
    for (std::size_t k = 0; k < shown_.size(); ++k)
      if (on_level(k)) draw_station(canvas_, discs_[k], name(k), station(k));
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      if (!moved(k)) continue;
      canvas_.disc(spots_[k], 4.6, {1, 1, 1});
      canvas_.disc(spots_[k], 3.4, colour(k));
    }
    draw_labels();
  }

 private:
  const PlacedStation& station(std::size_t k) const { return view_.stations[shown_[k]]; }
  const std::string& name(std::size_t k) const { return view_.names[shown_[k]]; }
  bool on_level(std::size_t k) const { return !level_ || level_->holds(station(k).ground.z); }
  bool moved(std::size_t k) const { return std::hypot(discs_[k].x - spots_[k].x, discs_[k].y - spots_[k].y) > 0.5; }
  Colour colour(std::size_t k) const { return station(k).kept ? kKept : kStation; }

  void draw_links(PlanMapContent& content) {
    if (view_.links.values.size() != view_.stations.size()) return;
    std::vector<ShownLink> links;
    const auto bridges = connectivity(view_.links.values, view_.links.least).bridges;
    for (std::size_t a = 0; a < shown_.size(); ++a) {
      for (std::size_t b = a + 1; b < shown_.size(); ++b) {
        const double value = view_.links.values(shown_[a], shown_[b]);
        if (value < view_.links.least || value <= 0 || (!on_level(a) && !on_level(b))) continue;
        const bool bridge = std::binary_search(bridges.begin(), bridges.end(), std::pair{shown_[a], shown_[b]});
        links.push_back({a, b, value, bridge});
        content.bridge = content.bridge || bridge;
        content.largest = std::max(content.largest, value);
      }
    }
    const std::size_t all = links.size();
    links = shown_links(std::move(links), shown_.size());
    content.hidden_links += all - links.size();
    for (const ShownLink& link : links)
      draw_link(canvas_, spots_[link.a], spots_[link.b], link.overlap, link.bridge,
                on_level(link.a) != on_level(link.b));
  }

  // Draws one sigma of each head in x and y, on a separate scale.
  void draw_ellipses() {
    const double scale = view_.ellipse_scale();
    if (!(scale > 0)) return;
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      if (!on_level(k) || !active(station(k))) continue;
      const auto& c = view_.errors[shown_[k]].covariance;
      // image of a unit circle under the square root of the covariance (Cholesky factor)
      const double a = std::sqrt(std::max(c[0], 0.0)), b = a > 0 ? c[1] / a : 0,
                   d = std::sqrt(std::max(c[4] - b * b, 0.0));
      std::vector<Point> curve;
      constexpr int kSteps = 72;
      for (int s = 0; s <= kSteps; ++s) {
        const double t = 2 * std::numbers::pi * s / kSteps, x = a * std::cos(t), y = b * std::cos(t) + d * std::sin(t);
        curve.push_back({spots_[k].x + scale * x, spots_[k].y - scale * y});
      }
      canvas_.polygon(curve, kSkipped, 0.12);
      canvas_.path(curve, {.colour = kSkipped, .width = 1.3});
    }
  }

  // Draws the ground's height beside each, and its name if that does not fit into the disc.
  void draw_labels() {
    const TextStyle style{.size = 10.5, .across = Align::middle, .halo = 2};
    std::vector<Rect> taken;
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      const double r = on_level(k) ? kDisc : 0.7 * kDisc;
      taken.push_back({discs_[k].x - r, discs_[k].y - r, 2 * r, 2 * r});
      if (moved(k)) taken.push_back({spots_[k].x - 5, spots_[k].y - 5, 10, 10});
    }
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      if (!on_level(k)) continue;
      const std::string text = (name(k).size() > 3 ? name(k) + ", " : "") + "z " +
                               fixed(std::round(100 * station(k).ground.z) / 100 + 0.0, 2);
      const Rect place = place_label(discs_[k], kDisc + 3, canvas_.text_width(text, style) + 4, 13,
                                     {map_.x + 2, map_.y + 2, map_.width - 4, map_.height - 4}, taken);
      canvas_.text({place.x + place.width / 2, place.y + place.height / 2}, text, style);
    }
  }

  Canvas& canvas_;
  Rect map_;
  const PlanView& view_;
  const PlanLevel* level_;
  std::vector<std::size_t> shown_;
  std::vector<Point> spots_, discs_;
};

// Puts a station's text into the disc if it fits, else its number.
void disc_text(Canvas& canvas, Point at, const std::string& text, const Colour& colour) {
  canvas.text(at, text,
              {.size = text.size() > 2 ? 9.0 : 11.0, .bold = true, .colour = colour, .across = Align::middle});
}

}  // namespace

double PlanView::ellipse_scale() const {
  double widest = 0;  // semi-axis, metres: the root of the larger eigenvalue in x and y
  for (std::size_t k = 0; k < errors.size() && errors.size() == stations.size(); ++k) {
    if (!active(stations[k])) continue;
    const auto& c = errors[k].covariance;
    const double middle = (c[0] + c[4]) / 2, half = std::hypot((c[0] - c[4]) / 2, c[1]);
    widest = std::max(widest, std::sqrt(std::max(middle + half, 0.0)));
  }
  return widest > 0 && std::isfinite(widest) ? kWidestEllipse / widest : 0;
}

Box plan_window(const PlanView& view) {
  const SceneData& scene = view.scene.data();
  const SearchMesh& mesh = view.area.mesh();
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
  for (const PlacedStation& s : view.stations)
    if (s.status != StationStatus::hole) box.extend(s.position);
  if (box.empty())
    throw Error(Errc::invalid_argument, "draw_plan_view: there is neither a surveyed mesh nor a search area");
  const double margin = 0.03 * std::max({box.size().x, box.size().y, 0.1});
  box.min = box.min - Vec3{margin, margin, 0}, box.max = box.max + Vec3{margin, margin, 0};
  return box;
}

PlanMapContent draw_plan_map(Canvas& canvas, const Rect& map, const PlanView& view, const Box& window,
                             const PlanLevel* level, const std::string& title, std::string subtitle) {
  const SceneData& data = view.scene.data();
  const double metre = map.width / window.size().x;  // canvas units
  const std::size_t fine = kPixelsPerUnit * kSupersampling;
  const MapWindow pixels{.x_min = window.min.x,
                         .y_max = window.max.y,
                         .pixel_m = 1 / (metre * static_cast<double>(fine)),
                         .columns = static_cast<std::size_t>(map.width) * fine,
                         .rows = static_cast<std::size_t>(map.height) * fine};
  const SearchMesh mesh = level ? mesh_of(view.area.mesh(), *level) : view.area.mesh();
  PlanMapContent content;
  std::optional<double> floor;
  HeightBuffer heights{pixels, {}, {}};
  if (level) {
    floor = level->floor;
  } else {
    heights = look_from_above(data, pixels, std::numeric_limits<double>::infinity());
    floor = covered_floor(mesh, heights, data);
  }
  std::optional<Section> section;
  if (floor) {
    const double cut = *floor + cut_above(view.stations);
    heights = look_from_above(data, pixels, cut);
    section = section_at(data, pixels, cut);
    content.cut = true;
    subtitle += (subtitle.empty() ? "Cut" : ", cut") + std::string(" at z = ") + fixed(cut, 2) + " m";
  } else if (subtitle.empty()) {
    subtitle = "Site from above";
  }
  const auto ticks = [](double length) { return std::max(2, static_cast<int>(length / 95)); };
  const Chart chart(canvas, map,
                    {.label = "x (m)",
                     .low = window.min.x,
                     .high = window.min.x + map.width / metre,
                     .wanted_ticks = ticks(map.width)},
                    {.label = "y (m)",
                     .low = window.max.y - map.height / metre,
                     .high = window.max.y,
                     .wanted_ticks = ticks(map.height)},
                    title, subtitle);
  std::vector<std::uint32_t> site = shade(data, heights);
  tint_search_area(site, heights, data.origin.z, mesh);
  content.left_out = hatch_left_out(site, heights, data.origin.z, view.area.left_out(), level);
  if (section) paint_section(site, *section, pixels);
  canvas.image(map, halve(site, pixels.columns), pixels.columns / 2);
  canvas.rectangle(map, {.colour = style::faint, .width = 1});
  canvas.clip(map);
  Stations(canvas, chart, view, level).draw(content);
  canvas.unclip();
  return content;
}

void draw_station(Canvas& canvas, Point at, const std::string& text, const PlacedStation& station) {
  const double r = kDisc, square = 0.94 * kDisc;  // existing stations are square
  const auto mark = [&](double grow, const Colour& colour) {
    if (station.kept)
      canvas.fill({at.x - square - grow, at.y - square - grow, 2 * (square + grow), 2 * (square + grow)}, colour);
    else
      canvas.disc(at, r + grow, colour);
  };
  const bool skipped = !active(station);
  mark(1.3, {1, 1, 1});
  if (skipped)  // the cross sticks out from under the mark
    for (const double side : {-1.0, 1.0})
      canvas.line({at.x - 1.25 * r, at.y - side * 1.25 * r}, {at.x + 1.25 * r, at.y + side * 1.25 * r},
                  {.colour = kSkipped, .width = 3});
  mark(0, skipped ? Colour{0.93, 0.93, 0.94} : station.kept ? kKept : kStation);
  if (text.size() <= 3) disc_text(canvas, at, text, skipped ? kSkipped : Colour{1, 1, 1});
}

void draw_elsewhere(Canvas& canvas, Point at, const std::string& text) {
  canvas.circle(at, 0.7 * kDisc, {.colour = style::faint, .width = 1.2, .dashes = {2.5, 2}});
  if (text.size() <= 3)
    canvas.text(at, text, {.size = 7.5, .colour = style::faint, .across = Align::middle, .halo = 1.5});
}

void draw_link(Canvas& canvas, Point a, Point b, double overlap, bool bridge, bool between_floors) {
  const double share = std::min(overlap / std::end(kLinkSamples)[-1], 1.0);
  const double width = kLeastWidth + share * (kMostWidth - kLeastWidth);
  const std::vector<double> dashes = between_floors ? std::vector<double>{6, 4} : std::vector<double>{};
  canvas.line(a, b, {.colour = {1, 1, 1}, .width = width + 1.6, .opacity = 0.45, .dashes = dashes});
  canvas.line(
      a, b, {.colour = bridge ? style::orange : kLink, .width = width, .opacity = 0.5 + 0.4 * share, .dashes = dashes});
}

}  // namespace vantage
