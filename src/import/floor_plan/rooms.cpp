// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/rooms.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "import/floor_plan/grid.hpp"
#include "import/floor_plan/labels.hpp"
#include "import/program.hpp"

namespace vantage::floor_plan {
namespace {

constexpr double kSmallestRoom_m2 = 0.3;
constexpr double kEnclosed = 0.25;  // least share of the walls' hull that rooms cover if the outer walls close

std::vector<Shape> enclosed(const Shape& closed, double gap_m) {
  // GEOS widens fine teeth, such as ends of an exploded hatch, in quadratic time; outlines need no teeth.
  constexpr double kTooth_m = 0.02;
  std::vector<Shape> outlines;
  for (const Shape& part : polygons(gap_m > 0 ? grown(straightened(closed, kTooth_m), gap_m / 2) : clone(closed)))
    outlines.push_back(filled(part));
  Shape outline = areas(united(std::move(outlines)));
  if (gap_m > 0) outline = grown(outline, -gap_m / 2);
  std::vector<Shape> rooms;
  // Slivers between lines that nearly meet are no rooms.
  for (Shape& room : polygons(without(outline, closed)))
    if (area(room) >= kSmallestRoom_m2 && !is_empty(grown(room, -0.15))) rooms.push_back(std::move(room));
  return rooms;
}

// Lines of one label stand below each other; several labels are joined by a stroke.
struct Names {
  std::string text;
  std::size_t labels = 0;
  const Text* last = nullptr;
  std::vector<const Text*> taken;

  void add(const Text& next) {
    constexpr std::size_t kMostLabels = 3, kLongest = 60;
    constexpr double kLine = 2.5;  // heights of a text
    const auto near = [&](const Text* other) {
      return distance(other->insertion, next.insertion) <= kLine * std::max(other->height, next.height);
    };
    // A text that is drawn twice, or with a shadow, counts once.
    if (std::ranges::any_of(taken, [&](const Text* other) { return other->text == next.text && near(other); })) return;
    const bool goes_on = last && near(last);
    last = &next;
    if (text.size() + next.text.size() > kLongest || (!goes_on && labels >= kMostLabels)) return;
    taken.push_back(&next);
    labels += !goes_on;
    text += (text.empty() ? "" : goes_on ? " " : " / ") + next.text;
  }
};

void add_names(std::vector<Room>& rooms, const std::vector<Text>& texts) {
  std::vector<const Text*> order;  // from top to bottom, in reading order
  for (const Text& text : texts)
    if (label_of(text.text) != Label::nothing && text.from.kind != Kind::furniture) order.push_back(&text);
  std::ranges::stable_sort(order, {}, [](const Text* text) { return -text->at.y; });
  Grid grid(4.0);
  std::vector<Region> regions;
  for (const Room& room : rooms) {
    const Bounds box = bounds(room.area);
    grid.add(regions.size(), box.low, box.high);
    regions.emplace_back(clone(room.area));
  }
  std::vector<Names> names(rooms.size());
  for (const Text* text : order) {
    std::optional<std::size_t> room;
    // A text that is wider than its room begins in it.
    for (const Point& p : {text->at, text->insertion})
      if (!room) grid.visit(p, p, [&](std::size_t r) { room = !room && regions[r].holds(p) ? r : room; });
    if (!room) continue;
    if (label_of(text->text) == Label::name)
      names[*room].add(*text);
    else if (rooms[*room].number.empty())
      rooms[*room].number = text->text;
  }
  for (std::size_t r = 0; r < rooms.size(); ++r) rooms[r].name = names[r].text;
}

}  // namespace

Rooms find_rooms(const Shape& solid, const std::vector<Opening>& openings, const std::vector<Text>& texts) {
  std::vector<Shape> all;
  all.push_back(clone(solid));
  std::vector<Point> corners;
  for (const auto& ring : rings(solid)) corners.insert(corners.end(), ring.begin(), ring.end());
  for (const Opening& opening : openings) all.push_back(clone(opening.area));
  const Shape closed = areas(united(std::move(all)));
  Rooms out;
  std::vector<Shape> found;
  const Shape whole = hull(corners);
  constexpr std::array kGaps{0.0, 0.5, 1.5, 3.0};
  // Takes the smallest gap that finds nearly all that the widest one finds.
  constexpr double kNearlyAll = 0.85;
  const auto sum = [](const std::vector<Shape>& rooms) {
    double m2 = 0;
    for (const Shape& room : rooms) m2 += area(room);
    return m2;
  };
  found = enclosed(closed, kGaps.back());
  const double most = sum(found);
  out.closed_m = kGaps.back();
  for (std::size_t k = 0; k + 1 < kGaps.size(); ++k)
    if (auto rooms = enclosed(closed, kGaps[k]); sum(rooms) >= kNearlyAll * most && !rooms.empty()) {
      found = std::move(rooms), out.closed_m = kGaps[k];
      break;
    }
  if (most < kEnclosed * area(whole)) {  // a pavilion: walls that enclose little
    out.open = true;
    found = polygons(without(whole, closed));
  }
  if (found.empty())
    throw importer::Refused("its walls enclose no ground; name their layers with the setting wall-layer");
  for (Shape& room : found) out.rooms.push_back({std::move(room), {}, {}});
  add_names(out.rooms, texts);
  return out;
}

}  // namespace vantage::floor_plan
