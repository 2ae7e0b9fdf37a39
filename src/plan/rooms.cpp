// SPDX-License-Identifier: Apache-2.0
#include "plan/rooms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vantage {
namespace {

constexpr double kKnee_m = 0.5;     // above a floor one is surely in its room
constexpr double kStanding_m2 = 1;  // floor that a tripod stands on
constexpr double kPiece_m = 0.4;    // sides of the parts of a triangle that are in one room or another

double edge_length(const Vec3& v) { return std::sqrt(dot(v, v)); }

std::optional<std::size_t> room_above(std::span<const Room> rooms, const Vec3& ground) {
  return room_at(rooms, ground + Vec3{0, 0, kKnee_m});
}

// Adds the area of a triangle to the rooms that its parts lie in.
template <class Add>
void for_parts(std::span<const Room> rooms, const Vec3& a, const Vec3& b, const Vec3& c, const Add& add) {
  const double longest = std::max({edge_length(b - a), edge_length(c - b), edge_length(a - c)});
  const auto n = static_cast<int>(std::clamp(std::ceil(longest / kPiece_m), 1.0, 1000.0));
  const Vec3 u = (b - a) * (1.0 / n), v = (c - a) * (1.0 / n);
  const double area = 0.5 * edge_length(cross(u, v));
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j)
      for (int half = 0; half < (i + j + 1 < n ? 2 : 1); ++half) {
        const double third = (half + 1) / 3.0;
        if (const auto room = room_above(rooms, a + u * (i + third) + v * (j + third))) add(*room, area);
      }
}

}  // namespace

std::vector<RoomShare> shares_by_room(std::span<const Room> rooms, const SearchArea& area) {
  std::vector<RoomShare> shares(rooms.size());
  if (rooms.empty()) return shares;
  const SearchMesh& mesh = area.mesh();
  for (const auto& t : mesh.triangles)
    for_parts(rooms, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]],
              [&](std::size_t room, double m2) { shares[room].ground_m2 += m2; });
  std::vector<double> most(rooms.size(), 0);
  for (const LeftOut& out : area.left_out()) {
    std::vector<double> here(rooms.size(), 0);
    for (const auto& t : out.triangles)
      for_parts(rooms, out.positions[t[0]], out.positions[t[1]], out.positions[t[2]],
                [&](std::size_t room, double m2) { here[room] += m2; });
    for (std::size_t k = 0; k < rooms.size(); ++k) {
      // Sealed floor comes before any other: an entrance makes ground of it.
      if (out.reason == LeftOutReason::sealed && here[k] >= kStanding_m2)
        here[k] = std::numeric_limits<double>::infinity();
      if (here[k] > most[k]) most[k] = here[k], shares[k].left_out = out.reason;
    }
  }
  return shares;
}

std::vector<std::vector<std::size_t>> stations_in_rooms(std::span<const Room> rooms,
                                                        std::span<const PlacedStation> stations) {
  std::vector<std::vector<std::size_t>> in(rooms.size());
  for (std::size_t k = 0; k < stations.size(); ++k)
    if (active(stations[k]))
      if (const auto room = room_above(rooms, stations[k].ground)) in[*room].push_back(k);
  return in;
}

std::string why_no_station(const RoomShare& room) {
  // A part too small for any of the room's own surfaces to depend on.
  constexpr double kNothing = 0.005;
  if (room.ground_m2 <= 0) return room.left_out ? to_string(*room.left_out) : "the model has no floor in it";
  if (room.share.share(WhyMissed::not_chosen) < kNothing) return "other stations capture what can be captured";
  return "no place in it was chosen";
}

}  // namespace vantage
