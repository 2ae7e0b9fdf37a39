// SPDX-License-Identifier: Apache-2.0
/// Plain values used everywhere: points, boxes, angles.
#pragma once

#include <compare>
#include <cstdint>

namespace vantage {

/// A point or a vector in the survey frame: right-handed, Z up, metres, double precision.
struct Vec3 {
  double x = 0, y = 0, z = 0;  ///< Z is up.
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

/// Sum.
constexpr Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
/// Difference.
constexpr Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
/// Multiple.
constexpr Vec3 operator*(const Vec3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
/// Scalar product.
constexpr double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/// Vector product.
constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Parametric coordinates of the search area (equation 3 of the method).
struct Uv {
  double u = 0, v = 0;  ///< In the range that the search area has.
  friend constexpr bool operator==(const Uv&, const Uv&) = default;
};

/// Axis-aligned box; empty while `min` exceeds `max`.
struct Box {
  Vec3 min{1e300, 1e300, 1e300}, max{-1e300, -1e300, -1e300};  ///< Lower and upper corner.

  /// True if it holds no point.
  constexpr bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
  /// Grows to hold a point.
  constexpr void extend(const Vec3& p) {
    min = {p.x < min.x ? p.x : min.x, p.y < min.y ? p.y : min.y, p.z < min.z ? p.z : min.z};
    max = {p.x > max.x ? p.x : max.x, p.y > max.y ? p.y : max.y, p.z > max.z ? p.z : max.z};
  }
  constexpr Vec3 size() const { return empty() ? Vec3{} : max - min; }  ///< Lengths of its edges; 0 if it is empty.
  constexpr Vec3 centre() const { return (min + max) * 0.5; }           ///< Its middle. REQUIRES: !empty().
};

/// An angle. Numbers do not convert implicitly, so degrees and radians cannot be confused.
class Angle {
 public:
  constexpr Angle() = default;
  static constexpr Angle degrees(double d) { return Angle(d * 0.017453292519943295); }  ///< Angle of so many degrees.
  static constexpr Angle radians(double r) { return Angle(r); }                         ///< Angle of so many radians.
  constexpr double in_radians() const { return radians_; }                              ///< Its number of radians.
  constexpr double in_degrees() const { return radians_ * 57.295779513082320877; }      ///< Its number of degrees.
  friend constexpr auto operator<=>(const Angle&, const Angle&) = default;

 private:
  constexpr explicit Angle(double r) : radians_(r) {}
  double radians_ = 0;
};

}  // namespace vantage
