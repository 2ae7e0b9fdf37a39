// SPDX-License-Identifier: Apache-2.0
#include "candidates/rooms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "placement/triangle_parts.hpp"
#include "scene/room_above.hpp"

namespace vantage {
namespace {

constexpr double kStanding_m2 = 1;  // floor that a tripod stands on

double edge_length(const Vec3& v) { return std::sqrt(dot(v, v)); }

// Adds the area of a triangle to the rooms that its parts lie in.
template <class Add>
void add_to_rooms(std::span<const Room> rooms, const Vec3& a, const Vec3& b, const Vec3& c, const Add& add) {
  const double area = 0.5 * edge_length(cross(b - a, c - a));
  for_triangle_parts(a, b, c, [&](const Vec3& middle, double share) {
    if (const auto room = room_above(rooms, middle)) add(*room, share * area);
  });
}

}  // namespace

std::vector<RoomShare> shares_by_room(std::span<const Room> rooms, const SearchArea& area) {
  std::vector<RoomShare> shares(rooms.size());
  if (rooms.empty()) return shares;
  const SearchMesh& mesh = area.mesh();
  for (const auto& t : mesh.triangles)
    add_to_rooms(rooms, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]],
                 [&](std::size_t room, double m2) { shares[room].ground_m2 += m2; });
  std::vector<double> most(rooms.size(), 0);
  for (const LeftOut& out : area.left_out()) {
    std::vector<double> here(rooms.size(), 0);
    for (const auto& t : out.triangles)
      add_to_rooms(rooms, out.positions[t[0]], out.positions[t[1]], out.positions[t[2]],
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
