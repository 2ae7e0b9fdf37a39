// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <charconv>
#include <fstream>
#include <map>
#include <string_view>

#include "core/atomic_file.hpp"
#include "core/text.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

void write_stations_csv(const std::filesystem::path& file, std::span<const PlacedStation> stations) {
  std::string text = "station,x,y,z,u,v,status\n";
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const PlacedStation& s = stations[i];
    text += number(i + 1) + ",";  // numbered from 1, as in the pictures
    // A station in a hole has no position; empty cells keep a reader from taking it for the origin.
    if (s.status == StationStatus::hole)
      text += ",,,";
    else
      text += number(s.position.x) + "," + number(s.position.y) + "," + number(s.position.z) + ",";
    text += number(s.uv.u) + "," + number(s.uv.v) + "," + to_string(s.status) + "\n";
  }
  write_atomically(file, text);
}

std::vector<StationRow> read_stations_csv(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(Errc::io, "cannot read " + file.string() + "; does it exist?");
  std::size_t line_number = 0;
  const auto refuse = [&](const std::string& what) {
    throw Error(Errc::malformed_file, file.string() + ":" + std::to_string(line_number) + ": " + what);
  };

  std::map<std::string, std::size_t, std::less<>> column;
  std::vector<StationRow> rows;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    std::string_view text = line;
    if (line_number == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark of spreadsheets
    text = trimmed(text);
    if (text.empty() || text.front() == '#') continue;
    const auto cells = cells_of(text);
    if (column.empty()) {
      for (std::size_t i = 0; i < cells.size(); ++i) {
        std::string name;
        for (const char c : cells[i]) name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        if (!column.try_emplace(name, i).second) refuse("the column \"" + name + "\" appears twice");
      }
      const auto count = [&](std::initializer_list<const char*> names) {
        std::size_t n = 0;
        for (const char* name : names) n += column.count(name);
        return n;
      };
      const std::size_t xyz = count({"x", "y", "z"}), uv = count({"u", "v"});
      if ((xyz != 3 && uv != 2) || xyz % 3 != 0 || uv % 2 != 0)
        refuse("the header must name x,y,z or u,v (or both), it is \"" + std::string(text) + "\"");
      continue;
    }
    const auto value = [&](const char* name) -> std::optional<double> {
      const auto found = column.find(name);
      if (found == column.end()) return std::nullopt;
      if (found->second >= cells.size())
        refuse("the line has " + std::to_string(cells.size()) + " cells, too few for " + name);
      std::string_view cell = cells[found->second];
      if (cell.empty()) return std::nullopt;
      if (cell.front() == '+') cell.remove_prefix(1);
      double number = 0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
      if (error != std::errc() || end != cell.data() + cell.size() || !(number - number == 0))
        refuse("\"" + std::string(cells[found->second]) + "\" is no number for " + name);
      return number;
    };
    StationRow row;
    const auto x = value("x"), y = value("y"), z = value("z"), u = value("u"), v = value("v");
    if (x && y && z)
      row.position = Vec3{*x, *y, *z};
    else if (x || y || z)
      refuse("of x, y and z some are empty");
    if (u && v)
      row.uv = Uv{*u, *v};
    else if (u || v)
      refuse("one of u and v is empty");
    if (!row.position && !row.uv) refuse("the line has neither a position nor (u, v)");
    rows.push_back(row);
  }
  if (column.empty()) refuse("the file is empty; a header naming x,y,z or u,v is wanted");
  return rows;
}

}  // namespace vantage
