// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/stairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "import/floor_plan/grid.hpp"
#include "import/floor_plan/labels.hpp"

namespace vantage::floor_plan {
namespace {

constexpr double kNarrowest_m = 0.55, kWidest_m = 4;       // flights
constexpr double kLeastGoing_m = 0.2, kMostGoing_m = 0.4;  // treads
constexpr double kLeastRiser_m = 0.13, kMostRiser_m = 0.21;
constexpr std::size_t kLeastRisers = 4;
constexpr double kSameGoing = 0.1, kSameWidth = 0.2, kSameWay = 0.035;  // shares; radians
constexpr double kBetweenFlights_m = 0.6;
constexpr double kBeyond_m = 0.4;  // floor must lie this far before a stair's ends
constexpr double kLeastLanding_m = 0.6;
constexpr double kThickness_m = 0.15;        // of a step, below its riser
constexpr double kTwice_m = 0.05;            // lines this near each other count as one
constexpr std::size_t kMostTreads = 20'000;  // of a drawing; more are none
constexpr double kWords_m = 1.5;             // texts this near a flight refer to it

Point across(Point along) { return {-along.y, along.x}; }

struct Tread {
  Point middle;
  double width = 0;
};

// Adds chains of parallel lines, each a going beyond the one before.
void add_flights(std::vector<Tread> treads, Point way, std::vector<Flight>& out) {
  const Point along = across(way);  // direction of the flight, across its lines
  std::ranges::sort(treads, {}, [&](const Tread& t) { return dot(t.middle, along); });
  // A line that is drawn twice counts once.
  std::vector<Tread> once;
  for (const Tread& tread : treads) {
    bool again = false;
    for (std::size_t k = once.size(); k > 0 && !again; --k) {
      if (dot(tread.middle - once[k - 1].middle, along) > kTwice_m) break;
      again = distance(once[k - 1].middle, tread.middle) < kTwice_m && std::abs(once[k - 1].width - tread.width) < 0.1;
    }
    if (!again) once.push_back(tread);
  }
  std::vector<bool> taken(once.size());
  for (std::size_t first = 0; first < once.size(); ++first) {
    if (taken[first]) continue;
    std::vector<std::size_t> chain{first};
    double going = 0;
    for (bool more = true; more;) {
      more = false;
      const Tread& last = once[chain.back()];
      for (std::size_t k = chain.back() + 1; k < once.size() && !more; ++k) {
        const Point step = once[k].middle - last.middle;
        const double d = dot(step, along);
        if (d > kMostGoing_m) break;
        if (taken[k] || d < kLeastGoing_m || std::abs(cross(along, step)) > kSameWidth * last.width ||
            std::abs(once[k].width - last.width) > kSameWidth * last.width ||
            (going > 0 && std::abs(d - going) > kSameGoing * going))
          continue;
        if (going == 0) going = d;
        chain.push_back(k), more = true;
      }
    }
    if (chain.size() < kLeastRisers) continue;
    double width = 0;
    Point sum;
    for (const std::size_t k : chain) {
      taken[k] = true, width += once[k].width;
      sum = sum + once[k].middle;
    }
    const auto n = static_cast<double>(chain.size());
    const Point middle = sum * (1 / n);
    const double from = dot(once[chain.front()].middle - middle, along),
                 to = dot(once[chain.back()].middle - middle, along);
    out.push_back({middle + along * from, along, to - from, width / n, chain.size()});
  }
}

// Floor of a storey, queried by points in the metres of both drawings.
class Floor {
 public:
  explicit Floor(const StairStorey& storey) : origin_(storey.origin) {
    for (const Room& room : storey.rooms->rooms) {
      const Bounds box = bounds(room.area);
      grid_.add(rooms_.size(), box.low, box.high);
      rooms_.emplace_back(clone(room.area));
    }
    for (const Opening& opening : *storey.openings) {
      if (opening.kind == Opening::window) continue;
      const Bounds box = bounds(opening.area);
      doors_.push_back((box.low + box.high) * 0.5 + origin_);
    }
  }
  bool holds(Point p) const {
    bool found = false;
    grid_.visit(p - origin_, p - origin_, [&](std::size_t r) { found = found || rooms_[r].holds(p - origin_); });
    return found;
  }
  // Returns the distance to the nearest door.
  double to_door(Point p) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Point& door : doors_) nearest = std::min(nearest, distance(door, p));
    return nearest;
  }
  // Returns the length of floor from p on, at most `most`.
  double reach(Point p, Point along, double most) const {
    constexpr double kStep = 0.05;
    double far = 0;
    while (far + kStep <= most && holds(p + along * (far + kStep))) far += kStep;
    return far;
  }

 private:
  Point origin_;
  Grid grid_{4.0};
  std::vector<Region> rooms_;
  std::vector<Point> doors_;
};

std::array<Point, 4> box(Point front, Point along, double length, double width) {
  const Point side = across(along) * (0.5 * width);
  return {front + side, front - side, front - side + along * length, front + side + along * length};
}

// Adds the steps of a flight that begins `low_m` above the lower floor. The last riser leads to the floor or landing.
void add_steps(const Flight& flight, double low_m, double riser_m, std::vector<Step>& steps) {
  const double going = flight.length / static_cast<double>(flight.risers - 1);
  for (std::size_t k = 0; k + 1 < flight.risers; ++k) {
    const double high = low_m + static_cast<double>(k + 1) * riser_m;
    steps.push_back(
        {box(flight.foot + flight.along * (static_cast<double>(k) * going), flight.along, going, flight.width),
         std::max(0.0, high - riser_m - kThickness_m), high});
  }
}

class StairFinder {
 public:
  StairFinder(const StairStorey& lower, const StairStorey& upper, double rise_m)
      : lower_(lower), upper_(upper), below_(lower), above_(upper), rise_m_(rise_m) {}

  StairsFound find() {
    // A drawing shows what is below its cut, so a stair is complete in the upper drawing, or in both.
    for (const StairStorey* storey : {&lower_, &upper_}) {
      std::vector<Flight> flights = *storey->flights;
      for (Flight& flight : flights) flight.foot = flight.foot + storey->origin;
      std::erase_if(flights, [&](const Flight& flight) { return is_made(flight); });
      pair_up(flights);
      for (const Flight& flight : flights) single(flight);
    }
    std::erase_if(found_.left_out, [&](const auto& left) {
      return std::ranges::any_of(found_.stairs, [&](const Stair& stair) {
        return std::ranges::any_of(stair.hole, [&](const auto& corners) { return inside(corners, left.first); });
      });
    });
    return std::move(found_);
  }

 private:
  static bool inside(const std::array<Point, 4>& corners, Point p) {
    for (std::size_t k = 0; k < 4; ++k)
      if (cross(corners[(k + 1) % 4] - corners[k], p - corners[k]) < 0) return false;
    return true;
  }
  static Point middle(const Flight& flight) { return flight.foot + flight.along * (0.5 * flight.length); }
  bool is_made(const Flight& flight) const {
    return std::ranges::any_of(found_.stairs, [&](const Stair& stair) {
      return std::ranges::any_of(stair.hole, [&](const auto& corners) { return inside(corners, middle(flight)); });
    });
  }
  void leave_out(const Flight& flight, const std::string& why) {
    const bool again = std::ranges::any_of(
        found_.left_out, [&](const auto& left) { return distance(left.first, middle(flight)) < flight.length; });
    if (!again) found_.left_out.emplace_back(middle(flight), why);
  }
  std::string height_of(std::size_t risers) const {
    const double cm = 100 * rise_m_ / static_cast<double>(risers);
    return std::to_string(risers) + " risers would be " + std::to_string(std::lround(cm)) + " cm high";
  }
  bool climbs(std::size_t risers) const {
    const double riser = rise_m_ / static_cast<double>(risers);
    return riser >= kLeastRiser_m && riser <= kMostRiser_m;
  }
  // Returns what texts say about the end at `foot` of a flight: 1: the lower end, -1: the upper end, 0: nothing.
  int told(const Flight& flight) const {
    for (const StairStorey* storey : {&lower_, &upper_})
      for (const Text& text : *storey->texts) {
        const int way = stair_way(text.text);
        const Point at = text.at + storey->origin;
        const double to_foot = distance(at, flight.foot), to_head = distance(at, flight.head());
        if (way == 0 || std::min(to_foot, to_head) > kWords_m || std::abs(to_foot - to_head) < 0.25 * flight.length)
          continue;
        // A text stands where its way begins, for UP and DN alike.
        return way * (to_foot < to_head ? 1 : -1);
      }
    return 0;
  }

  void single(const Flight& drawn) {
    if (is_made(drawn)) return;
    if (!climbs(drawn.risers)) return leave_out(drawn, height_of(drawn.risers));
    const auto fits = [&](const Flight& f) {
      return below_.holds(f.foot - f.along * kBeyond_m) && above_.holds(f.head() + f.along * kBeyond_m);
    };
    const bool as_drawn = fits(drawn), otherwise = fits(drawn.turned());
    if (!as_drawn && !otherwise) return leave_out(drawn, "its ends do not meet floor in both storeys");
    const int word = told(drawn);
    const bool turn = as_drawn && otherwise ? word < 0 : otherwise;
    const Flight flight = turn ? drawn.turned() : drawn;
    Stair stair{.steps = {},
                .hole = {box(flight.foot, flight.along, flight.length, flight.width)},
                .foot = flight.foot,
                .riser_m = rise_m_ / static_cast<double>(flight.risers),
                .assumed = as_drawn && otherwise && word == 0};
    add_steps(flight, 0, stair.riser_m, stair.steps);
    found_.stairs.push_back(std::move(stair));
  }

  // Joins two flights side by side that have a landing at one end of both.
  void pair_up(std::vector<Flight>& flights) {
    for (std::size_t a = 0; a < flights.size(); ++a)
      for (std::size_t b = a + 1; b < flights.size(); ++b) {
        const Flight& one = flights[a];
        const Flight other = dot(one.along, flights[b].along) < 0 ? flights[b].turned() : flights[b];
        const Point apart = other.foot - one.foot;
        const double aside = cross(one.along, apart), shift = dot(one.along, apart);
        const double gap = std::abs(aside) - 0.5 * (one.width + other.width);
        if (std::abs(cross(one.along, other.along)) > kSameWay || gap < -0.1 || gap > kBetweenFlights_m ||
            std::abs(shift) > 0.5 * std::min(one.length, other.length) || climbs(one.risers) ||
            !climbs(one.risers + other.risers))
          continue;
        if (!landing(one, other)) continue;
        flights.erase(flights.begin() + static_cast<std::ptrdiff_t>(b));
        flights.erase(flights.begin() + static_cast<std::ptrdiff_t>(a));
        --a;
        break;
      }
  }

  // Tries a landing behind the heads of two flights of the same direction, and behind their feet.
  bool landing(const Flight& one, const Flight& other) {
    struct Try {
      Flight first, second;  // first goes up to the landing, second would go up from there, seen towards the landing
      double depth = 0, to_door = 0;
    };
    std::vector<Try> tries;
    for (const bool turned : {false, true}) {
      Try t{turned ? one.turned() : one, turned ? other.turned() : other, 0, 0};
      const Point along = t.first.along;
      const double end = std::max(dot(along, t.first.head()), dot(along, t.second.head()));
      const Point at_first = t.first.head() + along * (end - dot(along, t.first.head()));
      const Point at_second = t.second.head() + along * (end - dot(along, t.second.head()));
      const double most = std::max(t.first.width, t.second.width);
      t.depth = std::min(below_.reach(at_first, along, most), below_.reach(at_second, along, most));
      t.to_door = below_.to_door((t.first.foot + t.second.foot) * 0.5);
      if (t.depth >= kLeastLanding_m && below_.holds(t.first.foot - along * kBeyond_m) &&
          above_.holds(t.second.foot - along * kBeyond_m))
        tries.push_back(t);
    }
    if (tries.empty()) return false;
    const bool assumed = tries.size() > 1 && std::abs(tries[0].to_door - tries[1].to_door) < 0.3;
    Try best = *std::ranges::min_element(tries, {}, &Try::to_door);
    if (told(best.second) > 0 || told(best.first) < 0) std::swap(best.first, best.second);
    const Point along = best.first.along;
    const double riser = rise_m_ / static_cast<double>(one.risers + other.risers);
    const double end = std::max(dot(along, best.first.head()), dot(along, best.second.head()));
    Stair stair{.steps = {}, .hole = {}, .foot = best.first.foot, .riser_m = riser, .assumed = assumed};
    add_steps(best.first, 0, riser, stair.steps);
    const double half = static_cast<double>(best.first.risers) * riser;
    // The landing covers both flights and the space between them.
    const Point a = best.first.head(), b = best.second.head();
    const Point side = across(along);
    const double low = std::min(dot(side, a) - 0.5 * best.first.width, dot(side, b) - 0.5 * best.second.width);
    const double high = std::max(dot(side, a) + 0.5 * best.first.width, dot(side, b) + 0.5 * best.second.width);
    const auto place = [&](double on, double beside) { return along * on + side * beside; };
    for (const Flight& flight : {best.first, best.second}) {  // extends to the landing if their lengths differ
      const double own = dot(along, flight.head());
      if (end - own > 0.01)
        stair.steps.push_back({box(flight.head(), along, end - own, flight.width), half - riser - kThickness_m, half});
    }
    const std::array<Point, 4> platform{place(end, high), place(end, low), place(end + best.depth, low),
                                        place(end + best.depth, high)};
    stair.steps.push_back({platform, half - riser - kThickness_m, half});
    add_steps(best.second.turned(), half, riser, stair.steps);
    for (const Flight& flight : {best.first, best.second})
      stair.hole.push_back(box(flight.foot, along, end - dot(along, flight.foot), flight.width));
    stair.hole.push_back(platform);
    found_.stairs.push_back(std::move(stair));
    return true;
  }

  const StairStorey &lower_, &upper_;
  Floor below_, above_;
  double rise_m_;
  StairsFound found_;
};

}  // namespace

std::vector<Flight> find_flights(const Drawing& drawing) {
  std::vector<Tread> treads;
  std::vector<Point> ways;
  for (const Line& line : drawing.lines) {
    const double wide = distance(line.a, line.b);
    if (line.from.kind != Kind::stair || wide < kNarrowest_m || wide > kWidest_m) continue;
    treads.push_back({(line.a + line.b) * 0.5, wide});
    ways.push_back((line.b - line.a) * (1 / wide));
  }
  std::vector<Flight> out;
  if (treads.size() > kMostTreads) return out;
  std::vector<bool> done(treads.size());
  for (std::size_t k = 0; k < treads.size(); ++k) {
    if (done[k]) continue;
    std::vector<Tread> parallel;
    for (std::size_t other = k; other < treads.size(); ++other)
      if (!done[other] && std::abs(cross(ways[k], ways[other])) <= kSameWay)
        done[other] = true, parallel.push_back(treads[other]);
    add_flights(std::move(parallel), ways[k], out);
  }
  return out;
}

StairsFound find_stairs(const StairStorey& lower, const StairStorey& upper, double rise_m) {
  return StairFinder(lower, upper, rise_m).find();
}

}  // namespace vantage::floor_plan
