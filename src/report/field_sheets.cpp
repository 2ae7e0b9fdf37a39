// SPDX-License-Identifier: Apache-2.0
#include "report/field_sheets.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "map/chart.hpp"
#include "map/place_discs.hpp"
#include "map/plan_map.hpp"
#include "map/search_tint.hpp"
#include "map/section.hpp"

namespace vantage {
namespace {

constexpr double kPanelWidth = 196, kMark = 9, kTargetMark = 4.5;  // radii of the marks of stations and targets
constexpr int kCoarsestInside = 200, kCoarsestOutside = 500;       // ratios at which walls, or marks, are still legible
constexpr std::size_t kPixels = 2;  // pixels for each point of a map; doubled, and averaged, on A4
constexpr double kFaded = 0.5;      // strength of a map's colours, so that pencil shows
constexpr Colour kRoute{0.84, 0.37, 0.05}, kTape{0.10, 0.42, 0.36}, kRoomInk{0.42, 0.42, 0.46};

Box grown(Box box, double metres) {
  box.min = box.min - Vec3{metres, metres, 0}, box.max = box.max + Vec3{metres, metres, 0};
  return box;
}

bool stands_on(const PlacedStation& s, const PlanLevel& level) {
  return s.status != StationStatus::hole && level.holds(s.ground.z);
}

// Marks the stations that a round's sheets list: all if there is one round, else those of the session.
std::vector<bool> own_stations(const SheetRound& round, bool several, std::size_t stations) {
  std::vector<bool> own(stations, !several);
  for (const std::size_t k : round.stations) own[k] = true;
  return own;
}

// Lays out all ground of the storey if that takes hardly more paper than the surroundings of its stations; else these,
// with the corners nearby that distances are taken to.
SheetLayout layout_of(const PlanLevel& level, const SearchMesh& ground, const std::vector<Vec3>& spots,
                      const std::vector<WallCorner>& corners) {
  constexpr double kAround_m = 4, kRim_m = 1;
  constexpr double kNear_m = 15;
  Box stations, storey;
  for (const Vec3& spot : spots) stations.extend(spot), storey.extend(spot);
  stations = grown(stations, kAround_m);
  for (const WallCorner& corner : corners)
    if (corner.distance_m <= kNear_m)
      for (const double side : {-kRim_m, kRim_m}) stations.extend({corner.x + side, corner.y + side, level.floor});
  for (const auto& t : ground.triangles)
    for (const std::uint32_t v : t)
      if (level.holds(ground.positions[v].z)) storey.extend(ground.positions[v]);
  const int coarsest = level.cut ? kCoarsestInside : kCoarsestOutside;
  const SheetLayout all = lay_out(grown(storey, kRim_m), spots, coarsest, kPanelWidth);
  const SheetLayout part = lay_out(stations, spots, coarsest, kPanelWidth);
  const bool worth_it = all.tiles.size() == 1 && all.ratio <= 2 * part.ratio;
  return worth_it || (all.tiles.size() == part.tiles.size() && all.ratio == part.ratio) ? all : part;
}

// A map on a sheet, which it borrows.
class MapOnSheet {
 public:
  MapOnSheet(Sheet& on, const SheetLayout& layout, const MapTile& tile, const PlanLevel& level)
      : sheet_(on), layout_(layout), map_(tile.map), window_(tile.window), level_(level) {}

  Point at(double x, double y) const {
    return {map_.x + (x - window_.min.x) * layout_.points_per_metre(),
            map_.y + (window_.max.y - y) * layout_.points_per_metre()};
  }
  Point at(const Vec3& p) const { return at(p.x, p.y); }
  bool holds(const Vec3& p) const {
    return p.x >= window_.min.x && p.x <= window_.max.x && p.y >= window_.min.y && p.y <= window_.max.y;
  }

  void site(const Scene& scene, const SearchArea& area, std::span<const PlacedStation> stations,
            std::span<const std::uint32_t> surfaces) {
    const Rect& map = map_;
    const bool smooth = layout_.paper.name == a4().name;
    const std::size_t fine = kPixels * (smooth ? 2 : 1);
    const MapWindow pixels{.x_min = window_.min.x,
                           .y_max = window_.max.y,
                           .pixel_m = 1 / (layout_.points_per_metre() * static_cast<double>(fine)),
                           .columns = static_cast<std::size_t>(map.width) * fine,
                           .rows = static_cast<std::size_t>(map.height) * fine};
    const SiteMap painted =
        map_site(scene, area, pixels, level_, stations, 0.75 * static_cast<double>(fine), kFaded, surfaces);
    if (smooth)
      sheet_.canvas->image(map, halve(painted.pixels, pixels.columns), pixels.columns / 2);
    else
      sheet_.canvas->image(map, painted.pixels, pixels.columns);
  }

  // Draws walls 1.2 m over the ground, from which distances are taken, on a map that shows roofs.
  void walls(const SceneData& scene) {
    constexpr double kWall_m = 1.2;
    constexpr std::size_t kMost = 20'000;  // more lines are a heap of stones, no walls
    std::vector<std::array<Point, 2>> lines;
    for (const auto& [a, b] : section_lines(scene, level_.floor + kWall_m))
      if (holds(a) || holds(b)) lines.push_back({at(a), at(b)});
    if (lines.size() > kMost) return;
    for (const auto& [a, b] : lines) sheet_.canvas->line(a, b, {.colour = style::kInk, .width = 0.5, .opacity = 0.7});
  }

  // Draws crosses at round coordinates, with their values at the frame.
  void grid() {
    const Rect& map = map_;
    constexpr double kApart = 85;  // points
    const auto ticks = [&](double low, double high) {
      return nice_ticks(low, high, std::max(2, static_cast<int>((high - low) * layout_.points_per_metre() / kApart)));
    };
    const std::vector<double> xs = ticks(window_.min.x, window_.max.x), ys = ticks(window_.min.y, window_.max.y);
    const TextStyle style{.size = 6.5, .colour = kFaintInk, .across = Align::middle};
    for (const double x : xs)
      for (const double y : ys) {
        const Point p = at(x, y);
        sheet_.canvas->line({p.x - 4, p.y}, {p.x + 4, p.y}, {.colour = kFaintInk, .width = 0.4});
        sheet_.canvas->line({p.x, p.y - 4}, {p.x, p.y + 4}, {.colour = kFaintInk, .width = 0.4});
      }
    const auto x_labels = tick_labels(xs), y_labels = tick_labels(ys);
    for (std::size_t k = 0; k < xs.size(); ++k)
      sheet_.canvas->text({at(xs[k], 0).x, map.bottom() + 7}, "x " + x_labels[k], style);
    TextStyle upright = style;
    upright.turn = -1.5707963267948966;
    for (std::size_t k = 0; k < ys.size(); ++k)
      sheet_.canvas->text({map.x - 7, at(0, ys[k]).y}, "y " + y_labels[k], upright);
    sheet_.canvas->rectangle(map, {.colour = style::kInk, .width = 0.8});
  }

  void route(const Round& visit) {
    for (std::size_t leg = 0; leg < visit.paths.size(); ++leg) {
      const std::vector<Vec3>& path = visit.paths[leg];
      if (path.size() < 2) continue;
      // The path back, and straight lines for unknown paths, are dotted.
      const Vec3 straight = path.back() - path.front();
      constexpr double kRoundabout = 1.25;  // a known straight path is a few per cent longer on the grid of places
      const bool unknown = path.size() == 2 && visit.legs_m[leg] > kRoundabout * std::sqrt(dot(straight, straight));
      const bool back = leg + 1 == visit.paths.size() || unknown;
      double length = 0;
      for (std::size_t k = 0; k + 1 < path.size(); ++k)
        length += std::hypot(path[k + 1].x - path[k].x, path[k + 1].y - path[k].y);
      double gone = 0;
      for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        const Vec3 &a = path[k], &b = path[k + 1];
        const double step = std::hypot(b.x - a.x, b.y - a.y);
        gone += step;
        if (!level_.holds(a.z) && !level_.holds(b.z)) continue;
        const Pen pen{.colour = kRoute,
                      .width = back ? 0.7 : 1.1,
                      .opacity = back ? 0.7 : 0.9,
                      .dashes = back ? std::vector<double>{1.5, 3} : std::vector<double>{5, 2.5}};
        sheet_.canvas->line(at(a), at(b), pen);
        // An arrow shows the direction half way along the path.
        if (gone >= length / 2 && gone - step < length / 2 && length * layout_.points_per_metre() > 3 * kMark &&
            step > 0)
          arrow(at(a), at(b), 1 - (gone - length / 2) / step);
      }
    }
    if (visit.paths.empty() || visit.paths.front().size() < 2) return;
    const Vec3& entrance = visit.paths.front().front();
    if (!holds(entrance) || !level_.holds(entrance.z)) return;
    const Point p = at(entrance);
    sheet_.canvas->disc(p, 4, {1, 1, 1});
    sheet_.canvas->circle(p, 3.5, {.colour = kRoute, .width = 1.6});
    taken_.push_back({p.x - 5, p.y - 5, 10, 10});
    label(p, 6, "entrance", {.size = 7, .colour = kRoute, .across = Align::middle, .halo = 1.5});
  }

  // Marks of the stations with their names, and their distances to corners.
  void stations(std::span<const PlacedStation> stations, const std::vector<StationFacts>& facts,
                const std::vector<bool>& own) {
    std::vector<std::size_t> shown;
    std::vector<Point> spots;
    for (std::size_t k = 0; k < stations.size(); ++k)
      if (own[k] && stands_on(stations[k], level_) && holds(stations[k].ground))
        shown.push_back(k), spots.push_back(at(stations[k].ground));
    const std::vector<Point> discs = place_discs(spots, kMark, map_);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      taken_.push_back({discs[i].x - kMark, discs[i].y - kMark, 2 * kMark, 2 * kMark});
      taken_.push_back({spots[i].x - 3, spots[i].y - 3, 6, 6});
    }
    for (std::size_t i = 0; i < shown.size(); ++i)
      for (const WallCorner& corner : facts[shown[i]].corners) {
        const Point c = at(corner.x, corner.y);
        sheet_.canvas->line(spots[i], c, {.colour = kTape, .width = 0.6});
        sheet_.canvas->disc(c, 1.6, kTape);
      }
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const bool moved = std::hypot(discs[i].x - spots[i].x, discs[i].y - spots[i].y) > 0.5;
      if (moved) sheet_.canvas->line(spots[i], discs[i], {.colour = style::kInk, .width = 1});
      draw_station(*sheet_.canvas, discs[i], facts[shown[i]].name, stations[shown[i]], kMark);
      if (moved) sheet_.canvas->disc(spots[i], 2.4, style::kInk);
    }
    for (std::size_t i = 0; i < shown.size(); ++i)
      if (const std::string& name = facts[shown[i]].name; !fits_disc(name))
        label(discs[i], kMark + 2, name, {.size = 8, .bold = true, .across = Align::middle, .halo = 1.5}, true);
    for (std::size_t i = 0; i < shown.size(); ++i)
      for (const WallCorner& corner : facts[shown[i]].corners)
        tape(spots[i], at(corner.x, corner.y), corner.distance_m);
  }

  // Marks of the targets with their names, and their distances to corners.
  void targets(std::span<const Target> targets, const std::vector<TargetFacts>& facts) {
    std::vector<std::size_t> shown;
    for (std::size_t k = 0; k < targets.size(); ++k)
      if (stands_on(targets[k], level_) && holds(targets[k].centre)) shown.push_back(k);
    const auto spot = [&](std::size_t k) { return at(targets[k].centre); };
    for (const std::size_t k : shown) {
      const Point p = spot(k);
      taken_.push_back({p.x - kTargetMark, p.y - kTargetMark, 2 * kTargetMark, 2 * kTargetMark});
      for (const WallCorner& corner : facts[k].corners) {
        sheet_.canvas->line(p, at(corner.x, corner.y), {.colour = kTape, .width = 0.6});
        sheet_.canvas->disc(at(corner.x, corner.y), 1.6, kTape);
      }
    }
    for (const std::size_t k : shown) draw_target(*sheet_.canvas, spot(k), targets[k].control_m > 0, kTargetMark);
    for (const std::size_t k : shown)
      label(spot(k), kTargetMark + 2, targets[k].name, {.size = 8, .bold = true, .across = Align::middle, .halo = 1.5},
            true);
    for (const std::size_t k : shown)
      for (const WallCorner& corner : facts[k].corners) tape(spot(k), at(corner.x, corner.y), corner.distance_m);
  }

  void rooms(std::span<const Room> rooms) {
    for (const Room& room : rooms) {
      const Vec3 middle = room.box.centre();
      if (lies_on(room, level_) && holds(middle))
        label(at(middle), 0, room.name, {.size = 7.5, .colour = kRoomInk, .across = Align::middle, .halo = 1.5});
    }
  }

  // Outlines the other sheets.
  void tiles(const std::vector<MapTile>& tiles) {
    for (const MapTile& tile : tiles) {
      const Point a = at(tile.window.min.x, tile.window.max.y), b = at(tile.window.max.x, tile.window.min.y);
      sheet_.canvas->rectangle({a.x, a.y, b.x - a.x, b.y - a.y}, {.colour = kTape, .width = 1.2});
      sheet_.canvas->text({a.x + 5, a.y + 10}, tile.name, {.size = 12, .bold = true, .colour = kTape, .halo = 2});
    }
  }

  void dots(std::span<const PlacedStation> stations, const std::vector<bool>& which) {
    for (std::size_t k = 0; k < stations.size(); ++k)
      if (which[k] && stands_on(stations[k], level_)) sheet_.canvas->disc(at(stations[k].ground), 1.8, style::kInk);
  }

  void name(const std::string& words) {
    const TextStyle style{.size = 9, .bold = true, .colour = kTape, .halo = 2};
    taken_.push_back({map_.x, map_.y, sheet_.canvas->text_width(words, style) + 10, 18});
    sheet_.canvas->text({map_.x + 5, map_.y + 9}, words, style);
  }

  void clip() { sheet_.canvas->clip(map_); }
  void unclip() { sheet_.canvas->unclip(); }

 private:
  void arrow(Point a, Point b, double share) {
    const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
    if (!(length > 0)) return;
    const double ux = dx / length, uy = dy / length;
    const Point tip{a.x + share * dx + 3.5 * ux, a.y + share * dy + 3.5 * uy};
    const Point corners[] = {
        tip, {tip.x - 7 * ux - 3 * uy, tip.y - 7 * uy + 3 * ux}, {tip.x - 7 * ux + 3 * uy, tip.y - 7 * uy - 3 * ux}};
    sheet_.canvas->polygon(corners, kRoute);
  }

  // Writes text beside a point where it is free; `must`: even where it is not.
  void label(Point p, double gap, const std::string& text, const TextStyle& style, bool must = false) {
    const double width = sheet_.canvas->text_width(text, style) + 3, height = style.size + 2;
    const Rect inside{map_.x + 1, map_.y + 1, map_.width - 2, map_.height - 2};
    constexpr double kFar = 26;
    std::optional<Rect> place;
    if (gap == 0) {
      const Rect over{p.x - width / 2, p.y - height / 2, width, height};
      if (std::ranges::none_of(taken_, [&](const Rect& t) { return t.overlaps(over); })) {
        taken_.push_back(over);
        place = over;
      }
    }
    if (!place) place = place_free_label(p, gap + 1, kFar, width, height, inside, taken_);
    if (!place && must) place = place_label(p, gap, width, height, inside, taken_);
    if (place) sheet_.canvas->text({place->x + place->width / 2, place->y + place->height / 2}, text, style);
  }

  // Writes a distance beside its line, at its middle or near one end; nowhere if all of these are taken.
  void tape(Point from, Point to, double metres) {
    const TextStyle style{.size = 6.5, .colour = kTape, .across = Align::middle, .halo = 1.4};
    const std::string text = fixed(metres, 2);
    const double width = sheet_.canvas->text_width(text, style) + 2, height = 7.5;
    for (const double share : {0.5, 0.65, 0.35, 0.8}) {
      const Point p{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
      const Rect place{p.x - width / 2, p.y - height / 2, width, height};
      const Rect& map = map_;
      if (place.x < map.x || place.right() > map.right() || place.y < map.y || place.bottom() > map.bottom()) continue;
      if (std::ranges::any_of(taken_, [&](const Rect& t) { return t.overlaps(place); })) continue;
      taken_.push_back(place);
      sheet_.canvas->text(p, text, style);
      return;
    }
  }

  Sheet& sheet_;
  const SheetLayout& layout_;
  Rect map_;
  Box window_;
  const PlanLevel& level_;
  std::vector<Rect> taken_;
};

// Title, ratio, scale bar, north, marks, and the stations in the order of visiting as far as there is room.
class SheetPanel {
 public:
  SheetPanel(Sheet& sheet, const SheetLayout& layout)
      : sheet_(sheet), layout_(layout), x_(layout.map.right() + 14), y_(layout.map.y + 4) {}

  void head(const std::string& title, const std::string& what, const ReportOptions& options) {
    Canvas& canvas = *sheet_.canvas;
    const double room = canvas.width() - 2 * layout_.map.x;
    const TextStyle bold{.size = 14, .bold = true}, faint{.size = 9.5, .colour = kFaintInk};
    const std::string ratio = "1:" + std::to_string(layout_.ratio);
    const double wide = canvas.text_width(ratio, {.size = 20, .bold = true}) + 20;
    canvas.text({layout_.map.x, 22}, fitted(canvas, title, room - wide, bold), bold);
    canvas.text({layout_.map.x, 40},
                fitted(canvas, what + (options.date.empty() ? "" : " · " + options.date), room - wide, faint), faint);
    canvas.text({canvas.width() - layout_.map.x, 26}, ratio, {.size = 20, .bold = true, .across = Align::end});
    canvas.text({canvas.width() - layout_.map.x, 42}, "on " + layout_.paper.name + ", printed at full size",
                {.size = 8, .colour = kFaintInk, .across = Align::end});
  }

  void scale_and_north(const std::string& crs) {
    Canvas& canvas = *sheet_.canvas;
    const double metre = layout_.points_per_metre(), widest = 110;
    double length = std::pow(10.0, std::floor(std::log10(widest / metre)));
    for (const double factor : {5.0, 2.0})
      if (factor * length * metre <= widest) {
        length *= factor;
        break;
      }
    const double width = length * metre, y = y_ + 16;
    for (int k = 0; k < 4; ++k) {
      const Rect part{x_ + k * width / 4, y, width / 4, 5};
      if (k % 2 == 0) canvas.fill(part, style::kInk);
      canvas.rectangle(part, {.colour = style::kInk, .width = 0.6});
    }
    canvas.text({x_, y - 6}, "0", {.size = 7.5, .across = Align::middle});
    canvas.text({x_ + width, y - 6}, number(length) + " m", {.size = 7.5, .across = Align::middle});
    // An arrow up where that is north, else the axes.
    const double right = x_ + kPanelWidth - 30;
    if (!crs.empty()) {
      const Point arrow[] = {{right, y_}, {right + 6, y_ + 22}, {right, y_ + 17}, {right - 6, y_ + 22}};
      canvas.polygon(arrow, style::kInk);
      canvas.text({right, y_ + 30}, "N", {.size = 10, .bold = true, .across = Align::middle});
    } else {
      canvas.line({right - 8, y_ + 24}, {right - 8, y_ + 4}, {.colour = style::kInk, .width = 1});
      canvas.line({right - 8, y_ + 24}, {right + 12, y_ + 24}, {.colour = style::kInk, .width = 1});
      canvas.text({right - 8, y_ - 2}, "y", {.size = 8, .across = Align::middle});
      canvas.text({right + 17, y_ + 24}, "x", {.size = 8, .across = Align::middle});
    }
    y_ += 40;
    line(crs.empty() ? "Survey frame; where north is, is not known" : crs + ", grid north up",
         {.size = 7.5, .colour = kFaintInk}, 14);
  }

  void legend(bool cut, bool route, bool tape, bool kept, bool left_out, bool targets, bool control) {
    Canvas& canvas = *sheet_.canvas;
    constexpr TextStyle kText{.size = 8};
    const auto words = [&](const std::string& what) {
      canvas.text({x_ + 26, y_}, what, kText);
      y_ += 15;
    };
    PlacedStation example;
    draw_station(canvas, {x_ + 9, y_}, "S1", example, 6.5);
    words("station");
    if (kept) {
      example.existing = true;
      draw_station(canvas, {x_ + 9, y_}, "K1", example, 6.5);
      words("station that is there already");
    }
    if (left_out) {
      example.existing = false, example.status = StationStatus::clash;
      draw_station(canvas, {x_ + 9, y_}, "S2", example, 6.5);
      words("left out: no place to stand");
    }
    if (targets) {
      draw_target(canvas, {x_ + 9, y_}, false, kTargetMark);
      words("target: sphere or checkerboard");
    }
    if (control) {
      draw_target(canvas, {x_ + 9, y_}, true, kTargetMark);
      words("control point: known coordinates");
    }
    if (route) {
      canvas.line({x_, y_}, {x_ + 18, y_}, {.colour = kRoute, .width = 1.1, .dashes = {5, 2.5}});
      words("the round; dotted: back, or not known");
    }
    if (tape) {
      canvas.line({x_, y_}, {x_ + 18, y_}, {.colour = kTape, .width = 0.6});
      canvas.disc({x_ + 18, y_}, 1.6, kTape);
      words("distance to a corner, metres");
    }
    if (cut) {
      canvas.fill({x_, y_ - 4, 18, 8}, kCutTint);
      words("cut through, " + fixed(cut_over_, 1) + " m over the floor");
    }
    y_ += 4;
  }
  void cut_over(double metres) { cut_over_ = metres; }

  void list(const std::vector<std::size_t>& shown, const std::vector<StationFacts>& facts,
            std::span<const PlacedStation> stations) {
    Canvas& canvas = *sheet_.canvas;
    if (shown.empty()) return;
    canvas.text({x_, y_}, "In the order of visiting", {.size = 9, .bold = true});
    y_ += 14;
    constexpr double kName = 12, kLine = 9, kLast = 12;
    const double bottom = layout_.map.bottom(), end = x_ + kPanelWidth - 18, after_name = x_ + 56;
    const TextStyle name{.size = 8, .bold = true}, figures{.size = 7.5}, faint{.size = 7, .colour = kFaintInk};
    const auto coordinates = [&](std::size_t k) {
      const Vec3& ground = stations[k].ground;
      return fixed(ground.x, 2) + "  " + fixed(ground.y, 2) + "  z " + fixed(ground.z, 2);
    };
    // National coordinates do not fit beside a name.
    const bool beside = std::ranges::all_of(shown, [&](std::size_t k) {
      return canvas.text_width(coordinates(k), figures) <= end - after_name &&
             canvas.text_width(facts[k].name, name) <= after_name - x_ - 20;
    });
    // Lines below a station's coordinates: one each for its registration, for its distances, and for the surface that
    // it alone sees, as far as all stations have room for them.
    enum class Lines { one, two, three };
    const auto lines_of = [&](const StationFacts& f, Lines wanted) {
      std::vector<std::string> lines{f.note};
      const auto add = [&](const std::string& text) {
        if (!text.empty()) lines.back() += (lines.back().empty() ? "" : "; ") + text;
      };
      add(f.register_to);
      if (wanted != Lines::one) lines.emplace_back();
      if (!f.targets.empty()) add("targets " + f.targets);
      if (!f.corners.empty()) add("corners " + tape_text(f.corners));
      if (wanted == Lines::three) lines.emplace_back();
      if (wanted != Lines::two && f.alone > 0)
        add((wanted == Lines::three ? "alone sees " : "alone: ") + f.alone_where);
      std::erase(lines, std::string());
      return lines;
    };
    const auto height = [&](std::size_t k, Lines wanted) {
      return kName + kLine * static_cast<double>(lines_of(facts[k], wanted).size() + (beside ? 0 : 1));
    };
    const auto all_fit = [&](Lines wanted) {
      double sum = 0;
      for (const std::size_t k : shown) sum += height(k, wanted);
      return sum <= bottom - y_;
    };
    const Lines wanted = all_fit(Lines::three) ? Lines::three : all_fit(Lines::two) ? Lines::two : Lines::one;
    const double room = bottom - (all_fit(wanted) ? 0 : kLast);
    std::size_t fit = 0;
    for (; fit < shown.size() && y_ + height(shown[fit], wanted) <= room; ++fit) {
      const StationFacts& f = facts[shown[fit]];
      const double left = x_ + 17;
      canvas.text({x_ + 12, y_}, f.stop > 0 ? std::to_string(f.stop) + "." : "–",
                  {.size = 7.5, .colour = kFaintInk, .across = Align::end});
      canvas.text({left, y_}, fitted(canvas, f.name, (beside ? after_name : end) - left - 3, name), name);
      const double from = beside ? after_name : left;
      double y = beside ? y_ : y_ + kLine;
      TextStyle whole = figures;
      whole.size = fitting_size(canvas, coordinates(shown[fit]), end - from, figures);
      canvas.text({from, y}, coordinates(shown[fit]), whole);
      for (const std::string& text : lines_of(f, wanted))
        canvas.text({left, y += kLine}, fitted(canvas, text, end - left, faint), faint);
      y_ += height(shown[fit], wanted);
    }
    if (shown.size() > fit)
      canvas.text({x_, bottom - 6}, std::to_string(shown.size() - fit) + " more in the table of stations",
                  {.size = 7.5, .colour = kFaintInk});
  }

 private:
  void line(const std::string& text, const TextStyle& style, double step) {
    sheet_.canvas->text({x_, y_}, fitted(*sheet_.canvas, text, kPanelWidth - 20, style), style);
    y_ += step;
  }

  Sheet& sheet_;
  const SheetLayout& layout_;
  double x_, y_, cut_over_ = 0;
};

// The content of all sheets. Borrows it.
struct Drawing {
  const Report& report;
  const std::vector<StationFacts>& facts;
  const std::vector<TargetFacts>& of_targets;
  const Scene& scene;
  const SearchArea& area;
  std::vector<std::size_t> order;       // of visiting
  std::vector<std::uint32_t> surfaces;  // that a section cuts; empty if no level is cut

  const Evaluation& network() const { return report.shown(); }
  const std::vector<PlacedStation>& stations() const { return network().stations; }
};

// The stations that sheets list, and those that they only mark.
struct ShownRound {
  const Round* walked = nullptr;
  std::vector<bool> own, others;
};

// A sheet of a layout, to be drawn.
struct PlannedSheet {
  std::shared_ptr<const SheetLayout> layout;
  std::size_t number;
  const PlanLevel& level;
  std::shared_ptr<const ShownRound> round;
  std::string name;
  std::shared_ptr<const SheetLayout> sheets = {};  // set in an overview: of these
};

struct DrawnSheet {
  std::optional<Sheet> sheet;                              // empty if stopped
  std::vector<std::pair<std::size_t, double>> off_middle;  // its stations, in metres from the middle of a map
};

DrawnSheet draw_sheet(const Drawing& of, const PlannedSheet& planned) {
  const auto& [layout, number, level, round, name, overview] = planned;
  const std::vector<PlacedStation>& stations = of.stations();
  const std::vector<Target>& targets = of.network().targets;
  DrawnSheet drawn{.sheet = Sheet(layout->paper), .off_middle = {}};
  Sheet& sheet = *drawn.sheet;
  std::vector<std::size_t> shown;
  std::vector<bool> here(stations.size(), false);
  bool target_here = false, control_here = false;
  for (const MapTile& tile : layout->tiles) {
    if (tile.sheet != number) continue;
    MapOnSheet map(sheet, *layout, tile, level);
    map.clip();
    map.site(of.scene, of.area, stations, of.surfaces);
    if (!level.cut) map.walls(of.scene.data());
    if (layout->strips) map.name(tile.name + " of " + std::to_string(layout->tiles.size()));
    if (overview) {
      map.tiles(overview->tiles);
      map.dots(stations, round->own);
    } else {
      if (round->walked) map.route(*round->walked);
      map.dots(stations, round->others);
      map.stations(stations, of.facts, round->own);
      map.targets(targets, of.of_targets);
    }
    map.rooms(of.scene.rooms());
    map.unclip();
    map.grid();
    if (overview) continue;
    for (std::size_t k = 0; k < stations.size(); ++k) {
      const PlacedStation& s = stations[k];
      if (!round->own[k] || !stands_on(s, level) || !map.holds(s.ground)) continue;
      here[k] = true;
      const Vec3 away = s.ground - tile.window.centre();
      drawn.off_middle.emplace_back(k, std::hypot(away.x, away.y));
    }
    for (const Target& target : targets)
      if (stands_on(target, level) && map.holds(target.centre))
        (target.control_m > 0 ? control_here : target_here) = true;
  }
  std::ranges::copy_if(of.order, std::back_inserter(shown), [&](std::size_t k) { return here[k]; });
  SheetPanel panel(sheet, *layout);
  panel.head(of.report.options.title, name, of.report.options);
  panel.scale_and_north(of.report.crs);
  if (level.cut) panel.cut_over(*level.cut - level.floor);
  const auto any = [&](auto wanted) { return std::ranges::any_of(shown, wanted); };
  if (!overview)
    panel.legend(level.cut.has_value(), round->walked != nullptr,
                 any([&](std::size_t k) { return !of.facts[k].corners.empty(); }),
                 any([&](std::size_t k) { return stations[k].existing; }),
                 any([&](std::size_t k) { return !active(stations[k]); }), target_here, control_here);
  panel.list(shown, of.facts, stations);
  return drawn;
}

// Plans the sheets of a level, with an overview first if they are several. `name`: the level's.
void plan_level(std::vector<PlannedSheet>& sheets, const Drawing& of, const PlanLevel& level, std::string name,
                const std::shared_ptr<const ShownRound>& round) {
  const std::vector<PlacedStation>& stations = of.stations();
  std::vector<Vec3> spots;
  std::vector<WallCorner> corners;
  for (std::size_t s = 0; s < stations.size(); ++s) {
    if (!round->own[s] || !stands_on(stations[s], level)) continue;
    spots.push_back(stations[s].ground);
    corners.insert(corners.end(), of.facts[s].corners.begin(), of.facts[s].corners.end());
  }
  if (spots.empty()) return;
  name += ", " + std::to_string(spots.size()) + (spots.size() == 1 ? " station" : " stations");
  for (const Target& target : of.network().targets)
    if (stands_on(target, level)) spots.push_back(target.centre);
  const auto layout = std::make_shared<const SheetLayout>(layout_of(level, of.area.mesh(), spots, corners));
  if (layout->sheets() > 1) {
    Box box;
    for (const MapTile& tile : layout->tiles) box.extend(tile.window.min), box.extend(tile.window.max);
    sheets.push_back({.layout = std::make_shared<const SheetLayout>(lay_out_overview(grown(box, 1), kPanelWidth)),
                      .number = 0,
                      .level = level,
                      .round = round,
                      .name = name + ": where the sheets lie",
                      .sheets = layout});
  }
  for (std::size_t sheet = 0; sheet < layout->sheets(); ++sheet) {
    const auto on_it = [&](const MapTile& tile) { return tile.sheet == sheet; };
    const auto first = std::ranges::find_if(layout->tiles, on_it);
    const auto count = std::ranges::count_if(layout->tiles, on_it);
    std::string part;
    if (layout->strips)
      part = ", in strips from " +
             std::string(layout->tiles[0].window.min.x < layout->tiles[1].window.min.x ? "west to east"
                                                                                       : "north to south") +
             (layout->sheets() > 1 ? ": " + first->name + " to " + (first + count - 1)->name : "");
    else if (!first->name.empty())
      part = ": sheet " + first->name;
    sheets.push_back({.layout = layout, .number = sheet, .level = level, .round = round, .name = name + part});
  }
}

}  // namespace

FieldSheets field_sheets(const Report& report, const std::vector<StationFacts>& facts,
                         const std::vector<TargetFacts>& of_targets, Site& site, const std::stop_token& stop) {
  const std::vector<PlacedStation>& stations = report.shown().stations;
  const std::vector<PlanLevel> levels = cut_levels(site.scene(), site.area().mesh(), stations);
  const bool any_cut = std::ranges::any_of(levels, [](const PlanLevel& level) { return level.cut.has_value(); });
  const Drawing of{.report = report,
                   .facts = facts,
                   .of_targets = of_targets,
                   .scene = site.scene(),
                   .area = site.area(),
                   .order = visiting_order(facts),
                   .surfaces = any_cut ? surfaces_of(site.scene().data()) : std::vector<std::uint32_t>()};
  std::vector<PlannedSheet> planned;
  const std::vector<SheetRound> rounds = sheet_rounds(report.shown());
  for (const SheetRound& round : rounds) {
    ShownRound shown{.walked = round.round,
                     .own = own_stations(round, rounds.size() > 1, stations.size()),
                     .others = std::vector<bool>(stations.size())};
    for (std::size_t s = 0; s < stations.size(); ++s) shown.others[s] = !shown.own[s] && active(stations[s]);
    const auto shared = std::make_shared<const ShownRound>(std::move(shown));
    for (std::size_t k = 0; k < levels.size(); ++k) {
      std::string name = round.name.empty() ? "" : round.name + " (" + minutes_text(round.round->minutes) + "): ";
      name += levels.size() > 1 ? "Storey " + std::to_string(k + 1) + " of " + std::to_string(levels.size()) +
                                      ", floor at z = " + fixed(levels[k].floor, 2) + " m"
                                : "Map of the stations";
      plan_level(planned, of, levels[k], std::move(name), shared);
    }
  }
  std::vector<DrawnSheet> drawn(planned.size());
  parallel::for_all(std::size_t{0}, planned.size(), [&](std::size_t k) {
    if (!stop.stop_requested()) drawn[k] = draw_sheet(of, planned[k]);
  });
  FieldSheets all{.of_station = std::vector<std::size_t>(stations.size(), 0)};
  std::vector<double> nearest(stations.size(), std::numeric_limits<double>::max());
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    if (!drawn[k].sheet) continue;
    all.sheets.push_back(std::move(*drawn[k].sheet));
    all.names.push_back(std::move(planned[k].name));
    for (const auto& [station, off] : drawn[k].off_middle)
      if (off < nearest[station]) nearest[station] = off, all.of_station[station] = all.sheets.size();
  }
  return all;
}

}  // namespace vantage
