// SPDX-License-Identifier: Apache-2.0
// Best-first search over pieces of the search area. The distance from a point to the meshes changes no faster than the
// point moves, so a piece whose middle is too near to them by more than the piece's radius holds no free place.
#include "placement/nearest_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <utility>

#include "core/text.hpp"
#include "placement/place_head.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr double kFinest = 0.02;           // of the radius: pieces smaller than this are not cut further
constexpr double kFinestUnchecked = 0.01;  // metres, if the clash check is off

double length(const Vec3& v) { return std::sqrt(dot(v, v)); }

struct Piece {
  std::array<Vec3, 3> corners;
  std::array<Uv, 3> uvs;
  double away = 0;  // distance of its nearest point
  std::array<double, 3> nearest{};

  Vec3 point(const std::array<double, 3>& w) const { return corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2]; }
  Uv uv(const std::array<double, 3>& w) const {
    return {uvs[0].u * w[0] + uvs[1].u * w[1] + uvs[2].u * w[2], uvs[0].v * w[0] + uvs[1].v * w[1] + uvs[2].v * w[2]};
  }
  bool operator<(const Piece& other) const { return away > other.away; }  // the nearest on top of a queue
};

// Weights of the corners at the point of a triangle nearest to p (Ericson: Real-Time Collision Detection, 2005, 5.1.5).
std::array<double, 3> nearest_weights(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0], bp = p - t[1], cp = p - t[2];
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

Piece piece_of(const std::array<Vec3, 3>& corners, const std::array<Uv, 3>& uvs, const Vec3& foot) {
  Piece piece{.corners = corners, .uvs = uvs};
  piece.nearest = nearest_weights(foot, corners);
  piece.away = length(piece.point(piece.nearest) - foot);
  return piece;
}

// Returns a lower bound on how much too near to the meshes a station above `ground` is.
double intrusion(const ClashChecker& clash, const Vec3& ground, double height_m) {
  const SecurityVolume& v = clash.volume();
  double most = 0;
  for (const auto& [height, radius] :
       {std::pair{v.lower_m, v.radius_m}, {v.upper_m, v.radius_m}, {height_m, kHeadShare * v.radius_m}})
    most = std::max(most, radius - clash.distance(ground + Vec3{0, 0, height}, radius));
  return most;
}

}  // namespace

std::optional<PlacedStation> nearest_place(const SearchArea& area, const ClashChecker& clash, double height_m,
                                           const Vec3& head, double reach_m) {
  if (!(reach_m >= 0 && std::isfinite(reach_m)) || !std::isfinite(head.x + head.y + head.z))
    throw Error(Errc::invalid_argument, "nearest place: a finite head and a reach of 0 m or more are wanted");
  const Vec3 foot = head - Vec3{0, 0, height_m};
  const double radius = clash.volume().radius_m, finest = radius > 0 ? kFinest * radius : kFinestUnchecked;
  const SearchMesh& mesh = area.mesh();
  std::priority_queue<Piece> pieces;
  for (const auto& t : mesh.triangles) {
    const Piece piece = piece_of({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]},
                                 {mesh.uvs[t[0]], mesh.uvs[t[1]], mesh.uvs[t[2]]}, foot);
    if (piece.away <= reach_m) pieces.push(piece);  // false for one that is not finite
  }
  while (!pieces.empty()) {
    const Piece piece = pieces.top();
    pieces.pop();
    const Vec3 ground = piece.point(piece.nearest);
    const PlacedHead placed =
        place_head(&area, clash, height_m, ground + Vec3{0, 0, height_m}, piece.uv(piece.nearest));
    if (placed.station.status == StationStatus::ok) return placed.station;
    const auto& c = piece.corners;
    const Vec3 middle = (c[0] + c[1] + c[2]) * (1.0 / 3);
    const double wide = std::max({length(c[0] - middle), length(c[1] - middle), length(c[2] - middle)});
    if (wide < finest || intrusion(clash, middle, height_m) > wide) continue;
    std::size_t side = 0;  // the longest, opposite to corner (side + 2) % 3
    for (std::size_t k = 1; k < 3; ++k)
      if (length(c[(k + 1) % 3] - c[k]) > length(c[(side + 1) % 3] - c[side])) side = k;
    const std::size_t a = side, b = (side + 1) % 3, apex = (side + 2) % 3;
    const Vec3 half = (c[a] + c[b]) * 0.5;
    const Uv half_uv{(piece.uvs[a].u + piece.uvs[b].u) / 2, (piece.uvs[a].v + piece.uvs[b].v) / 2};
    for (const std::size_t end : {a, b}) {
      const Piece part = piece_of({c[end], half, c[apex]}, {piece.uvs[end], half_uv, piece.uvs[apex]}, foot);
      if (part.away <= reach_m) pieces.push(part);
    }
  }
  return std::nullopt;
}

std::vector<StationMove> station_moves(const SearchArea& area, const ClashChecker& clash, double height_m,
                                       std::span<const PlacedStation> stations) {
  std::vector<StationMove> moves;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const PlacedStation& s = stations[k];
    if (s.status == StationStatus::ok || s.status == StationStatus::hole || s.existing) continue;
    moves.push_back({.station = k, .to = nearest_place(area, clash, height_m, s.position)});
    if (moves.back().to) moves.back().to->setup = s.setup;
  }
  return moves;
}

std::string offset_text(const Vec3& from, const Vec3& to) {
  constexpr double kShown_m = 0.005;
  const Vec3 by = to - from;
  const double flat = std::hypot(by.x, by.y);
  std::string way;
  if (flat >= kShown_m) {
    static constexpr std::array<const char*, 8> kNames{"east", "north-east", "north", "north-west",
                                                       "west", "south-west", "south", "south-east"};
    const long eighth = std::lround(std::atan2(by.y, by.x) * 4 / std::numbers::pi);
    way = fixed(flat, 2) + " m to the " + kNames[static_cast<std::size_t>((eighth + 8) % 8)];
  }
  if (std::abs(by.z) >= kShown_m)
    way += (way.empty() ? "" : " and ") + fixed(std::abs(by.z), 2) + (by.z > 0 ? " m up" : " m down");
  return way.empty() ? "a few millimetres" : way;
}

std::string move_text(const Vec3& head, const StationMove& move) {
  if (!move.to) return "no place within " + number(move.reach_m) + " m is free";
  const Vec3& to = move.to->position;
  return "move it " + offset_text(head, to) + ", to " + fixed(to.x, 3) + "," + fixed(to.y, 3) + "," + fixed(to.z, 3);
}

}  // namespace vantage
