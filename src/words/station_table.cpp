// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/text.hpp"
#include "evaluate/known_points.hpp"
#include "vantage/summary.hpp"
#include "words/station_cells.hpp"

namespace vantage {
namespace {

// A column: its title, and a cell for each station.
struct TableColumn {
  std::string title;
  std::vector<std::string> cells = {};
  bool words = false;  // left-aligned; numbers are right-aligned
};

std::string shortened(double value, int digits) {
  const double scale = std::pow(10, digits);
  return fixed(std::round(scale * value) / scale + 0.0, digits);  // no "-0.000"
}

// Number of characters; UTF-8 continuation bytes are 10xxxxxx.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::vector<TableColumn> setup_columns(std::span<const PlacedStation> stations, std::span<const Scanner> scanners) {
  TableColumn heading{"heading °"}, tilt{"tilt °"}, scanner{.title = "scanner", .words = true}, step{"step °"};
  for (const PlacedStation& s : stations) {
    heading.cells.push_back(shortened(s.setup.heading.in_degrees(), 1));
    tilt.cells.push_back(shortened(s.setup.tilt.in_degrees(), 1));
    const Scanner* own = s.setup.scanner < scanners.size() ? &scanners[s.setup.scanner] : nullptr;
    scanner.cells.push_back(own ? own->name : "");
    step.cells.push_back(own && own->one_step() ? shortened(own->azimuth_step.in_degrees(), 4) : "");
  }
  return {heading, tilt, scanner, step};
}

}  // namespace

std::vector<std::string> set_ups_of(const Evaluation& evaluation) {
  std::vector<std::string> texts;
  for (const KnownPoints& known : known_points(evaluation)) texts.push_back(set_up_text(known, evaluation));
  return texts;
}

std::string station_table(std::span<const PlacedStation> stations, std::span<const std::string> names,
                          std::span<const std::uint64_t> points, std::span<const Scanner> scanners,
                          std::span<const std::string> set_ups) {
  TableColumn name{.title = "station", .words = true}, x{"ground x"}, y{"y"}, z{"z"}, head{"head z"},
      status{.title = "status", .words = true}, counted{"points on surveyed meshes"};
  for (std::size_t k = 0; k < stations.size(); ++k) {
    const PlacedStation& s = stations[k];
    const auto metres = [&](double value) {
      return s.status == StationStatus::hole ? std::string() : shortened(value, 3);
    };
    name.cells.push_back(names[k]);
    x.cells.push_back(metres(s.ground.x)), y.cells.push_back(metres(s.ground.y));
    z.cells.push_back(metres(s.ground.z)), head.cells.push_back(metres(s.position.z));
    status.cells.push_back(to_string(s.status) + (s.existing ? ", existing" : ""));
    counted.cells.push_back(k < points.size() ? number(points[k]) : "");
  }
  std::vector<TableColumn> columns{name, x, y, z, head, status};
  if (!points.empty()) columns.push_back(counted);
  if (!set_ups.empty())
    columns.push_back({.title = "known points", .cells = {set_ups.begin(), set_ups.end()}, .words = true});
  if (tells_setups(stations)) std::ranges::move(setup_columns(stations, scanners), std::back_inserter(columns));

  std::vector<std::string> lines(stations.size() + 1);
  for (const TableColumn& column : columns) {
    std::size_t width = width_of(column.title);
    for (const std::string& cell : column.cells) width = std::max(width, width_of(cell));
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const std::string& cell = k == 0 ? column.title : column.cells[k - 1];
      const std::string blanks(width - width_of(cell), ' ');
      lines[k] += (&column == columns.data() ? "" : "  ") + (column.words ? cell + blanks : blanks + cell);
    }
  }
  std::string text;
  for (const std::string& line : lines) text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  return text;
}

}  // namespace vantage
