// SPDX-License-Identifier: Apache-2.0
// Solid shapes as triangles, as fine as the detail requires. Normals point outward and windings agree with them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "generate/model.hpp"

namespace vantage::built_in {

inline constexpr double kPi = std::numbers::pi;
inline constexpr dvec3 kUp{0, 0, 1};

// A rectangle from `corner` over the edges `across` and `up`, in columns × rows cells of two triangles; its normal is
// across × up.
void add_rectangle(Mesh& mesh, const dvec3& corner, const dvec3& across, const dvec3& up, int columns, int rows);

// Fineness of shapes: the largest distance between a round surface and its triangles.
struct Detail {
  double sagitta_m = 1e-3;
  bool rough() const { return sagitta_m > 5e-3; }  // small parts are only suggested
  int around(double radius) const;                 // sides of a circle
  int along(double length) const;                  // rows of a round surface
  int across(double length) const;                 // cells along an edge of a flat face
};

// Right-handed axes at a point.
struct Frame {
  dvec3 origin{}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  Frame at(const dvec3& point) const { return {point, x, y, z}; }
  Frame ahead(double distance) const { return at(origin + z * distance); }
  dvec3 point(double px, double py, double pz) const { return origin + x * px + y * py + z * pz; }
};
// Axes with z along `direction`; y is horizontal if possible.
Frame frame_along(const dvec3& origin, const dvec3& direction);
// `frame` turned about an axis through `centre`.
Frame turned(const Frame& frame, const dvec3& centre, const dvec3& axis, double angle);

// A circle in the xy plane of a frame, with its normal's components along the radius and along z.
struct Ring {
  Frame frame;
  double radius = 0, normal_out = 1, normal_ahead = 0;
};

// Point (ahead, radius) of a profile turned about the z axis.
struct ProfilePoint {
  double ahead = 0, radius = 0;
};

enum Face : unsigned { kLeft = 1, kRight = 2, kFront = 4, kBack = 8, kBottom = 16, kTop = 32 };  // −x +x −y +y −z +z

// Adds shapes to a mesh, or only counts their triangles, for the search for the right detail.
class Shaper {
 public:
  Shaper(const Detail& detail, bool counting) : detail_(detail), counting_(counting) {}

  const Detail& detail() const { return detail_; }
  std::size_t triangles() const { return triangles_; }
  Mesh take() { return std::move(mesh_); }

  // Joins each ring to the next with `sides` quadrilaterals. Going ahead, the outside is to the left of the profile. A
  // ring of radius 0 is a point.
  void skin(std::span<const Ring> rings, int sides);
  // A turned profile with sharp edges at its points.
  void turn(const Frame& frame, std::span<const ProfilePoint> profile, int sides);
  // A cylinder from `frame` over `length`, each end closed or not.
  void cylinder(const Frame& frame, double radius, double length, bool close_start, bool close_end);
  void rod(const dvec3& from, const dvec3& to, double radius, bool close = true);
  // A dished head: half an ellipsoid of the given height over a circle, bulging along +z.
  void head(const Frame& frame, double radius, double height, int sides);
  // A part of a torus around the frame's z axis, from angle 0 at x.
  void hoop(const Frame& frame, double radius, double tube_radius, double angle);
  // An upright regular prism with a top but no bottom, for bolts, nuts, and plates on a surface.
  void prism(const Frame& frame, double radius, double height, int sides);
  // Counter-clockwise seen from outside; omitted if it has no area.
  void triangle(const dvec3& a, const dvec3& b, const dvec3& c);
  void face(const dvec3& corner, const dvec3& across, const dvec3& up);
  // A box between two corners of the frame, without the faces in `omitted`.
  void box(const Frame& frame, const dvec3& low, const dvec3& high, unsigned omitted = 0);
  void box(const dvec3& low, const dvec3& high, unsigned omitted = 0) { box(Frame{}, low, high, omitted); }
  // A bar of rectangular section between two points; `width` is horizontal across it, `height` upright.
  void bar(const dvec3& from, const dvec3& to, double width, double height);
  // A wide-flange section from `frame` over `length`: web along y, flanges along x. The ends are open unless closed by
  // the arguments.
  void wide_flange(const Frame& frame, double width, double depth, double length, bool close_start, bool close_end);

 private:
  void strip(const dvec3& a, const dvec3& b, const dvec3& ahead, const dvec3& normal);

  Detail detail_;
  bool counting_;
  std::size_t triangles_ = 0;
  Mesh mesh_;
};

}  // namespace vantage::built_in
