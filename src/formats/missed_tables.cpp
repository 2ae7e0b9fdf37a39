// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "core/atomic_file.hpp"
#include "core/text.hpp"
#include "formats/voxel_ply.hpp"
#include "map/missed_colours.hpp"
#include "vantage/export.hpp"
#include "words/csv_cell.hpp"

namespace vantage {
void write_missed_csv(const std::filesystem::path& file, std::span<const MissedShare> shares) {
  std::string text = "node,voxels";
  for (const MissedStyle& style : kMissedStyles) text += "," + to_string(style.why);
  text += "\n";
  for (const MissedShare& share : shares) {
    text += csv_cell(&share == &shares.front() ? "(all)" : share.node) + "," + number(share.voxels);
    for (const MissedStyle& style : kMissedStyles) text += "," + fixed(share.share(style.why), 4);
    text += "\n";
  }
  write_atomically(file, text);
}

void write_rooms_csv(const std::filesystem::path& file, std::span<const Room> rooms, std::span<const RoomShare> shares,
                     std::span<const PlacedStation> stations, std::span<const std::string> names) {
  const std::vector<std::string> called = station_names(stations, names);
  const std::vector<std::vector<std::size_t>> in = stations_in_rooms(rooms, stations);
  std::string text = "storey,room,floor_m2,ground_m2,stations,why_no_station,voxels";
  for (const MissedStyle& style : kMissedStyles) text += "," + to_string(style.why);
  text += "\n";
  for (std::size_t k = 0; k < rooms.size(); ++k) {
    std::string here;
    for (const std::size_t station : in[k]) here += (here.empty() ? "" : " ") + called[station];
    const MissedShare& share = shares[k].share;
    text += csv_cell(rooms[k].storey) + "," + csv_cell(rooms[k].name) + "," + fixed(floor_area(rooms[k]), 2) + "," +
            fixed(shares[k].ground_m2, 2) + "," + csv_cell(here) + "," +
            csv_cell(here.empty() ? why_no_station(shares[k]) : "") + "," + number(share.voxels);
    // A room without a surveyed surface has no shares.
    for (const MissedStyle& style : kMissedStyles)
      text += "," + (share.voxels > 0 ? fixed(share.share(style.why), 4) : "");
    text += "\n";
  }
  write_atomically(file, text);
}

void write_missed_ply(const std::filesystem::path& file, const Simulator& simulator, const MissedVoxels& missed,
                      PlyCoordinates coordinates) {
  write_voxel_ply(file, coordinates, simulator, {{"uchar", "why"}, {"uint", "count"}}, missed.voxels.size(),
                  [&](std::uint64_t k, std::string& bytes) {
                    const WhyMissed why = missed.status[k].why;
                    append(bytes, static_cast<std::uint8_t>(why));
                    append(bytes, missed.points[k]);
                    return VoxelVertex{missed.voxels[k], missed_style(why).colour};
                  });
}

}  // namespace vantage
