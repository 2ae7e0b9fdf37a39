// SPDX-License-Identifier: Apache-2.0
// Writes small drawings as DXF texts.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace vantage::test {

class DrawingText {
 public:
  using Points = std::vector<std::pair<double, double>>;
  // A vertex of a polyline: the tangent of a quarter of the angle of the arc that follows.
  struct Vertex {
    double x, y, bulge = 0;
  };
  // Properties that the following entities share. `below`: seen from below, so that their object coordinates have the x
  // axis turned; the drawing is the same.
  struct Look {
    bool below = false, invisible = false, on_sheet = false;
  };
  enum class Boundary { polyline, edges };
  struct Hatch {
    Boundary boundary = Boundary::polyline;
    int seeds = 0;                // points far away
    int style = 0;                // 0: odd, 1: outermost, 2: all
    std::vector<int> flags = {};  // of each ring, beside that of a polyline
  };

  // `unit`: code of $INSUNITS, 0 if none; `scale`: units in a metre, in which the calls below are; `east`, `north`:
  // what is added to coordinates outside of blocks.
  explicit DrawingText(int unit = 6, double scale = 1, double east = 0, double north = 0);

  void look(const Look& look) { look_ = look; }
  // Colour below 0: off; flag 1: frozen.
  void layer(const std::string& name, int colour = 7, int flags = 0, bool plotted = true);

  void line(const std::string& layer, double x1, double y1, double x2, double y2);
  void polyline(const std::string& layer, const Points& points, bool closed = true);
  void polyline(const std::string& layer, const std::vector<Vertex>& vertices, bool closed, double width);
  // POLYLINE, VERTEX and SEQEND; `heights`: in space, each vertex at another height.
  void old_polyline(const std::string& layer, const std::vector<Vertex>& vertices, bool closed, bool heights = false);
  void faces(const std::string& layer, const Points& corners, const std::vector<std::vector<int>>& faces);
  void rectangle(const std::string& layer, double x0, double y0, double x1, double y1);
  // Counter-clockwise between angles in degrees.
  void arc(const std::string& layer, double x, double y, double radius, double from, double to);
  void circle(const std::string& layer, double x, double y, double radius);
  void ellipse(const std::string& layer, double x, double y, double major_x, double major_y, double ratio);
  void round_spline(const std::string& layer, double x, double y, double radius);  // a circle, exactly
  void solid(const std::string& layer, double x0, double y0, double x1, double y1);
  void hatch(const std::string& layer, const std::vector<Points>& rings, const Hatch& hatch);
  void multiline(const std::string& layer, double x1, double y1, double x2, double y2, double width);
  void text(const std::string& layer, double x, double y, const std::string& text);
  void paragraph(const std::string& layer, double x, double y, const std::string& text);  // MTEXT
  struct Array {
    int columns = 1, rows = 1;
    double dx = 0, dy = 0;
  };
  void insert(const std::string& layer, const std::string& block, double x, double y, double sx = 1, double sy = 1,
              double degrees = 0, const Array& array = {1, 1, 0, 0});
  // An entity of any type, with its groups as text; lengths in units.
  void raw(const std::string& type, const std::string& layer, const std::string& groups = {});
  // Puts all that is drawn from here on into a block, until `end_block`.
  void begin_block(const std::string& name, double base_x = 0, double base_y = 0);
  void end_block();
  std::string str() const;

 private:
  static std::string group(int code, const std::string& value) { return std::to_string(code) + "\n" + value + "\n"; }
  std::string length(int code, double metres) const;
  // A point of the world, and one of object coordinates.
  std::string at(int code, double x, double y, double z = 0) const;
  std::string own(int code, double x, double y) const;
  std::string begin(const std::string& type, const std::string& layer, bool object) const;
  std::string vertices_of(const std::vector<Vertex>& vertices) const;

  double scale_, east_, north_;
  Look look_;
  bool in_block_ = false;
  std::string header_, layers_, blocks_, entities_, outside_;
};

// A kitchen and a living room below a corridor, in the walls of 0.3 m, with doors to both and one outside, a window
// each and a table: 10 x 6 m inside, from (0, 0). The living room's west wall ends `miss` short of its corner.
DrawingText small_flat(int unit = 6, double scale = 1, double miss = 0);

}  // namespace vantage::test
