// SPDX-License-Identifier: Apache-2.0
#include <sstream>
#include <string>

#include "core/parse.hpp"
#include "core/read_file.hpp"
#include "vantage/error.hpp"
#include "vantage/scanner.hpp"

namespace vantage {

DirectionTable load_directions(const std::filesystem::path& file) {
  std::istringstream stream(read_file(file));
  DirectionTable table;
  std::size_t cells_a_line = 0;
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    if (line.ends_with('\r')) line.pop_back();
    const std::string_view text = trimmed_text(line);
    if (text.empty() || text.starts_with('#')) continue;
    const std::string what = file.string() + ", line " + std::to_string(number);
    const auto cells = split(text, ',');
    if (cells_a_line == 0) {
      const bool known = (cells.size() == 2 || cells.size() == 3) && trimmed_text(cells[0]) == "azimuth_deg" &&
                         trimmed_text(cells[1]) == "elevation_deg" &&
                         (cells.size() == 2 || trimmed_text(cells[2]) == "time_s");
      if (!known)
        throw Error(Errc::malformed_file,
                    what + ": the header must be azimuth_deg,elevation_deg or azimuth_deg,elevation_deg,time_s");
      cells_a_line = cells.size();
      continue;
    }
    if (cells.size() != cells_a_line)
      throw Error(Errc::malformed_file, what + ": must have " + std::to_string(cells_a_line) + " cells, as the header");
    const double azimuth = parse_number(cells[0], what, {.low = -360, .high = 360}),
                 elevation = parse_number(cells[1], what, {.low = -90, .high = 90});
    table.directions.push_back({Angle::degrees(90 - elevation), Angle::degrees(azimuth)});
    if (cells_a_line < 3) continue;
    const double time = parse_number(cells[2], what, kAnySeconds);
    if (!table.times_s.empty() && time < table.times_s.back())
      throw Error(Errc::malformed_file, what + ": times must not fall");
    table.times_s.push_back(time);
  }
  if (table.directions.empty()) throw Error(Errc::malformed_file, file.string() + ": holds no direction");
  return table;
}

}  // namespace vantage
