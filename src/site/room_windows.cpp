// SPDX-License-Identifier: Apache-2.0
#include "site/room_windows.hpp"

#include <algorithm>
#include <string>

#include "core/closest_name.hpp"
#include "objective/meshes_named.hpp"
#include "scene/room_above.hpp"
#include "vantage/error.hpp"

namespace vantage {

void check_rooms(std::span<const AccessWindow> windows, std::span<const Room> rooms) {
  for (const AccessWindow& window : windows) {
    if (rooms.empty())
      throw Error(Errc::invalid_argument, "window: '" + to_string(window) +
                                              "' is for rooms, and the model names none, as IFC and floor plans do");
    if (std::ranges::any_of(rooms, [&](const Room& room) { return names_mesh(window.rooms, room.name); })) continue;
    std::vector<std::string> names;
    for (const Room& room : rooms)
      if (std::ranges::find(names, room.name) == names.end()) names.push_back(room.name);
    throw Error(Errc::invalid_argument,
                "window: no room is named like '" + window.rooms + "'" + names_there_are(window.rooms, names));
  }
}

std::function<std::vector<std::size_t>(const Vec3&)> windows_by_room(std::span<const AccessWindow> windows,
                                                                     std::span<const Room> rooms) {
  if (windows.empty()) return {};
  std::vector<std::vector<std::size_t>> of_room(rooms.size());
  for (std::size_t w = 0; w < windows.size(); ++w)
    for (std::size_t r = 0; r < rooms.size(); ++r)
      if (names_mesh(windows[w].rooms, rooms[r].name)) of_room[r].push_back(w);
  return [of_room, rooms = std::vector<Room>(rooms.begin(), rooms.end())](const Vec3& ground) {
    const auto room = room_above(rooms, ground);
    return room ? of_room[*room] : std::vector<std::size_t>{};
  };
}

}  // namespace vantage
