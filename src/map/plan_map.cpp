// SPDX-License-Identifier: Apache-2.0
#include "map/plan_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/person.hpp"
#include "core/text.hpp"
#include "map/chart.hpp"
#include "map/distance_apart.hpp"
#include "map/left_out_hatch.hpp"
#include "map/place_discs.hpp"
#include "map/relief.hpp"
#include "map/search_tint.hpp"
#include "map/section.hpp"
#include "map/shown_links.hpp"
#include "scene/changed_scene.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr double kLeastWidth = 0.8, kMostWidth = 9;  // of links without overlap, and at the end of the scale
constexpr std::size_t kSupersampling = 2;
constexpr Colour kStation{0.10, 0.22, 0.45}, kExisting{0.42, 0.16, 0.44}, kLink{0.16, 0.34, 0.66},
    kSkipped{0.72, 0.12, 0.12}, kTargetInk{0.1, 0.1, 0.12};
SearchMesh mesh_of(const SearchMesh& mesh, const PlanLevel& level) {
  SearchMesh part{.positions = mesh.positions, .uvs = mesh.uvs, .triangles = {}};
  for (const auto& t : mesh.triangles)
    if (level.holds((mesh.positions[t[0]].z + mesh.positions[t[1]].z + mesh.positions[t[2]].z) / 3))
      part.triangles.push_back(t);
  return part;
}

void paint_section(std::vector<std::uint32_t>& pixels, const Section& section, const MapWindow& window, double line) {
  const auto packed = [](const Colour& colour) {
    const auto c = to_bytes(colour);
    return 0xFF000000u | std::uint32_t{c[0]} << 16 | std::uint32_t{c[1]} << 8 | c[2];
  };
  const std::uint32_t cut = packed(kCutTint), glass = packed(kGlassTint);
  for (std::size_t k = 0; k < pixels.size(); ++k)
    if (section.solid[k]) pixels[k] = section.solid[k] == 1 ? cut : glass;
  for (const bool of_glass : {true, false})
    for (const auto& [a, b] : of_glass ? section.glass_outlines : section.outlines) {
      const int steps = static_cast<int>(std::ceil(std::max(std::abs(b.x - a.x), std::abs(b.y - a.y)))) + 1;
      for (int s = 0; s <= steps; ++s) {
        const double t = static_cast<double>(s) / steps, x = a.x + t * (b.x - a.x), y = a.y + t * (b.y - a.y);
        const auto [x0, x1] = pixels_between(x - line / 2, x + line / 2, window.columns);
        const auto [y0, y1] = pixels_between(y - line / 2, y + line / 2, window.rows);
        for (std::size_t j = y0; j < y1; ++j)
          for (std::size_t i = x0; i < x1; ++i) pixels[j * window.columns + i] = of_glass ? glass : cut;
      }
    }
}

// Returns for each pixel the height `above` the ground nearest to it, local frame. The cut rises with the ground.
std::vector<float> cuts_above(const SearchMesh& mesh, const MapWindow& window, double above, double origin_z) {
  constexpr float kNone = std::numeric_limits<float>::lowest(), kFar = std::numeric_limits<float>::max();
  std::vector<float> cuts(window.columns * window.rows, kNone), away(cuts.size(), kFar);
  for (const auto& t : mesh.triangles)
    for_each_pixel(window, mesh, t, above - origin_z, [&](std::size_t pixel, double z) {
      cuts[pixel] = std::max(cuts[pixel], static_cast<float>(z)), away[pixel] = 0;
    });
  // Distances by steps along rows, columns and diagonals, forth and back.
  const auto columns = static_cast<std::ptrdiff_t>(window.columns), rows = static_cast<std::ptrdiff_t>(window.rows);
  const auto sweep = [&](std::ptrdiff_t step) {
    const std::ptrdiff_t all = columns * rows;
    for (std::ptrdiff_t n = 0; n < all; ++n) {
      const std::ptrdiff_t k = step > 0 ? n : all - 1 - n, x = k % columns, y = k / columns;
      for (const auto& [dx, dy] : {std::pair{-1, 0}, {-1, -1}, {0, -1}, {1, -1}}) {
        const std::ptrdiff_t i = x + step * dx, j = y + step * dy;
        if (i < 0 || j < 0 || i >= columns || j >= rows) continue;
        const auto from = static_cast<std::size_t>(j * columns + i), to = static_cast<std::size_t>(k);
        const float far = away[from] == kFar ? kFar : away[from] + (dx != 0 && dy != 0 ? 1.4142F : 1.0F);
        if (far < away[to]) away[to] = far, cuts[to] = cuts[from];
      }
    }
  };
  sweep(1), sweep(-1);
  return cuts;
}

double to_centimetres(double metres) { return std::round(100 * metres) / 100 + 0.0; }  // no "-0.00"

constexpr double kEven_m = 0.02;

// Returns the height that labels leave out, because most stations have it: a storey's floor, or else the ground of most
// stations, if these share one.
std::optional<double> common_ground(const PlanView& view, const PlanLevel& level) {
  if (!level.only()) return level.floor;
  std::vector<double> grounds;
  for (const PlacedStation& s : view.stations)
    if (s.status != StationStatus::hole && level.holds(s.ground.z)) grounds.push_back(s.ground.z);
  if (grounds.empty()) return std::nullopt;
  const auto middle = grounds.begin() + static_cast<std::ptrdiff_t>(grounds.size() / 2);
  std::nth_element(grounds.begin(), middle, grounds.end());
  const double common = *middle;
  const auto same = std::ranges::count_if(grounds, [&](double z) { return std::abs(z - common) < kEven_m; });
  return 2 * static_cast<std::size_t>(same) > grounds.size() ? std::optional(to_centimetres(common)) : std::nullopt;
}

// Returns the radius of stations' marks, small enough to show the site under them. It is smaller on a narrow map, and
// if most stations stand close together.
double mark_radius(const Rect& map, const std::vector<Point>& spots) {
  constexpr double kLeast = 5.5, kOfMap = 1.0 / 12, kOfDistance = 0.4;
  const double radius =
      std::min({kDisc, kOfMap * std::min(map.width, map.height), kOfDistance * distance_apart(spots, 2)});
  return std::max(kLeast, radius);
}

// The stations of one map, with their links.
class Stations {
 public:
  Stations(Canvas& canvas, const Chart& chart, const PlanView& view, const PlanLevel& level)
      : canvas_(canvas), chart_(chart), map_(chart.area()), view_(view), level_(level) {
    for (std::size_t i = 0; i < view.stations.size(); ++i) {
      const PlacedStation& s = view.stations[i];
      if (s.status == StationStatus::hole) continue;
      shown_.push_back(i);
      spots_.push_back(chart.at(s.position.x, s.position.y));
    }
    std::vector<Point> here;
    for (std::size_t k = 0; k < shown_.size(); ++k)
      if (on_level(k)) here.push_back(spots_[k]);
    radius_ = mark_radius(map_, here);
    const auto placed = place_discs(here, radius_, map_);
    for (const Target& target : view.targets)
      if (stands_on(target, level)) targets_.emplace_back(chart.at(target.centre.x, target.centre.y), &target);
    discs_ = spots_;
    for (std::size_t k = 0, next = 0; k < shown_.size(); ++k)
      if (on_level(k)) discs_[k] = placed[next++];
  }

  void draw(PlanMapContent& content) {
    draw_links(content);
    draw_ellipses();
    for (std::size_t k = 0; k < shown_.size(); ++k)
      if (elsewhere(k)) draw_elsewhere(canvas_, spots_[k], name(k), radius_), content.elsewhere = true;
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      if (!moved(k)) continue;
      content.moved = true;
      canvas_.line(spots_[k], discs_[k], {.colour = {1, 1, 1}, .width = 3.4, .opacity = 0.8});
      canvas_.line(spots_[k], discs_[k], {.colour = colour(k), .width = 1.5});
    }
    for (std::size_t k = 0; k < shown_.size(); ++k)
      if (on_level(k)) draw_station(canvas_, discs_[k], name(k), station(k), radius_);
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      if (!moved(k)) continue;
      canvas_.disc(spots_[k], 0.44 * radius_, {1, 1, 1});
      canvas_.disc(spots_[k], 0.32 * radius_, colour(k));
    }
    for (const auto& [at, target] : targets_) draw_target(canvas_, at, target->control_m > 0);
    draw_labels(content);
  }

 private:
  static constexpr double kFar = 26;             // farthest place of a label without a line to its station
  static constexpr std::size_t kAllFloors = 60;  // stations of a site that are shown on every floor
  const PlacedStation& station(std::size_t k) const { return view_.stations[shown_[k]]; }
  const std::string& name(std::size_t k) const { return view_.names[shown_[k]]; }
  bool on_level(std::size_t k) const { return level_.holds(station(k).ground.z); }
  // True if a station of another floor is shown. If there are many stations, only those with a link to this floor are.
  bool elsewhere(std::size_t k) const {
    return !on_level(k) && (shown_.size() <= kAllFloors || (!tied_.empty() && tied_[k]));
  }
  bool moved(std::size_t k) const { return std::hypot(discs_[k].x - spots_[k].x, discs_[k].y - spots_[k].y) > 0.5; }
  Colour colour(std::size_t k) const { return station(k).existing ? kExisting : kStation; }

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
    if (shown_.size() > kAllFloors) keep_strongest_to_other_floors(links);
    links = shown_links(std::move(links), shown_.size());
    content.hidden_links += all - links.size();
    tied_.assign(shown_.size(), false);
    for (const ShownLink& link : links) tied_[link.a] = tied_[link.b] = true;
    for (const ShownLink& link : links)
      draw_link(canvas_, spots_[link.a], spots_[link.b], link.overlap, link.bridge,
                on_level(link.a) != on_level(link.b));
  }

  // Keeps only the strongest of a station's links to other floors: at a stair it has many.
  void keep_strongest_to_other_floors(std::vector<ShownLink>& links) const {
    std::vector<double> strongest(shown_.size(), 0);
    const auto between = [&](const ShownLink& link) { return on_level(link.a) != on_level(link.b); };
    const auto here = [&](const ShownLink& link) { return on_level(link.a) ? link.a : link.b; };
    for (const ShownLink& link : links)
      if (between(link)) strongest[here(link)] = std::max(strongest[here(link)], link.overlap);
    std::erase_if(links, [&](const ShownLink& link) { return between(link) && link.overlap < strongest[here(link)]; });
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

  // Writes each station's name beside its disc if it does not fit into it, and the ground's height if it differs. A
  // text that would lie on something else is left out, but a name that finds no place stays over its disc.
  void draw_labels(PlanMapContent& content) {
    const TextStyle style{.size = 10.5, .across = Align::middle, .halo = 2};
    const std::optional<double> common = common_ground(view_, level_);
    const Rect inside{map_.x + 2, map_.y + 2, map_.width - 4, map_.height - 4};
    std::vector<Rect> taken;
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      if (!on_level(k) && !elsewhere(k)) continue;
      const double r = on_level(k) ? radius_ : 0.7 * radius_;
      taken.push_back({discs_[k].x - r, discs_[k].y - r, 2 * r, 2 * r});
      if (moved(k)) taken.push_back({spots_[k].x - 5, spots_[k].y - 5, 10, 10});
    }
    const auto put_at = [&](Point at, double gap, const std::string& text) {
      const auto place = place_free_label(at, gap, kFar, canvas_.text_width(text, style) + 4, 13, inside, taken);
      if (place) canvas_.text({place->x + place->width / 2, place->y + place->height / 2}, text, style);
      return place.has_value();
    };
    const auto put = [&](std::size_t k, const std::string& text) { return put_at(discs_[k], radius_ + 3, text); };
    for (const auto& [at, target] : targets_)
      taken.push_back({at.x - kTargetRadius, at.y - kTargetRadius, 2 * kTargetRadius, 2 * kTargetRadius});
    for (const auto& [at, target] : targets_) put_at(at, kTargetRadius + 2, target->name);
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      if (!on_level(k)) continue;
      const std::string height = "z " + fixed(to_centimetres(station(k).ground.z), 2);
      const bool named = fits_disc(name(k));
      const bool differs = !common || std::abs(station(k).ground.z - *common) >= kEven_m;
      if (differs && put(k, named ? height : name(k) + ", " + height)) {
        content.heights = true;
        continue;
      }
      if (!named && !put(k, name(k)))
        canvas_.text(discs_[k], name(k), {.size = 8, .bold = true, .across = Align::middle, .halo = 1.5});
    }
    name_rooms(inside, taken);
  }

  // Writes each room's name in its middle, or nearby within the room if that place is taken.
  void name_rooms(const Rect& inside, std::vector<Rect>& taken) {
    const TextStyle style{.size = 10, .colour = style::kFaint, .across = Align::middle, .halo = 2};
    for (const Room& room : view_.scene.rooms()) {
      if (!lies_on(room, level_)) continue;
      const Point low = chart_.at(room.box.min.x, room.box.max.y), high = chart_.at(room.box.max.x, room.box.min.y);
      const Point middle{(low.x + high.x) / 2, (low.y + high.y) / 2};
      const double width = canvas_.text_width(room.name, style) + 4, height = 13;
      const Rect over{middle.x - width / 2, middle.y - height / 2, width, height};
      const auto free = [&](const Rect& r) {
        return r.x >= inside.x && r.y >= inside.y && r.right() <= inside.right() && r.bottom() <= inside.bottom() &&
               std::ranges::none_of(taken, [&](const Rect& t) { return t.overlaps(r); });
      };
      std::optional<Rect> place;
      const double reach = std::max(0.0, (high.y - low.y - height) / 2);
      for (const double share : {0.0, -0.4, 0.4, -0.8, 0.8}) {
        const Rect there{over.x, over.y + share * reach, width, height};
        if (!place && free(there)) place = there;
      }
      if (!place) continue;
      taken.push_back(*place);
      canvas_.text({place->x + width / 2, place->y + height / 2}, room.name, style);
    }
  }

  Canvas& canvas_;
  const Chart& chart_;
  Rect map_;
  const PlanView& view_;
  const PlanLevel& level_;
  double radius_ = kDisc;
  std::vector<std::size_t> shown_;
  std::vector<Point> spots_, discs_;
  std::vector<bool> tied_;  // by a link that is drawn
  std::vector<std::pair<Point, const Target*>> targets_;
};

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
      for (const Float3& p : scene.corners(t)) box.extend(scene.origin + widen(p));
  }
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) box.extend(mesh.positions[v]);
  for (const PlacedStation& s : view.stations)
    if (s.status != StationStatus::hole) box.extend(s.position);
  for (const Target& target : view.targets) box.extend(target.centre);
  if (box.empty())
    throw Error(Errc::invalid_argument, "draw_plan_view: there is neither a surveyed mesh nor a search area");
  const double margin = 0.03 * std::max({box.size().x, box.size().y, 0.1});
  box.min = box.min - Vec3{margin, margin, 0}, box.max = box.max + Vec3{margin, margin, 0};
  return box;
}

// Tints the meshes of one name: things that were found on site and are not in the model, or unknown space.
static void tint_meshes(std::vector<std::uint32_t>& pixels, const SceneData& data, const char* name, const Colour& tint,
                        const MapWindow& window, const PlanLevel& level) {
  constexpr double kFoundOpacity = 0.8;
  for (std::size_t m = 0; m < data.meshes.size(); ++m) {
    if (data.meshes[m].name != name) continue;
    std::vector<char> found(pixels.size());
    for (std::uint32_t k = 0; k < data.ranges[m].triangle_count; ++k) {
      const auto at = data.corners(data.ranges[m].first_triangle + k);
      std::array<MapPoint, 3> corners;
      double z = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3 p = data.origin + widen(at[c]);
        corners[c] = window.at(p), z = std::max(c == 0 ? p.z : z, p.z);
      }
      if (level.only() || level.holds(z))
        for_each_pixel(window, corners, [&](std::size_t pixel, const auto&) { found[pixel] = 1; });
    }
    for (std::size_t k = 0; k < pixels.size(); ++k)
      if (found[k]) pixels[k] = laid_over(pixels[k], tint, kFoundOpacity);
  }
}

// Returns places that nothing fills at the height of the cut: stations, and ground that the search area has because of
// the free space over it.
static std::vector<Vec3> free_places(const SearchArea& area, const SearchMesh& ground, double cut,
                                     std::span<const PlacedStation> stations) {
  std::vector<Vec3> places;
  for (const PlacedStation& station : stations)
    if (station.status == StationStatus::ok) places.push_back(station.ground);
  const bool found = !area.entries().empty();  // on foot; ground that was marked may lie under walls
  for (const auto& t : found ? std::span(ground.triangles) : std::span<const std::array<std::uint32_t, 3>>())
    places.push_back((ground.positions[t[0]] + ground.positions[t[1]] + ground.positions[t[2]]) * (1.0 / 3));
  std::erase_if(places, [cut](const Vec3& place) { return place.z > cut || place.z < cut - person::kUnderCut_m; });
  return places;
}

SiteMap map_site(const Scene& scene, const SearchArea& area, const MapWindow& window, const PlanLevel& level,
                 std::span<const PlacedStation> stations, double line, double paper,
                 std::span<const std::uint32_t> surfaces) {
  const SceneData& data = scene.data();
  const SearchMesh mesh = mesh_of(area.mesh(), level);
  constexpr double kEverything = std::numeric_limits<double>::infinity();
  std::vector<float> cuts;
  if (level.cut && level.only()) cuts = cuts_above(mesh, window, *level.cut - level.floor, data.origin.z);
  const HeightBuffer heights = look_from_above(data, window, level.cut.value_or(kEverything), cuts);
  SiteMap map{.pixels = shade(data, heights)};
  tint_search_area(map.pixels, heights, data.origin.z, mesh);
  map.left_out = hatch_left_out(map.pixels, heights, data.origin.z, area.left_out(), &level, mesh);
  if (paper > 0)
    for (std::uint32_t& pixel : map.pixels)
      if (pixel != 0) pixel = laid_over(pixel, {1, 1, 1}, paper);
  if (level.cut) {
    const std::vector<std::uint32_t> own = surfaces.empty() ? surfaces_of(data) : std::vector<std::uint32_t>();
    const Section section = section_at(data, surfaces.empty() ? std::span(own) : surfaces, window, *level.cut,
                                       free_places(area, mesh, *level.cut, stations));
    paint_section(map.pixels, section, window, line);
  }
  tint_meshes(map.pixels, data, kNotInModel, kFoundTint, window, level);
  tint_meshes(map.pixels, data, kUnknown, kUnknownTint, window, level);
  return map;
}

PlanMapContent draw_plan_map(Canvas& canvas, const Rect& map, const PlanView& view, const Box& window,
                             const PlanLevel& level, const std::string& title, std::string subtitle, bool brief) {
  const double metre = map.width / window.size().x;  // canvas units
  const std::size_t fine = kPixelsPerUnit * kSupersampling;
  const MapWindow pixels{.x_min = window.min.x,
                         .y_max = window.max.y,
                         .pixel_m = 1 / (metre * static_cast<double>(fine)),
                         .columns = static_cast<std::size_t>(map.width) * fine,
                         .rows = static_cast<std::size_t>(map.height) * fine};
  PlanMapContent content;
  content.cut = level.cut.has_value();
  if (brief) {
    // Only the picture of a level states the height of its cut.
  } else if (level.cut) {
    subtitle += (subtitle.empty() ? "Cut" : ", cut") + std::string(" at z = ") + fixed(*level.cut, 2) + " m";
  } else if (subtitle.empty()) {
    subtitle = "Site from above";
  }
  if (const auto ground = common_ground(view, level); ground && level.only() && !brief)
    subtitle += ", most stations on ground at z = " + fixed(*ground, 2) + " m";
  const auto ticks = [](double length) { return std::max(3, static_cast<int>(length / 95)); };
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
  const SiteMap site = map_site(view.scene, view.area, pixels, level, view.stations, static_cast<double>(fine));
  content.left_out = site.left_out;
  canvas.image(map, halve(site.pixels, pixels.columns), pixels.columns / 2);
  canvas.rectangle(map, {.colour = style::kFaint, .width = 1});
  canvas.clip(map);
  Stations(canvas, chart, view, level).draw(content);
  canvas.unclip();
  return content;
}

bool fits_disc(const std::string& name) { return name.size() <= 4; }

void draw_station(Canvas& canvas, Point at, const std::string& text, const PlacedStation& station, double radius) {
  const double square = 0.94 * radius;  // existing ones are square
  const auto mark = [&](double grow, const Colour& colour) {
    if (station.existing)
      canvas.fill({at.x - square - grow, at.y - square - grow, 2 * (square + grow), 2 * (square + grow)}, colour);
    else
      canvas.disc(at, radius + grow, colour);
  };
  const bool skipped = !active(station);
  mark(0.12 * radius, {1, 1, 1});
  if (skipped)  // the cross sticks out from under the mark
    for (const double side : {-1.0, 1.0})
      canvas.line({at.x - 1.25 * radius, at.y - side * 1.25 * radius},
                  {at.x + 1.25 * radius, at.y + side * 1.25 * radius}, {.colour = kSkipped, .width = 0.28 * radius});
  mark(0, skipped ? Colour{0.93, 0.93, 0.94} : station.existing ? kExisting : kStation);
  if (!fits_disc(text)) return;
  const double size = text.size() <= 2 ? 11 : text.size() == 3 ? 9 : 7;  // as large as there is room for
  canvas.text(at, text,
              {.size = size * radius / kDisc,
               .bold = true,
               .colour = skipped ? kSkipped : Colour{1, 1, 1},
               .across = Align::middle});
}

void draw_elsewhere(Canvas& canvas, Point at, const std::string& text, double radius) {
  canvas.circle(at, 0.7 * radius, {.colour = style::kFaint, .width = 1.2, .dashes = {2.5, 2}});
  if (fits_disc(text))
    canvas.text(at, text,
                {.size = (text.size() > 3 ? 6.0 : 7.5) * radius / kDisc,
                 .colour = style::kFaint,
                 .across = Align::middle,
                 .halo = 1.5});
}

void draw_target(Canvas& canvas, Point at, bool control, double radius) {
  constexpr Colour kWhite{1, 1, 1};
  if (control) {
    const double side = 2.3 * radius;
    std::vector<Point> corners;
    for (int k = 0; k <= 3; ++k) {
      const double angle = 2 * std::numbers::pi * k / 3;
      corners.push_back({at.x + side * std::sin(angle), at.y - side * std::cos(angle)});
    }
    canvas.polygon(corners, kWhite, 0.85);
    canvas.path(corners, {.colour = kTargetInk, .width = 0.22 * radius});
  }
  canvas.disc(at, 1.16 * radius, kWhite);
  canvas.circle(at, radius, {.colour = kTargetInk, .width = 0.2 * radius});
  for (const double from : {0.0, std::numbers::pi}) {
    std::vector<Point> quarter{at};
    constexpr int kSteps = 10;
    for (int k = 0; k <= kSteps; ++k) {
      const double angle = from + std::numbers::pi / 2 * k / kSteps;
      quarter.push_back({at.x + radius * std::cos(angle), at.y - radius * std::sin(angle)});
    }
    canvas.polygon(quarter, kTargetInk);
  }
}

bool lies_on(const Room& room, const PlanLevel& level) {
  return room.box.max.z > level.floor + 0.5 && room.box.min.z < level.floor + 1.5;
}

bool stands_on(const Target& target, const PlanLevel& level) {
  constexpr double kOverFloor_m = 1;  // from a floor to well below a target's centre, and to well above its floor
  return level.holds(target.centre.z - kOverFloor_m);
}

void draw_link(Canvas& canvas, Point a, Point b, double overlap, bool bridge, bool between_floors) {
  const double share = std::min(overlap / std::end(kLinkSamples)[-1], 1.0);
  const double width = kLeastWidth + share * (kMostWidth - kLeastWidth);
  const std::vector<double> dashes = between_floors ? std::vector<double>{6, 4} : std::vector<double>{};
  canvas.line(a, b, {.colour = {1, 1, 1}, .width = width + 1.6, .opacity = 0.45, .dashes = dashes});
  canvas.line(
      a, b,
      {.colour = bridge ? style::kOrange : kLink, .width = width, .opacity = 0.5 + 0.4 * share, .dashes = dashes});
}

}  // namespace vantage
