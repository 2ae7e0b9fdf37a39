// SPDX-License-Identifier: Apache-2.0
// The pages of a plan view: the maps, what their marks mean, and a scale bar.

#include <algorithm>
#include <cmath>
#include <string>

#include "core/parallel.hpp"
#include "core/tenths.hpp"
#include "core/text.hpp"
#include "map/chart.hpp"
#include "map/left_out_hatch.hpp"
#include "map/map_grid.hpp"
#include "map/pictures.hpp"
#include "map/plan_map.hpp"
#include "map/relief.hpp"
#include "map/search_tint.hpp"
#include "scene/changed_scene.hpp"
#include "vantage/error.hpp"
#include "vantage/pictures.hpp"

namespace vantage {
namespace {

constexpr double kPanel = 224, kTop = 68, kBottom = 64, kGap = 26;
// Largest number of stations on a map of usual size, and largest factor of its width.
constexpr double kStationsAtFirst = 60, kMostGrowth = 3;

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

std::string link_words(const StationLinks& links) {
  return links.measure == LinkMeasure::scan_overlap ? "Scan overlap of two stations" : "Overlap of two stations";
}

// Draws the legend of links. Returns its end, as the function for the whole legend does.
double draw_link_legend(Canvas& canvas, Point at, const PlanView& view, const PlanMapContent& content) {
  constexpr TextStyle kText{.size = 12.5}, kFaint{.size = 12.5, .colour = style::kFaint};
  const auto words = [&](const std::string& what) { canvas.text({at.x + 34, at.y}, what, kText); };
  if (content.largest > 0) {
    at.y += 6;
    canvas.text(at, link_words(view.links), {.size = 12.5, .bold = true});
    at.y += 22;
    for (const double overlap : kLinkSamples) {
      draw_link(canvas, {at.x, at.y}, {at.x + 24, at.y}, overlap, false, false);
      words(number(overlap) + (overlap == std::end(kLinkSamples)[-1] ? " and more" : ""));
      at.y += 22;
    }
    if (content.bridge) {
      draw_link(canvas, {at.x, at.y}, {at.x + 24, at.y}, 0.2, true, false);
      words("the only link of two parts");
      at.y += 22;
    }
    canvas.text(at, "largest " + fixed(content.largest, 3), kFaint);
    canvas.text({at.x, at.y + 17}, "below " + number(view.links.least) + " not drawn", kFaint);
    at.y += 34;
    if (content.hidden_links > 0) {
      canvas.text(at, "strongest tree, two of each station;", kFaint);
      canvas.text({at.x, at.y + 17}, number(static_cast<double>(content.hidden_links)) + " further links not drawn",
                  kFaint);
      at.y += 34;
    }
  } else if (view.stations.size() > 1 && view.links.values.size() == view.stations.size()) {
    canvas.text({at.x, at.y + 6}, "no overlap above " + number(view.links.least), kFaint);
    at.y += 24;
  }
  return at.y;
}

// Draws what the marks mean below each other and returns where it ends.
double draw_plan_legend(Canvas& canvas, Point at, const PlanView& view, const PlanMapContent& content) {
  constexpr TextStyle kText{.size = 12.5};
  const auto words = [&](const std::string& what) { canvas.text({at.x + 34, at.y}, what, kText); };
  const auto swatch = [&](const Colour& colour, const std::string& what) {
    canvas.fill({at.x, at.y - 7, 24, 14}, colour);
    words(what);
    at.y += 24;
  };
  const auto any = [&](auto wanted) { return std::ranges::any_of(view.stations, wanted); };
  swatch(kSurveyedTint, "surveyed");
  const auto some = [&](auto wanted) { return std::ranges::any_of(view.scene.meshes(), wanted); };
  if (some([](const MeshInfo& m) { return m.role == Role::blocking && !m.glass && m.name != kNotInModel; }))
    swatch(kBlockingTint, "not surveyed");
  if (some([](const MeshInfo& m) { return m.name == kNotInModel; })) swatch(kFoundTint, "found, not in the model");
  if (some([](const MeshInfo& m) { return m.name == kUnknown; })) swatch(kUnknownTint, "unknown, not seen");
  if (content.cut) swatch(kCutTint, "cut through");
  if (content.cut && some(&MeshInfo::glass)) swatch(kGlassTint, "glass");
  canvas.fill({at.x, at.y - 7, 24, 14}, kBlockingTint);
  canvas.fill({at.x, at.y - 7, 24, 14}, kSearchTint, kSearchOpacity);
  canvas.rectangle({at.x + 0.5, at.y - 6.5, 23, 13}, {.colour = kSearchTint, .width = 1, .opacity = kSearchRim});
  words("search area");
  at.y += 28;
  if (content.left_out) {
    canvas.fill({at.x, at.y - 7, 24, 14}, kBlockingTint);
    canvas.clip({at.x, at.y - 7, 24, 14});
    for (double x = at.x - 14; x < at.x + 24; x += 5.5)
      canvas.line({x, at.y + 7}, {x + 14, at.y - 7}, {.colour = kLeftOutTint, .width = 1.4, .opacity = 0.6});
    canvas.unclip();
    words("walkable, but left out");
    at.y += 28;
  }
  const auto station = [&](const std::string& name, const PlacedStation& example, const std::string& what) {
    draw_station(canvas, {at.x + 12, at.y}, name, example);
    words(what);
    at.y += 28;
  };
  PlacedStation example;
  station("S1", example, content.heights ? "station; z of its ground" : "station");
  if (any([](const PlacedStation& s) { return s.existing; })) {
    example.existing = true;
    station("K1", example, "existing: there before");
  }
  if (any([](const PlacedStation& s) { return s.status != StationStatus::hole && !active(s); })) {
    example.existing = false, example.status = StationStatus::clash;
    station("S2", example, "skipped: no place to stand");
  }
  const auto target = [&](bool control, const std::string& what) {
    draw_target(canvas, {at.x + 12, at.y}, control);
    words(what);
    at.y += 28;
  };
  const auto of_kind = [&](bool control) {
    return std::ranges::any_of(view.targets, [&](const Target& t) { return (t.control_m > 0) == control; });
  };
  if (of_kind(false)) target(false, "target");
  if (of_kind(true)) target(true, "control point");
  if (content.elsewhere) {
    draw_elsewhere(canvas, {at.x + 12, at.y}, "S3");
    words("on another floor");
    at.y += 28;
  }
  if (content.moved) {
    canvas.line({at.x + 3, at.y}, {at.x + 22, at.y}, {.width = 1.5});
    canvas.disc({at.x + 3, at.y}, 3.4, style::kInk);
    words("true spot of a disc beside it");
    at.y += 28;
  }
  if (const double scale = view.ellipse_scale(); scale > 0) {
    canvas.circle({at.x + 12, at.y}, 8, {.colour = {0.72, 0.12, 0.12}, .width = 1.3});
    words("standard ellipse of a head:");
    canvas.text({at.x + 34, at.y + 17}, "the widest " + tenths(1000 * kWidestEllipse / scale) + " mm", kText);
    at.y += 45;
  }
  const auto holes = std::ranges::count(view.stations, StationStatus::hole, &PlacedStation::status);
  if (holes > 0) {
    canvas.text(at, std::to_string(holes) + (holes == 1 ? " station in a hole," : " stations in holes,"), kText);
    canvas.text({at.x, at.y + 17}, "not shown", kText);
    at.y += 45;
  }
  return draw_link_legend(canvas, at, view, content);
}

std::string level_words(const std::vector<PlanLevel>& levels, std::size_t k) {
  return "Level " + std::to_string(k + 1) + " of " + std::to_string(levels.size()) +
         ", floor at z = " + fixed(levels[k].floor, 2) + " m";
}

// A page with one map for each of these levels.
std::unique_ptr<Canvas> draw_page(const PlanView& view, const Box& window, const std::vector<PlanLevel>& levels,
                                  std::size_t first, std::size_t count) {
  const bool floors = levels.size() > 1;
  const MapGrid grid(count);
  // Larger maps for many stations, so that their marks keep apart; of several levels each has a page of its own.
  std::size_t most = 0;
  for (std::size_t k = first; count == 1 && k < first + count; ++k)
    most = static_cast<std::size_t>(std::ranges::count_if(view.stations, [&](const PlacedStation& s) {
      return s.status != StationStatus::hole && levels[k].holds(s.ground.z);
    }));
  const double grow = std::clamp(std::sqrt(static_cast<double>(most) / kStationsAtFirst), 1.0, kMostGrowth);
  const double metre = grow * std::min(grid.width / window.size().x, grid.height / window.size().y);
  const double width = std::max(1.0, std::floor(window.size().x * metre)),
               height = std::max(1.0, std::floor(window.size().y * metre));
  Canvas scratch(1, 1);
  const double left = room_left_of(scratch, {.label = {},
                                             .low = window.min.y,
                                             .high = window.max.y,
                                             .wanted_ticks = std::max(2, static_cast<int>(height / 95))});
  const auto subtitle = [&](std::size_t k) {
    return grid.contact() ? "Level " + std::to_string(k + 1) + ", z = " + fixed(levels[k].floor, 2) + " m"
           : floors       ? level_words(levels, k)
                          : "";
  };
  double words = 0;  // below the title; a level is cut about as high as its floor is
  for (std::size_t k = first; floors && k < first + count; ++k)
    words = std::max(
        words,
        scratch.text_width(subtitle(k) + (grid.contact() ? "" : ", cut at z = " + fixed(levels[k].floor, 2) + " m"),
                           {.size = 12.5}));
  const double apart = std::max(width + left + 10, words + 30), below = height + kBottom + 30;
  const auto map_at = [&](std::size_t k) {
    return Rect{left + static_cast<double>(k % grid.columns) * apart,
                kTop + static_cast<double>(k / grid.columns) * below, width, height};
  };
  const double right = map_at(grid.columns - 1).right(), bottom = map_at(count - 1).bottom();

  const auto draw = [&](Canvas& canvas) {
    PlanMapContent content;
    for (std::size_t k = 0; k < count; ++k)
      content = content | draw_plan_map(canvas, map_at(k), view, window, levels[first + k], k == 0 ? view.title : "",
                                        subtitle(first + k), grid.contact());
    const double end = draw_plan_legend(canvas, {right + 24, kTop + 8}, view, content);
    const double bar = std::max(bottom - 6, end + 30);
    draw_scale_bar(canvas, {right + 25, bar}, kPanel - 40, metre);
    return bar;
  };
  const double title = scratch.text_width(view.title, {.size = 17, .bold = true});
  const double page_width =
      std::max({right + kGap + kPanel, left + title + 20, map_at(grid.columns - 1).x + words + 20});
  constexpr double kLongestLegend = 700;
  auto page = std::make_unique<Canvas>(page_width, bottom + kBottom + kLongestLegend);
  const double bar = draw(*page);
  page->cut_to(std::max(bottom + kBottom, bar + 24));
  return page;
}

}  // namespace

std::vector<PlanPage> plan_view_pictures(const PlanView& view, const std::stop_token& late) {
  if (view.links.values.size() != view.stations.size() && view.links.values.size() != 0)
    throw Error(Errc::invalid_argument, "draw_plan_view: " + std::to_string(view.stations.size()) +
                                            " stations, but an overlap matrix of " +
                                            std::to_string(view.links.values.size()));
  if (view.errors.size() != view.stations.size() && !view.errors.empty())
    throw Error(Errc::invalid_argument, "draw_plan_view: " + std::to_string(view.stations.size()) + " stations, but " +
                                            std::to_string(view.errors.size()) + " errors");
  const Box window = plan_window(view);
  const std::vector<PlanLevel> levels = cut_levels(view.scene, view.area.mesh(), view.stations);
  // One of all levels; of several each on its own, too.
  std::vector<PlanPage> pages(levels.size() > 1 ? levels.size() + 1 : 1);
  parallel::for_all(std::size_t{0}, pages.size(), [&](std::size_t k) {
    pages[k].suffix = k == 0 ? "" : "-level-" + std::to_string(k);
    if (k == 0)
      pages[k].canvas = draw_page(view, window, levels, 0, levels.size());
    else if (!late.stop_requested())
      pages[k].canvas = draw_page(view, window, levels, k - 1, 1);
  });
  return pages;
}

std::vector<std::filesystem::path> draw_plan_view(const std::filesystem::path& file, Site& site,
                                                  std::span<const PlacedStation> stations, const StationLinks& links,
                                                  const std::string& title, std::span<const std::string> names,
                                                  std::span<const StationError> errors,
                                                  std::span<const Target> targets) {
  const PlanView view{.scene = site.scene(),
                      .area = site.area(),
                      .stations = stations,
                      .names = station_names(stations, names),
                      .links = links,
                      .title = title,
                      .errors = errors,
                      .targets = targets};
  std::vector<std::filesystem::path> written;
  for (const PlanPage& page : plan_view_pictures(view)) {
    const std::filesystem::path one =
        file.parent_path() / (file.stem().string() + page.suffix + file.extension().string());
    page.canvas->save(one);
    written.push_back(one);
  }
  return written;
}

}  // namespace vantage
