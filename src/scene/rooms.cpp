// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/beyond.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

using Loop = std::vector<std::array<double, 2>>;

bool holds(std::span<const Loop> outline, double x, double y) {
  bool inside = false;
  for (const Loop& loop : outline)
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const auto& [ax, ay] = loop[i];
      const auto& [bx, by] = loop[(i + 1) % loop.size()];
      if ((ay > y) != (by > y) && x < ax + (bx - ax) * ((y - ay) / (by - ay))) inside = !inside;
    }
  return inside;
}

double to_segment(double x, double y, const std::array<double, 2>& a, const std::array<double, 2>& b) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
  const double share = square > 0 ? std::clamp(((x - a[0]) * dx + (y - a[1]) * dy) / square, 0.0, 1.0) : 0.0;
  return std::hypot(x - a[0] - share * dx, y - a[1] - share * dy);
}

}  // namespace

double floor_area(const Room& room) {
  if (room.outline.empty()) return room.box.size().x * room.box.size().y;
  // Subtracts loops within others as holes, by their corners.
  double area = 0;
  for (const Loop& loop : room.outline) {
    double twice = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const auto &a = loop[i], &b = loop[(i + 1) % loop.size()];
      twice += a[0] * b[1] - b[0] * a[1];
    }
    std::size_t around = 0;
    for (const Loop& other : room.outline)
      around += &other != &loop && !loop.empty() && holds({&other, 1}, loop[0][0], loop[0][1]);
    area += (around % 2 == 0 ? 0.5 : -0.5) * std::abs(twice);
  }
  return area;
}

double distance_to(const Room& room, const Vec3& point, double most_m) {
  const Box& box = room.box;
  const double up = beyond(point.z, box.min.z, box.max.z);
  const double apart = beyond(point, box);
  if (!(apart <= most_m)) return most_m;
  if (room.outline.empty() || holds(room.outline, point.x, point.y)) return apart;
  double level = most_m;
  for (const Loop& loop : room.outline)
    for (std::size_t i = 0; i < loop.size(); ++i)
      level = std::min(level, to_segment(point.x, point.y, loop[i], loop[(i + 1) % loop.size()]));
  return std::min(most_m, std::hypot(level, up));
}

std::optional<std::size_t> room_at(std::span<const Room> rooms, const Vec3& point, double within_m) {
  std::optional<std::size_t> nearest;
  double least = within_m + 1e-9;  // more than the farthest that counts
  for (std::size_t k = 0; k < rooms.size() && least > 0; ++k)
    if (const double distance = distance_to(rooms[k], point, least); distance < least) least = distance, nearest = k;
  return nearest;
}

}  // namespace vantage
