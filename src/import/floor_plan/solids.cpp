// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/solids.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "import/floor_plan/grid.hpp"

namespace vantage::floor_plan {
namespace {

class Builder {
 public:
  explicit Builder(const Plan& plan) : plan_(plan), solid_(clone(plan.solid)) {
    for (const Room& room : plan.rooms.rooms) {
      const Bounds box = bounds(room.area);
      room_grid_.add(rooms_.size(), box.low, box.high);
      rooms_.emplace_back(clone(room.area));
    }
    for (const Opening& opening : plan.openings) {
      const Bounds box = bounds(opening.area);
      opening_grid_.add(openings_.size(), box.low, box.high);
      openings_.emplace_back(clone(opening.area));
    }
  }

  std::vector<Mesh> build() {
    const double top = plan_.wall_height_m;
    sides(plan_.solid, 0, top);
    flat("outside", plan_.solid, top, true).surveyed = false;
    for (std::size_t o = 0; o < plan_.openings.size(); ++o) opening(plan_.openings[o]);
    for (std::size_t r = 0; r < rooms_.size(); ++r) {
      const Shape& room = plan_.rooms.rooms[r].area;
      flat("floor " + room_name(plan_.rooms, r), plan_.hole_below ? without(room, plan_.hole_below) : clone(room), 0,
           true);
      if (!plan_.rooms.open)
        flat("ceiling " + room_name(plan_.rooms, r), plan_.hole_above ? without(room, plan_.hole_above) : clone(room),
             top, false);
    }
    for (const Step& step : plan_.steps) add_step(step);
    if (plan_.hole_above)
      for (const auto& ring : rings(plan_.hole_above))
        for (std::size_t i = 0; i < ring.size(); ++i)
          upright(mesh("stairs"), ring[(i + 1) % ring.size()], ring[i], top, top + plan_.slab_m);
    for (const Furniture& piece : plan_.furniture) {
      const std::string name = "furniture " + piece.name;
      for (const auto& ring : rings(piece.area))
        for (std::size_t i = 0; i < ring.size(); ++i)
          upright(mesh(name), ring[i], ring[(i + 1) % ring.size()], 0, kTable_m);
      flat(name, piece.area, kTable_m, true);
      mesh(name).surveyed = false;  // its shape is assumed
    }
    std::vector<Mesh> out;
    for (auto& [name, made] : meshes_)
      if (!made.points.empty()) out.push_back(std::move(made));
    return out;
  }

 private:
  Mesh& mesh(const std::string& name) {
    Mesh& made = meshes_[name];
    made.name = name;
    return made;
  }

  static void triangle(Mesh& into, std::array<double, 3> a, std::array<double, 3> b, std::array<double, 3> c) {
    into.points.insert(into.points.end(), {a, b, c});
  }
  // Adds an upright face. Seen from a towards b, its back is to the left.
  static void upright(Mesh& into, Point a, Point b, double low, double high) {
    triangle(into, {a.x, a.y, low}, {b.x, b.y, low}, {b.x, b.y, high});
    triangle(into, {a.x, a.y, low}, {b.x, b.y, high}, {a.x, a.y, high});
  }
  Mesh& flat(const std::string& name, const Shape& shape, double z, bool upward) {
    Mesh& into = mesh(name);
    for (const auto& [a, b, c] : triangles(shape)) {
      if (upward)
        triangle(into, {a.x, a.y, z}, {b.x, b.y, z}, {c.x, c.y, z});
      else
        triangle(into, {a.x, a.y, z}, {c.x, c.y, z}, {b.x, b.y, z});
    }
    return into;
  }

  // Adds all faces of a step but the back, which the next step covers.
  void add_step(const Step& step) {
    Mesh& into = mesh("stairs");
    const auto& [a, b, c, d] = step.corners;
    const auto quad = [&](const std::array<Point, 4>& p, double z) {
      triangle(into, {p[0].x, p[0].y, z}, {p[1].x, p[1].y, z}, {p[2].x, p[2].y, z});
      triangle(into, {p[0].x, p[0].y, z}, {p[2].x, p[2].y, z}, {p[3].x, p[3].y, z});
    };
    quad({a, b, c, d}, step.high_m);
    if (step.low_m > 0) quad({a, d, c, b}, step.low_m);
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(d, a)})
      upright(into, from, to, step.low_m, step.high_m);
  }

  std::optional<std::size_t> at(const Grid& grid, const std::vector<Region>& regions, Point p) const {
    std::optional<std::size_t> out;
    grid.visit(p, p, [&](std::size_t i) {
      if (!out && regions[i].holds(p)) out = i;
    });
    return out;
  }

  // Returns a point just in front of an edge's middle.
  static Point before(Point a, Point b) {
    constexpr double kOff = 0.005;
    const Point along = (b - a) * (1 / distance(a, b));
    return (a + b) * 0.5 + Point{along.y, -along.x} * kOff;
  }

  void sides(const Shape& shape, double low, double high) {
    for (const auto& ring : rings(shape))
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point a = ring[i], b = ring[(i + 1) % ring.size()], front = before(a, b);
        const auto opening = at(opening_grid_, openings_, front);
        if (opening) {  // a reveal; wall lies above and below
          const bool window = plan_.openings[*opening].kind == Opening::window;
          upright(mesh("wall openings"), a, b, window ? kSill_m : low, std::min(high, kDoorHeight_m));
          continue;
        }
        facing(front, a, b, low, high);
      }
  }

  // Adds a side of a wall to the room in front of it.
  void facing(Point front, Point a, Point b, double low, double high) {
    const auto room = at(room_grid_, rooms_, front);
    Mesh& into = mesh(room ? "wall " + room_name(plan_.rooms, *room) : "outside");
    into.surveyed = room.has_value();
    upright(into, a, b, low, high);
  }

  void opening(const Opening& opening) {
    const double top = plan_.wall_height_m;
    const auto part = [&](double low, double high) {
      for (const auto& ring : rings(opening.area))
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const Point a = ring[i], b = ring[(i + 1) % ring.size()], front = before(a, b);
          if (!solid_.holds(front) && !at(opening_grid_, openings_, front)) facing(front, a, b, low, high);
        }
    };
    if (top > kDoorHeight_m) {
      part(kDoorHeight_m, top);
      flat("wall openings", opening.area, kDoorHeight_m, false);
      flat("outside", opening.area, top, true);
    } else {
      flat("ceiling openings", opening.area, top, false);
    }
    if (opening.kind == Opening::window) {
      part(0, std::min(kSill_m, top));
      flat("wall openings", opening.area, std::min(kSill_m, top), true);
    } else {
      flat("floor openings", opening.area, 0, true);
    }
  }

  const Plan& plan_;
  Region solid_;
  std::vector<Region> rooms_, openings_;
  Grid room_grid_{4.0}, opening_grid_{2.0};
  std::map<std::string, Mesh> meshes_;
};

}  // namespace

std::string room_name(const Rooms& rooms, std::size_t room) {
  const Room& of = rooms.rooms[room];
  if (!of.name.empty() && !of.number.empty()) return of.number + " " + of.name;
  if (!of.name.empty() || !of.number.empty()) return of.name + of.number;
  return "room " + std::to_string(room + 1);
}

std::vector<Mesh> meshes_of(const Plan& plan) { return Builder(plan).build(); }

}  // namespace vantage::floor_plan
