// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "import/floor_plan/content.hpp"
#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/labels.hpp"
#include "import/floor_plan/layers.hpp"
#include "import/program.hpp"

namespace vantage::floor_plan {
namespace {

using importer::Refused;

constexpr std::size_t kMostPieces = 2'000'000, kMostSymbols = 200'000;
constexpr int kDeepest = 16;  // nesting of blocks

using Blocks = std::map<std::string, Content>;

// Places the content of blocks in the drawing.
class Placer {
 public:
  Placer(const Layers& layers, const Blocks& blocks, Drawing& drawing)
      : layers_(layers), blocks_(blocks), drawing_(drawing) {}

  // `layer`: the layer of the block's insert, which entities on layer 0 take; -1 if there is none. `outer`: the kind of
  // the enclosing block.
  void place(const Content& content, const Placement& placement, int layer, Kind outer, int symbol, int depth) {
    const auto on = [&](int own) {
      return drawing_.layers[static_cast<std::size_t>(own)] == "0" && layer >= 0 ? layer : own;
    };
    const auto origin = [&](const Origin& own) -> std::optional<Origin> {
      if (layers_.state(on(own.layer)) != Layers::shown) return std::nullopt;
      const Kind kind = drawing_.layer_kinds[static_cast<std::size_t>(on(own.layer))];
      return Origin{on(own.layer), kind == Kind::other ? outer : kind, symbol};
    };
    for (const auto& [key, times] : content.entities) {
      const auto& [fate, own, type] = key;
      const auto from = origin({own});
      tally(fate == Fate::drawn && !from ? Fate::hidden_layer : fate, from.value_or(Origin{on(own), outer, symbol}),
            type, times);
    }
    for (const Line& line : content.lines)
      if (const auto from = origin(line.from))
        add({placement(line.a), placement(line.b), *from,
             line.width * std::sqrt(std::abs(cross(placement.x, placement.y)))});
    for (const Arc& arc : content.arcs)
      if (const auto from = origin(arc.from)) add(arc, placement, *from);
    for (const Curve& curve : content.curves)
      if (const auto from = origin(curve.from)) add({placed(curve.points, placement), *from});
    for (const Area& area : content.areas)
      if (const auto from = origin(area.from)) {
        Area whole{{}, *from};
        for (const auto& ring : area.rings) whole.rings.push_back(placed(ring, placement));
        drawing_.areas.push_back(std::move(whole));
      }
    for (const Text& text : content.texts)
      if (const auto from = origin(text.from)) {
        count(1);
        drawing_.texts.push_back({sound(placement(text.at)), sound(placement(text.insertion)),
                                  text.height * length(placement.y), text.text, *from});
      }
    for (const Insert& insert : content.inserts) add(insert, placement, on(insert.layer), outer, symbol, depth);
  }

 private:
  void tally(Fate fate, const Origin& from, const std::string& type, std::size_t times) {
    drawing_.entities[{fate, from.layer, from.kind, from.symbol >= 0, type}] += times;
  }
  void count(std::size_t pieces) {
    if ((pieces_ += pieces) > kMostPieces)
      throw Refused("it has more than 2 million lines, with those of its blocks; export the floor plan alone");
  }
  static Point sound(Point p) {
    constexpr double kFarthest = 1e12;  // up to here, doubles resolve fractions of a millimetre
    if (!(std::abs(p.x) < kFarthest) || !(std::abs(p.y) < kFarthest))
      throw Refused("a coordinate is not finite, or beyond 1e12; the file may be damaged: export the drawing again");
    return p;
  }
  std::vector<Point> placed(std::vector<Point> points, const Placement& placement) {
    count(points.size());
    for (Point& p : points) p = sound(placement(p));
    return points;
  }
  void add(const Line& line) {
    count(1);
    sound(line.a), sound(line.b);
    if (line.a != line.b) drawing_.lines.push_back(line);
  }
  void add(const Arc& arc, const Placement& placement, const Origin& from) {
    count(1);
    const Point arm = arc.start - arc.centre;
    const Placement circle = placement * Placement{arm, {-arm.y, arm.x}, arc.centre};
    for (const Point& p : {circle.origin, circle({1, 0}), circle({0, 1})}) sound(p);
    add_arc(circle, 0, arc.sweep, from, drawing_.arcs, drawing_.curves);
  }
  void add(Curve curve) { drawing_.curves.push_back(std::move(curve)); }
  void add(const Insert& insert, const Placement& outer, int layer, Kind around, int symbol, int depth) {
    const auto block = blocks_.find(insert.block);
    const Kind own = drawing_.layer_kinds[static_cast<std::size_t>(layer)];
    const Origin from{layer, own == Kind::other ? around : own, symbol};
    if (layers_.state(layer) == Layers::frozen || layers_.state(insert.layer) == Layers::frozen)
      return tally(Fate::hidden_layer, from, "INSERT", 1);
    if (block == blocks_.end() || block->second.external)
      return tally(Fate::missing_block, from, block == blocks_.end() ? "INSERT of " + insert.block : block->second.name,
                   1);
    const Content& content = block->second;
    if (depth >= kDeepest)
      throw Refused("its blocks are nested deeper than " + std::to_string(kDeepest) + ", or one holds itself (" +
                    content.name + "); explode them");
    Kind kind = kind_of(content.name);
    // A block named after a wall is something on a wall, unless its layer is one of walls, too.
    if (kind == Kind::other || kind == Kind::wall) kind = from.kind;
    for (int row = 0; row < insert.rows; ++row)
      for (int column = 0; column < insert.columns; ++column) {
        if (drawing_.symbols.size() >= kMostSymbols)
          throw Refused("it places more than " + std::to_string(kMostSymbols) + " blocks; export the floor plan alone");
        Placement placement = insert.placement;
        placement.origin = placement.origin + insert.column_step * column + insert.row_step * row;
        const Placement from_base{{1, 0}, {0, 1}, content.base * -1.0};
        const int index = static_cast<int>(drawing_.symbols.size());
        drawing_.symbols.push_back({content.name, kind, symbol});
        place(content, outer * placement * from_base, layer, kind, index, depth + 1);
      }
  }

  const Layers& layers_;
  const Blocks& blocks_;
  Drawing& drawing_;
  std::size_t pieces_ = 0;
};

class Reader {
 public:
  explicit Reader(Drawing& drawing) : layers(drawing), drawing_(drawing) {}

  Layers layers;
  Blocks blocks;
  Content model;

  void read(const std::filesystem::path& file) {
    read_dxf(file, {.header = [&](const auto& variables) { read_header(variables); },
                    .layer = [&](const Entity& layer) { add_layer(layer); },
                    .begin_block = [&](const Entity& block) { begin_block(block); },
                    .entity =
                        [&](const Entity& entity, const std::vector<Entity>& parts, bool in_block) {
                          constexpr int kThickness = 39;
                          if (const double height = std::abs(entity.number(kThickness)); height > 0)
                            ++drawing_.thicknesses[height];
                          add_entity(entity, parts, layers, in_block ? *block_ : model);
                        }});
  }

 private:
  void read_header(const std::map<std::string_view, Group>& variables) {
    const auto value = [&](std::string_view name) {
      const auto found = variables.find(name);
      return found == variables.end() ? Group{} : found->second;
    };
    layers.code_page = value("$DWGCODEPAGE").value;
    drawing_.unit_code = integer(value("$INSUNITS"));
    const int shown = integer(value("$LUNITS"));
    drawing_.in_inches = shown == 3 || shown == 4;
  }
  void add_layer(const Entity& layer) {
    constexpr int kFrozen = 1;
    const bool frozen = (layer.integer(70) & kFrozen) != 0;
    layers.set(layers.index(layer.text(2)),
               frozen                     ? Layers::frozen
               : layer.integer(62, 7) < 0 ? Layers::off
                                          : Layers::shown,
               layer.integer(290, 1) != 0);
  }
  void begin_block(const Entity& block) {
    constexpr int kExternal = 4 | 8;
    block_ = &blocks[layers.block_key(block.text(2))];
    block_->name = plain_name(std::string(block.text(2)), layers.code_page);
    block_->base = {block.number(10), block.number(20)};
    block_->external = (block.integer(70) & kExternal) != 0;
  }

  Drawing& drawing_;
  Content* block_ = nullptr;  // the current block
};

}  // namespace

Drawing read_drawing(const std::filesystem::path& file, const std::vector<std::string>& wall_layers) {
  Drawing drawing;
  Reader reader(drawing);
  reader.read(file);
  for (const std::string& name : drawing.layers) {
    Kind kind = kind_of(name);
    if (!wall_layers.empty()) {
      const bool wall = std::ranges::any_of(wall_layers, [&](const auto& pattern) { return matches(name, pattern); });
      kind = wall ? Kind::wall : kind == Kind::wall ? Kind::other : kind;
    }
    drawing.layer_kinds.push_back(kind);
  }
  for (const std::string& pattern : wall_layers)
    if (std::ranges::none_of(drawing.layers, [&](const std::string& name) { return matches(name, pattern); })) {
      std::string names;
      for (std::size_t i = 0; i < drawing.layers.size() && i < 12; ++i)
        names += (names.empty() ? "" : ", ") + drawing.layers[i];
      throw Refused("no layer matches the setting wall-layer \"" + pattern + "\"; it has " + names +
                    (drawing.layers.size() > 12 ? ", …" : ""));
    }
  Placer(reader.layers, reader.blocks, drawing).place(reader.model, {}, -1, Kind::other, -1, 0);
  return drawing;
}

}  // namespace vantage::floor_plan
