// SPDX-License-Identifier: Apache-2.0
#include <dxflib/dl_creationadapter.h>
#include <dxflib/dl_dxf.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>

#include "import/floor_plan/drawing.hpp"
#include "import/floor_plan/labels.hpp"
#include "import/floor_plan/layers.hpp"
#include "import/floor_plan/multilines.hpp"
#include "import/program.hpp"

namespace vantage::floor_plan {
namespace {

using importer::Refused;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::size_t kMostPieces = 2'000'000, kMostSymbols = 200'000;
constexpr int kDeepest = 16;  // blocks in blocks

// Target from source: x and y are where its axes go.
struct Placement {
  Point x{1, 0}, y{0, 1}, origin;

  Point operator()(Point p) const { return origin + x * p.x + y * p.y; }
  Placement operator*(const Placement& inner) const {
    const auto turned = [&](Point p) { return x * p.x + y * p.y; };
    return {turned(inner.x), turned(inner.y), (*this)(inner.origin)};
  }
  // Whether circles stay circles.
  bool keeps_shape() const {
    const double scale = length(x);
    return scale > 0 && std::abs(dot(x, y)) <= 1e-6 * scale * scale && std::abs(length(y) - scale) <= 1e-6 * scale;
  }
  bool mirrors() const { return cross(x, y) < 0; }
};

Point polar(Point centre, double radius, double angle) {
  return {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
}

Arc arc_of(Point centre, double radius, double from, double sweep) {
  return {centre, polar(centre, radius, from), sweep, {}};
}

// A vertex of a polyline: `bulge` is the tangent of a quarter of the angle of the arc that follows.
struct Vertex {
  Point at;
  double bulge = 0;
};

struct Insert {
  std::string block;
  Placement placement;  // without the block's base
  int columns = 1, rows = 1;
  Point column_step, row_step;
};

// Entities of a block or of the model space, in its own coordinates. Their `symbol` is not used.
struct Content {
  Point base;
  std::vector<Line> lines;
  std::vector<Arc> arcs;
  std::vector<Area> areas;
  std::vector<Text> texts;
  std::vector<std::pair<Insert, int>> inserts;  // with their layer
};

class Reader : public DL_CreationAdapter {
 public:
  Drawing drawing;
  std::map<std::string, Content> blocks;
  Content model;
  std::string code_page;

  int layer_of(const std::string& raw) {
    const auto [found, is_new] = layers_.try_emplace(raw, static_cast<int>(drawing.layers.size()));
    if (is_new) drawing.layers.push_back(plain_name(raw, code_page));
    return found->second;
  }
  bool hidden(int layer) const { return hidden_.contains(layer); }

  void setVariableString(const std::string& key, const std::string& value, int) override {
    if (key == "$DWGCODEPAGE") code_page = value;
  }
  void setVariableInt(const std::string& key, int value, int) override {
    if (key == "$INSUNITS") drawing.unit_code = value;
  }
  void addLayer(const DL_LayerData& data) override {
    constexpr int kFrozen = 1;
    if (data.off || (data.flags & kFrozen) != 0 || getAttributes().getColor() < 0) hidden_.insert(layer_of(data.name));
  }

  void addBlock(const DL_BlockData& data) override {
    finish();
    into_ = &blocks[data.name];
    into_->base = {data.bpx, data.bpy};
  }
  void endBlock() override {
    finish();
    into_ = &model;
  }
  void endSection() override { finish(); }
  void endSequence() override { finish(); }

  void addLine(const DL_LineData& data) override {
    finish();
    add_line({data.x1, data.y1}, {data.x2, data.y2});
  }
  void addArc(const DL_ArcData& data) override {
    finish();
    constexpr double kDegree = kTurn / 360;
    double sweep = std::fmod((data.angle2 - data.angle1) * kDegree, kTurn);
    if (sweep <= 0) sweep += kTurn;
    add_arc(arc_of({data.cx, data.cy}, data.radius, data.angle1 * kDegree, sweep));
  }
  void addCircle(const DL_CircleData& data) override {
    finish();
    add_arc(arc_of({data.cx, data.cy}, data.radius, 0, kTurn));
  }
  void addEllipse(const DL_EllipseData& data) override {
    finish();
    const auto points = ellipse({data.cx, data.cy}, {data.mx, data.my}, data.ratio, data.angle1, data.angle2);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) add_line(points[i], points[i + 1]);
  }
  void addPolyline(const DL_PolylineData& data) override {
    finish();
    constexpr int kClosed = 1;
    closed_ = (data.flags & kClosed) != 0;
    polyline_ = shown();
    polyline_from_ = origin();
    polyline_mirrored_ = mirrored();
  }
  void addVertex(const DL_VertexData& data) override { vertices_.push_back({{data.x, data.y}, data.bulge}); }
  void addInsert(const DL_InsertData& data) override {
    finish();
    if (!shown()) return;
    const double angle = data.angle * kTurn / 360;
    const Point along{std::cos(angle), std::sin(angle)}, across{-along.y, along.x};
    Insert insert{.block = data.name,
                  .placement = {along * data.sx, across * data.sy, {data.ipx, data.ipy}},
                  .columns = std::clamp(data.cols, 1, 10'000),
                  .rows = std::clamp(data.rows, 1, 10'000),
                  .column_step = along * data.colSp,
                  .row_step = across * data.rowSp};
    if (mirrored()) {
      insert.placement = kMirror * insert.placement;
      insert.column_step.x = -insert.column_step.x, insert.row_step.x = -insert.row_step.x;
    }
    into_->inserts.emplace_back(std::move(insert), origin().layer);
  }
  void addSolid(const DL_SolidData& data) override { add_quad(data); }
  void addTrace(const DL_TraceData& data) override { add_quad(data); }
  void addHatch(const DL_HatchData&) override {
    finish();
    hatch_ = shown();
    hatch_from_ = origin();
  }
  void addHatchLoop(const DL_HatchLoopData&) override { hatch_loops_.emplace_back(); }
  void addHatchEdge(const DL_HatchEdgeData& data) override {
    if (hatch_loops_.empty()) hatch_loops_.emplace_back();
    add_edge(hatch_loops_.back(), data);
  }
  void endEntity() override {
    if (hatch_) finish();
  }

  void addMTextChunk(const std::string& text) override { chunks_ += text; }
  void addMText(const DL_MTextData& data) override {
    finish();
    const std::string text = plain_text(chunks_ + data.text, code_page);
    chunks_.clear();
    // The attachment point counts from the top left corner, 1, by rows of three.
    const int attachment = std::clamp(data.attachmentPoint, 1, 9) - 1;
    const double wide = data.width > 0 ? std::min(data.width, 0.7 * data.height * static_cast<double>(text.size()))
                                       : 0.7 * data.height * static_cast<double>(text.size());
    add_text({data.ipx, data.ipy}, {0.5 * (1 - attachment % 3) * wide, (attachment / 3 - 1) * data.height}, data.angle,
             data.height, text);
  }
  void addText(const DL_TextData& data) override {
    finish();
    const std::string text = plain_text(data.text, code_page);
    const double wide = 0.7 * data.height * static_cast<double>(text.size());
    const bool aligned = data.hJustification != 0 || data.vJustification != 0;
    const Point at = aligned ? Point{data.apx, data.apy} : Point{data.ipx, data.ipy};
    const double across = data.hJustification == 2 ? -0.5 : data.hJustification == 0 ? 0.5 : 0.0;
    const double upward = data.vJustification == 3 ? -0.5 : data.vJustification == 2 ? 0.0 : 0.5;
    add_text(at, {across * wide, upward * data.height}, data.angle, data.height, text);
  }
  void addAttribute(const DL_AttributeData& data) override { addText(data); }

  void addSpline(const DL_SplineData&) override { finish(), ++drawing.not_read; }
  void add3dFace(const DL_3dFaceData&) override { finish(), ++drawing.not_read; }

  // Puts what comes in parts, a polyline or a hatch, into the content.
  void finish() {
    if (polyline_) {
      const std::size_t edges = vertices_.size() < 2 ? 0 : vertices_.size() - (closed_ ? 0 : 1);
      for (std::size_t i = 0; i < edges; ++i)
        add_edge(vertices_[i], vertices_[(i + 1) % vertices_.size()], polyline_from_, polyline_mirrored_);
    }
    vertices_.clear();
    polyline_ = false;
    if (hatch_) {
      Area area{{}, hatch_from_};
      for (auto& loop : hatch_loops_)
        if (loop.size() >= 3) area.rings.push_back(std::move(loop));
      if (!area.rings.empty()) into_->areas.push_back(std::move(area));
    }
    hatch_ = false;
    hatch_loops_.clear();
  }

 private:
  static constexpr Placement kMirror{{-1, 0}, {0, 1}, {0, 0}};

  bool shown() { return !getAttributes().isInPaperSpace(); }
  Origin origin() { return {layer_of(getAttributes().getLayer()), Kind::other, -1}; }
  // An entity seen from below has its x axis turned.
  bool mirrored() {
    const DL_Extrusion* seen = getExtrusion();
    return seen && seen->getDirection()[2] < -0.5;
  }

  void add_line(Point a, Point b) {
    if (shown()) into_->lines.push_back({a, b, origin()});
  }
  void add_arc(Arc arc) {
    if (!shown()) return;
    arc.from = origin();
    into_->arcs.push_back(mirrored() ? turned(arc) : arc);
  }
  static Arc turned(const Arc& arc) { return {kMirror(arc.centre), kMirror(arc.start), -arc.sweep, arc.from}; }

  void add_edge(const Vertex& a, const Vertex& b, const Origin& from, bool mirrored) {
    const double chord = distance(a.at, b.at);
    if (!(std::abs(a.bulge) > 1e-6) || !(chord > 0)) {
      into_->lines.push_back({mirrored ? kMirror(a.at) : a.at, mirrored ? kMirror(b.at) : b.at, from});
      return;
    }
    const double sweep = 4 * std::atan(a.bulge), height = chord / 2 * (1 - a.bulge * a.bulge) / (2 * a.bulge);
    const Point along = (b.at - a.at) * (1 / chord), middle = (a.at + b.at) * 0.5;
    const Arc arc{middle + Point{-along.y, along.x} * height, a.at, sweep, from};
    into_->arcs.push_back(mirrored ? turned(arc) : arc);
  }

  void add_quad(const DL_TraceData& data) {
    finish();
    if (!shown()) return;
    std::vector<Point> ring;
    for (const int corner : {0, 1, 3, 2}) ring.push_back({data.x[corner], data.y[corner]});  // drawn as a Z
    into_->areas.push_back({{std::move(ring)}, origin()});
  }

  static std::vector<Point> ellipse(Point centre, Point major, double ratio, double from, double to) {
    constexpr int kSteps = 48;
    if (to <= from) to += kTurn;
    std::vector<Point> points;
    const Point minor = Point{-major.y, major.x} * ratio;
    for (int k = 0; k <= kSteps; ++k) {
      const double angle = from + (to - from) * k / kSteps;
      points.push_back(centre + major * std::cos(angle) + minor * std::sin(angle));
    }
    return points;
  }

  static void add_edge(std::vector<Point>& loop, const DL_HatchEdgeData& edge) {
    const double turn = edge.ccw ? 1 : -1;
    switch (edge.type) {
      case 0:
        for (const auto& vertex : edge.vertices)
          if (vertex.size() >= 2) loop.push_back({vertex[0], vertex[1]});
        break;
      case 1:
        loop.push_back({edge.x1, edge.y1});
        loop.push_back({edge.x2, edge.y2});
        break;
      case 2: {
        double sweep = edge.angle2 - edge.angle1;
        if (sweep <= 0) sweep += kTurn;
        for (const Point& p :
             chain(arc_of({edge.cx, edge.cy}, edge.radius, turn * edge.angle1, turn * sweep), edge.radius / 50))
          loop.push_back(p);
        break;
      }
      case 3:
        for (const Point& p :
             ellipse({edge.cx, edge.cy}, {edge.mx, edge.my}, turn * edge.ratio, edge.angle1, edge.angle2))
          loop.push_back(p);
        break;
      default:
        for (const auto& point : edge.controlPoints)
          if (point.size() >= 2) loop.push_back({point[0], point[1]});
    }
  }

  void add_text(Point at, Point to_middle, double degrees, double height, const std::string& text) {
    if (!shown() || text.empty()) return;
    const double angle = degrees * kTurn / 360;
    const Point along{std::cos(angle), std::sin(angle)}, across{-along.y, along.x};
    into_->texts.push_back({at + along * to_middle.x + across * to_middle.y, at, height, text, origin()});
  }

  Content* into_ = &model;
  std::map<std::string, int> layers_;
  std::set<int> hidden_;
  std::vector<Vertex> vertices_;
  bool polyline_ = false, closed_ = false, polyline_mirrored_ = false, hatch_ = false;
  Origin polyline_from_, hatch_from_;
  std::vector<std::vector<Point>> hatch_loops_;
  std::string chunks_;
};

// Places the content of blocks in the drawing.
class Placer {
 public:
  explicit Placer(Reader& reader) : reader_(reader), drawing_(reader.drawing) {}

  // `layer` is that of the block's insert, which entities on layer 0 have too; `outer` the nature of what is around.
  void place(const Content& content, const Placement& placement, int layer, Kind outer, int symbol, int depth) {
    const auto origin = [&](const Origin& own) -> std::optional<Origin> {
      const int on = drawing_.layers[static_cast<std::size_t>(own.layer)] == "0" && layer >= 0 ? layer : own.layer;
      if (reader_.hidden(own.layer) || reader_.hidden(on)) {
        hidden_.insert(on);
        return std::nullopt;
      }
      const Kind kind = drawing_.layer_kinds[static_cast<std::size_t>(on)];
      return Origin{on, kind == Kind::other ? outer : kind, symbol};
    };
    for (const Line& line : content.lines)
      if (const auto from = origin(line.from)) add({placement(line.a), placement(line.b), *from});
    for (const Arc& arc : content.arcs)
      if (const auto from = origin(arc.from)) add(arc, placement, *from);
    for (const Area& area : content.areas)
      if (const auto from = origin(area.from)) {
        Area placed{area.rings, *from};
        for (auto& ring : placed.rings)
          for (Point& p : ring) p = sound(placement(p));
        count(placed.rings.front().size());
        drawing_.areas.push_back(std::move(placed));
      }
    for (const Text& text : content.texts)
      if (const auto from = origin(text.from)) {
        count(1);
        drawing_.texts.push_back({sound(placement(text.at)), sound(placement(text.insertion)),
                                  text.height * length(placement.y), text.text, *from});
      }
    for (const auto& [insert, own_layer] : content.inserts)
      if (const auto from = origin({own_layer, Kind::other, -1})) add(insert, placement, *from, symbol, depth);
  }

  void tell_hidden() {
    for (const int layer : hidden_) drawing_.hidden.push_back(drawing_.layers[static_cast<std::size_t>(layer)]);
  }

 private:
  void count(std::size_t pieces) {
    if ((pieces_ += pieces) > kMostPieces)
      throw Refused("it has more than 2 million lines, with those of its blocks; export the floor plan alone");
  }
  static Point sound(Point p) {
    if (!(std::abs(p.x) < 1e9) || !(std::abs(p.y) < 1e9))
      throw Refused("a coordinate is not finite, or beyond 1e9; the file may be damaged: export the drawing again");
    return p;
  }
  void add(Line line) {
    count(1);
    sound(line.a), sound(line.b);
    if (line.a != line.b) drawing_.lines.push_back(line);
  }
  void add(const Arc& arc, const Placement& placement, const Origin& from) {
    if (!(arc.radius() > 0)) return;
    if (placement.keeps_shape()) {
      count(1);
      drawing_.arcs.push_back({sound(placement(arc.centre)), sound(placement(arc.start)),
                               placement.mirrors() ? -arc.sweep : arc.sweep, from});
      return;
    }
    const auto points = chain(arc, arc.radius() / 100);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) add({placement(points[i]), placement(points[i + 1]), from});
  }
  void add(const Insert& insert, const Placement& outer, const Origin& from, int symbol, int depth) {
    const auto block = reader_.blocks.find(insert.block);
    if (block == reader_.blocks.end()) return;
    if (depth >= kDeepest)
      throw Refused("its blocks are nested deeper than " + std::to_string(kDeepest) + ", or one holds itself (" +
                    plain_name(insert.block, reader_.code_page) + "); explode them");
    const std::string name = plain_name(insert.block, reader_.code_page);
    Kind kind = kind_of(name);
    // A block's name that says wall is of something on a wall, unless its layer says so, too.
    if (kind == Kind::other || kind == Kind::wall) kind = from.kind;
    for (int row = 0; row < insert.rows; ++row)
      for (int column = 0; column < insert.columns; ++column) {
        if (drawing_.symbols.size() >= kMostSymbols)
          throw Refused("it places more than " + std::to_string(kMostSymbols) + " blocks; export the floor plan alone");
        Placement placement = insert.placement;
        placement.origin = placement.origin + insert.column_step * column + insert.row_step * row;
        const Placement from_base{{1, 0}, {0, 1}, block->second.base * -1.0};
        const int index = static_cast<int>(drawing_.symbols.size());
        drawing_.symbols.push_back({name, kind, symbol});
        place(block->second, outer * placement * from_base, from.layer, kind, index, depth + 1);
      }
  }

  Reader& reader_;
  Drawing& drawing_;
  std::set<int> hidden_;
  std::size_t pieces_ = 0;
};

// dxflib reads as far as a file goes; half a plan must not pass for a whole one.
void check_end(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(stream.tellg());
  if (!stream || size < 0) throw Refused("it cannot be read");
  constexpr std::streamoff kTail = 4096;
  std::string tail(static_cast<std::size_t>(std::min(size, kTail)), '\0');
  stream.seekg(size - static_cast<std::streamoff>(tail.size()));
  stream.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  if (tail.find("EOF") == std::string::npos)
    throw Refused("the file is truncated: its end (EOF) is missing; copy or export it again");
}

}  // namespace

Point Arc::at(double share) const {
  const Point arm = start - centre;
  const double c = std::cos(sweep * share), s = std::sin(sweep * share);
  return centre + Point{c * arm.x - s * arm.y, s * arm.x + c * arm.y};
}

std::vector<Point> chain(const Arc& arc, double error) {
  constexpr double kMostSteps = 90;
  const double step = 2 * std::acos(std::clamp(1 - error / arc.radius(), 0.0, 1.0));
  const double wanted = step > 0 ? std::ceil(std::abs(arc.sweep) / step) : kMostSteps;
  const int steps = static_cast<int>(std::clamp(wanted, 2.0, kMostSteps));
  std::vector<Point> points;
  for (int k = 0; k <= steps; ++k) points.push_back(arc.at(static_cast<double>(k) / steps));
  return points;
}

Drawing read_drawing(const std::filesystem::path& file, const std::vector<std::string>& wall_layers) {
  check_end(file);
  Reader reader;
  DL_Dxf dxf;
  if (!dxf.in(file.string(), &reader)) throw Refused("it cannot be read");
  reader.finish();
  read_multilines(file, [&](const std::string& layer, Point a, Point b) {
    reader.model.lines.push_back({a, b, {reader.layer_of(layer), Kind::other, -1}});
  });
  Drawing& drawing = reader.drawing;
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
  Placer placer(reader);
  placer.place(reader.model, {}, -1, Kind::other, -1, 0);
  placer.tell_hidden();
  return std::move(drawing);
}

}  // namespace vantage::floor_plan
