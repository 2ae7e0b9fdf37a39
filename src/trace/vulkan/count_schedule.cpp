// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/count_schedule.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "trace/vulkan/groups.hpp"

namespace vantage::vulkan {

CountSchedule::CountSchedule(std::uint32_t stations, std::uint32_t rows, std::uint32_t columns,
                             std::uint32_t rows_per_part)
    : stations_(stations), rows_(rows), columns_(columns), rows_per_part_(rows_per_part) {
  assert(rows > 0 && columns > 0 && rows_per_part > 0 && rows_per_part % tile_side == 0);
}

std::vector<CountPart> CountSchedule::next(double rays) {
  std::vector<CountPart> parts;
  double scheduled = 0;
  std::uint64_t list = 0;
  std::uint32_t slots = 0;
  const double tile_rows = std::floor(rays / (static_cast<double>(columns_) * tile_side));
  const auto at_once = static_cast<std::uint32_t>(
      std::clamp(tile_rows * tile_side, double{tile_side}, static_cast<double>(rows_per_part_)));
  while (!finished() && (parts.empty() || scheduled < rays) && parts.size() < kPartsPerSubmission) {
    const bool same_station = !parts.empty() && parts.back().station == station_;
    if (!same_station && slots == kStationsPerSubmission) break;
    if (!same_station) ++slots;
    parts.push_back({station_, row_, std::min(at_once, rows_ - row_), slots - 1, list});
    list += 1 + tiles_of(parts.back());
    scheduled += static_cast<double>(parts.back().row_count) * columns_;
    row_ += parts.back().row_count;
    if (row_ == rows_) {
      row_ = 0;
      ++station_;
    }
  }
  return parts;
}

std::uint64_t CountSchedule::rays_of(std::span<const CountPart> parts) const {
  std::uint64_t rays = 0;
  for (const CountPart& part : parts) rays += std::uint64_t{part.row_count} * columns_;
  return rays;
}

std::uint32_t CountSchedule::tiles_in_row() const { return groups_of(columns_, tile_side); }
std::uint32_t CountSchedule::tiles() const { return tiles_in_row() * groups_of(rows_, tile_side); }
std::uint32_t CountSchedule::tiles_of(const CountPart& part) const {
  return groups_of(part.row_count, tile_side) * tiles_in_row();
}
std::uint64_t CountSchedule::list_words() const {
  return std::uint64_t{tiles()} * kStationsPerSubmission + kPartsPerSubmission;
}

bool CountHeadroom::clamp_before(std::uint64_t rays) {
  // A clamped count is at most count_limit, so fewer than count_limit further rays cannot make it wrap.
  assert(rays < count_limit);
  const bool clamp = added_ + rays > count_limit - 1;
  added_ = (clamp ? 0 : added_) + rays;
  return clamp;
}

}  // namespace vantage::vulkan
