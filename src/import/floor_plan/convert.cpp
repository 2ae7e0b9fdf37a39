// SPDX-License-Identifier: Apache-2.0
#include "import/floor_plan/convert.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/text.hpp"
#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/join_ends.hpp"
#include "import/floor_plan/layers.hpp"
#include "import/floor_plan/solids.hpp"
#include "import/floor_plan/stairs.hpp"
#include "import/floor_plan/swings.hpp"
#include "import/floor_plan/unit.hpp"
#include "import/floor_plan/walls.hpp"
#include "import/glb_bytes.hpp"
#include "import/program.hpp"

namespace vantage::floor_plan {
namespace {

using importer::Refused;
using nlohmann::json;

// Scales to metres about a middle in whole metres, since floats hold no map coordinates. Curves become lines.
Point scale_to_metres(Drawing& drawing, double metres) {
  const auto each = [&](const auto& visit) {
    for (Line& line : drawing.lines) visit(line.a), visit(line.b);
    for (Arc& arc : drawing.arcs) visit(arc.centre), visit(arc.start);
    for (Curve& curve : drawing.curves)
      for (Point& p : curve.points) visit(p);
    for (Area& area : drawing.areas)
      for (auto& ring : area.rings)
        for (Point& p : ring) visit(p);
    for (Text& text : drawing.texts) visit(text.at), visit(text.insertion);
  };
  std::vector<double> xs, ys;
  each([&](Point& p) {
    p = p * metres;
    xs.push_back(p.x), ys.push_back(p.y);
  });
  const auto median = [](std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
  };
  for (Text& text : drawing.texts) text.height *= metres;
  for (Line& line : drawing.lines) line.width *= metres;
  const Point origin{std::floor(median(xs)), std::floor(median(ys))};
  each([&](Point& p) { p = p - origin; });
  for (const Curve& curve : drawing.curves) {
    const auto points = simplified(curve.points, kCurve_m);
    for (std::size_t k = 0; k + 1 < points.size(); ++k) drawing.lines.push_back({points[k], points[k + 1], curve.from});
  }
  drawing.curves.clear();
  for (Area& area : drawing.areas)
    for (auto& ring : area.rings) ring = simplified(ring, kCurve_m / 10);
  return origin;
}

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;
  std::string out;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) out += (i == 0 ? "" : ", ") + names[i];
  return names.size() > kMost ? out + ", …" : out;
}

// Notes by layer and type what the drawing holds and the site lacks, so that nothing is lost in silence.
void add_left_out(std::vector<std::string>& notes, const Drawing& drawing, const Walls& walls,
                  const std::vector<Swing>& swings) {
  const auto add = [&](const std::string& what, const auto& wanted) {
    std::map<std::string, std::map<std::string, std::size_t>> layers;
    for (const auto& [key, times] : drawing.entities)
      if (wanted(key)) layers[drawing.layers[static_cast<std::size_t>(key.layer)]][key.type] += times;
    constexpr std::size_t kMost = 40;
    std::string text;
    std::size_t shown = 0, rest = 0;
    for (const auto& [layer, types] : layers) {
      std::string own;
      for (const auto& [type, times] : types) {
        own += (own.empty() ? "" : ", ") + std::to_string(times) + " " + type;
        rest += shown >= kMost ? times : 0;
      }
      if (shown++ < kMost) text += (text.empty() ? "" : "; ") + layer + ": " + own;
    }
    if (rest > 0) text += "; and " + std::to_string(rest) + " on " + counted(shown - kMost, "layer");
    if (!text.empty()) notes.push_back(what + " (" + text + ")");
  };
  const auto of = [](Fate fate) { return [fate](const EntityKey& key) { return key.fate == fate; }; };
  add("not read", of(Fate::not_read));
  add("invisible, left out", of(Fate::invisible));
  add("on layers that are off or frozen, left out", of(Fate::hidden_layer));
  add("blocks and external references that the file does not hold", of(Fate::missing_block));
  add("on sheets (paper space), left out", of(Fate::paper_space));
  std::set<int> of_walls, of_swings;
  for (std::size_t l = 0; l < drawing.layers.size(); ++l)
    if (std::ranges::find(walls.layers, drawing.layers[l]) != walls.layers.end()) of_walls.insert(static_cast<int>(l));
  for (const Swing& swing : swings) of_swings.insert(swing.layer);
  const auto is_text = [](const EntityKey& key) {
    return key.type == "TEXT" || key.type == "MTEXT" || key.type == "ATTDEF";
  };
  add("no part of walls, doors, windows, furniture or stairs", [&](const EntityKey& key) {
    if (key.fate != Fate::drawn || is_text(key)) return false;
    if (key.type == "ARC" && of_swings.contains(key.layer)) return false;
    return key.kind == Kind::annotation || (key.kind == Kind::furniture && !key.in_symbol) ||
           (key.kind == Kind::other && !of_walls.contains(key.layer)) || (key.kind == Kind::wall && !walls.by_name);
  });
  add("layers that are not plotted, read as the screen shows them", [&](const EntityKey& key) {
    return key.fate == Fate::drawn && !drawing.plotted[static_cast<std::size_t>(key.layer)] && !is_text(key) &&
           key.kind != Kind::annotation && (key.kind != Kind::other || of_walls.contains(key.layer));
  });
}

std::vector<std::string> notes_of(const Plan& plan, const Drawing& drawing, const Walls& walls,
                                  const std::vector<Swing>& swings, const Scale& scale) {
  std::array<std::size_t, 3> kinds{};
  for (const Opening& opening : plan.openings) ++kinds[opening.kind];
  const std::size_t named = static_cast<std::size_t>(std::ranges::count_if(
      plan.rooms.rooms, [](const Room& room) { return !room.name.empty() || !room.number.empty(); }));
  std::vector<std::string> notes{"floor plan: " + scale.note + "; walls of layer " + listed(walls.layers) +
                                     (walls.by_name ? "" : ", whose lines enclose rooms (setting wall-layer)") + ", " +
                                     fixed(plan.wall_height_m, 2) + " m high",
                                 counted(plan.rooms.rooms.size(), "room") + ", " + std::to_string(named) +
                                     " with a name; " + counted(kinds[Opening::door], "door") + " and " +
                                     counted(kinds[Opening::passage], "passage") + " open up to " +
                                     fixed(kDoorHeight_m, 1) + " m, " + counted(kinds[Opening::window], "window") +
                                     " from " + fixed(kSill_m, 1) + " m; " + counted(plan.furniture.size(), "piece") +
                                     " of furniture, boxes of " + fixed(kTable_m, 2) + " m"};
  if (walls.filled_gaps > 0)
    notes.push_back(counted(walls.filled_gaps, "gap") + " of up to " + fixed(100 * walls.widest_gap_m, 1) +
                    " cm between walls filled (" + fixed(100 * kTolerance_m, 0) + " cm at most)");
  if (walls.joined_ends > 0)
    notes.push_back(counted(walls.joined_ends, "end") + " of wall lines joined to what they missed by up to " +
                    fixed(100 * walls.farthest_join_m, 1) + " cm (" + fixed(100 * kTolerance_m, 0) + " cm at most)");
  if (plan.rooms.open)
    notes.push_back("the walls enclose little; the ground is all that lies between them, without a ceiling");
  else if (plan.rooms.closed_m > 0)
    notes.push_back("the outer walls do not close; gaps of up to " + fixed(plan.rooms.closed_m, 1) +
                    " m are closed to find the rooms");
  if (!drawing.thicknesses.empty()) {
    std::size_t all = 0;
    for (const auto& [height, times] : drawing.thicknesses) all += times;
    const auto most = std::ranges::max_element(drawing.thicknesses, {}, [](const auto& pair) { return pair.second; });
    notes.push_back(counted(all, "line") + " with a thickness, mostly of " + fixed(most->first * scale.metres, 2) +
                    " m, raised like the others (setting wall-height)");
  }
  add_left_out(notes, drawing, walls, swings);
  return notes;
}

// A floor plan has doors or names of rooms. Without both, a title may show that the drawing is another view; then
// nothing is raised unless the user names the layer of walls.
void check_view(const Drawing& drawing, const Plan& plan, bool doors, bool asked, std::vector<std::string>& notes) {
  const bool named = std::ranges::any_of(plan.rooms.rooms, [](const Room& room) { return !room.name.empty(); });
  if (doors || (named && asked)) return;
  const auto title =
      std::ranges::find_if(drawing.texts, [](const Text& text) { return names_another_view(text.text); });
  if (title != drawing.texts.end() && !asked)
    throw Refused("it seems to be no floor plan: it has no door with a swing, and a text says \"" + title->text +
                  "\"; give a floor plan, or name its layer of walls with the setting wall-layer");
  if (!named)
    notes.emplace_back(
        "no door with a swing and no name of a room was found: is this an elevation, a section or a roof "
        "in place of a floor plan?");
}

// Returns the triangles of a node, Y up, without duplicate points.
json primitive_of(const Mesh& mesh, importer::Buffer& buffer) {
  std::map<std::array<float, 3>, std::uint32_t> known;
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
  for (const auto& [x, y, z] : mesh.points) {
    const std::array<float, 3> p{static_cast<float>(x), static_cast<float>(z), static_cast<float>(-y)};
    const auto [found, is_new] = known.try_emplace(p, static_cast<std::uint32_t>(known.size()));
    if (is_new) positions.insert(positions.end(), p.begin(), p.end());
    indices.push_back(found->second);
  }
  json primitive{{"attributes", {{"POSITION", buffer.add_positions(positions)}}}};
  primitive["indices"] = buffer.add_indices(indices);
  return primitive;
}

// A drawing, raised to a storey.
struct Storey {
  Plan plan;
  std::vector<Flight> flights;  // of stairs
  std::vector<Text> texts;
  Point origin;        // of its points, in metres of the drawing
  double floor_m = 0;  // above the lowest one
  std::string name;    // the file's name without its ending
  std::vector<std::string> notes;
};

json room_node(const Rooms& rooms, std::size_t r, Point origin, double low_m, double high_m) {
  const Room& room = rooms.rooms[r];
  const Bounds box = bounds(room.area);
  const Point low = box.low + origin, high = box.high + origin;
  json vantage{{"class", "room"}, {"box", {{low.x, low_m, -high.y}, {high.x, high_m, -low.y}}}};
  if (!room.number.empty()) vantage["name"] = room.number;
  if (!room.name.empty()) vantage[room.number.empty() ? "name" : "long_name"] = room.name;
  vantage["footprint"] = json::array();
  for (const auto& ring : rings(room.area)) {
    json loop = json::array();
    for (const Point& p : ring) loop.push_back({p.x + origin.x, -p.y - origin.y});
    vantage["footprint"].push_back(loop);
  }
  return {{"name", room_name(rooms, r)}, {"extras", {{"vantage", vantage}}}};
}

std::string glb_of(const std::vector<Storey>& storeys) {
  importer::Buffer buffer;
  json nodes = json::array(), meshes = json::array(), roots = json::array(), notes = json::array();
  for (std::size_t k = 0; k < storeys.size(); ++k) {
    const auto& [plan, flights, texts, origin, floor_m, name, told] = storeys[k];
    json children = json::array();
    for (const Mesh& mesh : meshes_of(plan)) {
      meshes.push_back({{"primitives", {primitive_of(mesh, buffer)}}});
      children.push_back(nodes.size());
      nodes.push_back({{"name", mesh.name},
                       {"mesh", meshes.size() - 1},
                       {"extras", {{"vantage", {{"role", mesh.surveyed ? "surveyed" : "blocking"}}}}}});
    }
    for (std::size_t r = 0; r < plan.rooms.rooms.size(); ++r) {
      if (plan.rooms.rooms[r].name.empty() && plan.rooms.rooms[r].number.empty()) continue;
      children.push_back(nodes.size());
      nodes.push_back(room_node(plan.rooms, r, origin, floor_m, floor_m + plan.wall_height_m));
    }
    roots.push_back(nodes.size());
    nodes.push_back({{"name", "floor plan"}, {"translation", {origin.x, floor_m, -origin.y}}, {"children", children}});
    if (storeys.size() > 1) {
      nodes.back()["name"] = name;
      nodes.back()["extras"]["vantage"] = {{"class", "IfcBuildingStorey"}, {"name", name}};
    }
    for (const std::string& note : told) notes.push_back(note);
  }
  return buffer.finish({{"asset",
                         {{"version", "2.0"},
                          {"generator", "vantage-import-plan"},
                          {"extras", {{"vantage", {{"unit", "m"}, {"up", "y"}}}, {"notes", notes}}}}},
                        {"scene", 0},
                        {"scenes", {{{"nodes", roots}}}},
                        {"nodes", nodes},
                        {"meshes", meshes}});
}

}  // namespace

void read_setting(Settings& settings, const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals), value = equals == std::string::npos ? "" : text.substr(equals + 1);
  if (name == "unit") {
    settings.unit = value;
  } else if (name == "wall-layer") {
    settings.wall_layers.push_back(value);
  } else if (name == "wall-height") {
    const auto [end, failure] = std::from_chars(value.data(), value.data() + value.size(), settings.wall_height_m);
    if (failure != std::errc() || end != value.data() + value.size() || !(settings.wall_height_m > 0))
      throw Refused("the wall height \"" + value + "\" is not a number above 0");
  } else {
    throw Refused("there is no setting \"" + name + "\"");
  }
}

namespace {

Storey storey_of(const std::filesystem::path& file, const Settings& settings) {
  Drawing drawing = read_drawing(file, settings.wall_layers);
  if (drawing.lines.empty() && drawing.arcs.empty() && drawing.curves.empty() && drawing.areas.empty())
    throw Refused("it holds no lines in its model space; export the floor plan with its lines");
  const Scale scale = scale_of(drawing, settings.unit);
  const Point origin = scale_to_metres(drawing, scale.metres);
  const std::vector<Swing> swings = take_swings(drawing);
  Walls walls = find_walls(drawing);
  doubt_unit(scale, walls.faces);
  constexpr double kSmallest_m = 1, kLargest_m = 3000;
  const Bounds box = bounds(walls.solid);
  const double wide = std::max(box.high.x - box.low.x, box.high.y - box.low.y);
  if (!(wide >= kSmallest_m && wide <= kLargest_m))
    throw Refused("its walls would be " + fixed(wide, wide < 1 ? 3 : 0) + " m wide (" + scale.note +
                  "); give the setting unit, or wall-layer if something far away is on their layer");
  Plan plan;
  plan.wall_height_m = settings.wall_height_m;
  plan.openings = find_openings(walls.solid, drawing, swings);
  plan.rooms = find_rooms(walls.solid, plan.openings, drawing.texts);
  plan.solid = clone(walls.solid);
  std::vector<Shape> open;
  for (const Opening& opening : plan.openings) open.push_back(clone(opening.area));
  if (!open.empty()) plan.solid = areas(without(walls.solid, united(std::move(open))));
  plan.furniture = find_furniture(drawing, plan.rooms);
  std::vector<std::string> notes = notes_of(plan, drawing, walls, swings, scale);
  check_view(drawing, plan, !swings.empty(), !settings.wall_layers.empty(), notes);
  std::vector<Flight> flights = find_flights(drawing);
  return {std::move(plan),      std::move(flights), std::move(drawing.texts), origin, 0,
          file.stem().string(), std::move(notes)};
}

constexpr double kSlab_m = 0.3;  // between a ceiling and the floor above it

std::string place_text(Point p) { return fixed(p.x, 2) + "," + fixed(p.y, 2); }

Shape hole_of(const std::vector<Stair>& stairs, Point origin) {
  std::vector<Shape> parts;
  for (const Stair& stair : stairs)
    for (auto corners : stair.hole) {
      for (Point& corner : corners) corner = corner - origin;
      parts.push_back(polygon(corners));
    }
  return areas(united(std::move(parts)));
}

// Links a storey with the one above it.
void add_stairs(Storey& lower, Storey& upper) {
  const auto storey_of = [](const Storey& s) {
    return StairStorey{&s.plan.rooms, &s.plan.openings, &s.flights, &s.texts, s.origin};
  };
  const StairsFound found = find_stairs(storey_of(lower), storey_of(upper), upper.floor_m - lower.floor_m);
  for (const Stair& stair : found.stairs) {
    for (Step step : stair.steps) {
      for (Point& corner : step.corners) corner = corner - lower.origin;
      lower.plan.steps.push_back(step);
    }
    lower.notes.push_back("stairs from " + place_text(stair.foot) + " to the storey above, in risers of " +
                          fixed(100 * stair.riser_m, 1) + " cm" +
                          (stair.assumed ? "; which end is the lower one is assumed" : ""));
  }
  if (!found.stairs.empty()) {
    lower.plan.hole_above = hole_of(found.stairs, lower.origin);
    lower.plan.slab_m = upper.floor_m - lower.floor_m - lower.plan.wall_height_m;
    upper.plan.hole_below = hole_of(found.stairs, upper.origin);
  }
  for (const auto& [place, why] : found.left_out)
    lower.notes.push_back("stairs at " + place_text(place) + " are not made: " + why +
                          (found.stairs.empty() ? "; enter the storey above with the setting enter" : ""));
}

}  // namespace

std::string convert(const std::vector<std::filesystem::path>& files, const Settings& settings) {
  std::vector<Storey> storeys;
  for (const std::filesystem::path& file : files) {
    const std::string name = file.filename().string();
    try {
      storeys.push_back(storey_of(file, settings));
    } catch (const Refused& why) {
      throw files.size() == 1 ? why : Refused(name + ": " + why.what());
    }
    Storey& storey = storeys.back();
    if (files.size() == 1) {
      if (!storey.flights.empty())
        storey.notes.push_back(
            counted(storey.flights.size(), "flight") +
            " of stairs left out: they are made between storeys, from a folder with a drawing of each");
      break;
    }
    storey.floor_m = static_cast<double>(storeys.size() - 1) * (settings.wall_height_m + kSlab_m);
  }
  for (std::size_t k = 0; k + 1 < storeys.size(); ++k) add_stairs(storeys[k], storeys[k + 1]);
  for (std::size_t k = 0; storeys.size() > 1 && k < storeys.size(); ++k)
    for (std::string& note : storeys[k].notes)
      note = files[k].filename().string() + ", " + fixed(storeys[k].floor_m, 2) + " m up: " + note;
  return glb_of(storeys);
}

}  // namespace vantage::floor_plan
