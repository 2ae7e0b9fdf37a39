// SPDX-License-Identifier: Apache-2.0
// Tables of stations from spreadsheets, field software and other programs.
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <sstream>
#include <string_view>

#include "core/closest_name.hpp"
#include "core/read_file.hpp"
#include "core/utf8.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"
#include "vantage/targets.hpp"
#include "words/csv_cell.hpp"

namespace vantage {
namespace {

enum class Column { east, north, head, ground, u, v, name, heading, tilt, scanner, step, sigma, proposed };

// Names of columns; each name means one quantity alone.
const std::map<std::string, Column, std::less<>>& known_columns() {
  static const std::map<std::string, Column, std::less<>> names{{"x", Column::east},
                                                                {"e", Column::east},
                                                                {"east", Column::east},
                                                                {"easting", Column::east},
                                                                {"y", Column::north},
                                                                {"n", Column::north},
                                                                {"north", Column::north},
                                                                {"northing", Column::north},
                                                                {"z", Column::head},
                                                                {"h", Column::head},
                                                                {"height", Column::head},
                                                                {"elevation", Column::head},
                                                                {"up", Column::head},
                                                                {"head", Column::head},
                                                                {"z_head", Column::head},
                                                                {"head_z", Column::head},
                                                                {"ground", Column::ground},
                                                                {"z_ground", Column::ground},
                                                                {"ground_z", Column::ground},
                                                                {"height_ground", Column::ground},
                                                                {"ground_height", Column::ground},
                                                                {"height_head", Column::head},
                                                                {"head_height", Column::head},
                                                                {"u", Column::u},
                                                                {"v", Column::v},
                                                                {"elev", Column::head},
                                                                {"alt", Column::head},
                                                                {"altitude", Column::head},
                                                                {"rechtswert", Column::east},
                                                                {"hochwert", Column::north},
                                                                {"höhe", Column::head},
                                                                {"hoehe", Column::head},
                                                                {"name", Column::name},
                                                                {"point", Column::name},
                                                                {"heading", Column::heading},
                                                                {"tilt", Column::tilt},
                                                                {"scanner", Column::scanner},
                                                                {"step", Column::step},
                                                                {"sigma", Column::sigma},
                                                                {"proposed", Column::proposed}};
  return names;
}

const char* const kWanted =
    "it must name x,y,z of the scanner's head, x,y and ground_z, x,y alone, or u,v; also as Easting, Northing, Height "
    "or E, N, Z";

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// Splits a line at separators such as ";"; a blank stands for any number of blanks. In quotes, two quotes are one.
std::vector<std::string> cells_of(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (quoted && line.substr(k, 2) == "\"\"")
      cells.back() += line[k++];
    else if (c == '"')
      quoted = !quoted;
    else if (c == separator && !quoted) {
      if (separator != ' ' || !cells.back().empty()) cells.emplace_back();
    } else
      cells.back() += c;
  }
  for (std::string& cell : cells) cell = trimmed(cell);
  return cells;
}

char separator_of(std::string_view header) {
  for (const char c : {';', '\t', ','})
    if (header.find(c) != std::string_view::npos) return c;
  return header.find(' ') != std::string_view::npos ? ' ' : ',';
}

struct ColumnName {
  std::string name, unit;  // lower-case; the unit as in "Easting [m]" or "x (m)"
};
ColumnName column_name(std::string_view cell) {
  ColumnName column;
  const std::size_t bracket = cell.find_first_of("[(");
  for (const char c : trimmed(cell.substr(0, bracket)))
    column.name += c == ' ' || c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (bracket != std::string_view::npos)
    column.unit = trimmed(cell.substr(bracket + 1, cell.find_first_of("])", bracket) - bracket - 1));
  return column;
}

std::optional<double> parse_plain(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || !(number - number == 0))
    return std::nullopt;
  return number;
}

class Table {
 public:
  explicit Table(const std::filesystem::path& file) : file_(file) {}

  std::vector<StationRow> read() {
    std::istringstream in(read_file(file_));
    std::vector<StationRow> rows;
    for (std::string line; std::getline(in, line);) {
      ++line_number_;
      std::string_view text = line;
      if (line_number_ == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // written by spreadsheets
      if (line_number_ == 1 && (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")))
        refuse("the file is UTF-16; save it as UTF-8");
      if (!is_utf8(text)) refuse("its text is not UTF-8 (Latin-1, perhaps): save the table as UTF-8");
      if (trimmed(text).empty() || trimmed(text).front() == '#') continue;
      if (columns_.empty())
        read_header(text);
      else
        rows.push_back(read_row(text));
    }
    if (columns_.empty()) refuse(std::string("the file is empty; its first line is the header: ") + kWanted);
    return rows;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(Errc::malformed_file, file_.string() + ":" + std::to_string(line_number_) + ": " + what);
  }

  void read_header(std::string_view text) {
    const auto strange = [](char c) { return static_cast<unsigned char>(c) < 32 && c != '\t' && c != '\r'; };
    if (std::any_of(text.begin(), text.end(), strange)) refuse("this is no table of stations, nor text at all");
    separator_ = separator_of(trimmed(text));
    header_ = trimmed(text);
    const auto cells = cells_of(separator_ == '\t' ? text : std::string_view(header_), separator_);
    columns_ = cells;
    const bool numbers = std::all_of(cells.begin(), cells.end(), [](const std::string& c) { return parse_plain(c); });
    if (numbers) refuse("the first line holds numbers, and should be the header: " + std::string(kWanted));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const ColumnName column = column_name(cells[i]);
      for (const char* angle : {"lat", "latitude", "lon", "long", "longitude"})
        if (column.name == angle)
          refuse("\"" + cells[i] +
                 "\" is an angle; vantage takes metres in the scene's frame, as Easting and Northing");
      const auto known = known_columns().find(column.name);
      if (known == known_columns().end()) continue;
      const std::string_view wanted = unit_of(known->second);
      const bool degrees = wanted == "deg" && column.unit == "°";
      if (!column.unit.empty() && !wanted.empty() && column.unit != wanted && !degrees)
        refuse("\"" + cells[i] + "\" is in " + column.unit + "; vantage takes " +
               (wanted == "m" ? "metres" : "degrees"));
      const auto [found, is_new] = at_.try_emplace(known->second, i);
      if (is_new) continue;
      refuse("\"" + cells[found->second] + "\" and \"" + cells[i] + "\" both may be " + meaning(known->second));
    }
    const bool east = at_.contains(Column::east), north = at_.contains(Column::north);
    const bool height = at_.contains(Column::head) || at_.contains(Column::ground);
    const bool u = at_.contains(Column::u), v = at_.contains(Column::v);
    // a near miss of a known column must not be ignored silently
    std::vector<std::string> known;
    for (const auto& [name, column] : known_columns()) known.push_back(name);
    std::string hint;
    for (const std::string& cell : cells)
      if (const std::string name = column_name(cell).name; hint.empty() && !known_columns().contains(name))
        if (const std::string near = name.size() > 2 ? closest_name(name, known) : ""; !near.empty())
          if (!at_.contains(known_columns().at(near))) hint = "; is \"" + cell + "\" " + near + "?";
    const bool enough = east == north && u == v && (east || u) && (east || !height);
    if (enough && (height || u || hint.empty())) return;
    refuse("the header is \"" + header_ + "\"; " + kWanted + hint);
  }

  static std::string_view unit_of(Column column) {
    switch (column) {
      case Column::heading:
      case Column::tilt:
      case Column::step: return "deg";
      case Column::name:
      case Column::scanner: return "";
      default: return "m";
    }
  }

  static std::string meaning(Column column) {
    switch (column) {
      case Column::east: return "the easting: leave one of them out";
      case Column::north: return "the northing: leave one of them out";
      case Column::head: return "the height of the scanner's head: call it head_z, and that of the ground ground_z";
      case Column::ground: return "the height of the ground: leave one of them out";
      case Column::u: return "u: it appears twice";
      case Column::v: return "v: it appears twice";
      case Column::name: return "the station's name: leave one of them out";
      case Column::heading: return "the heading: leave one of them out";
      case Column::tilt: return "the tilt: leave one of them out";
      case Column::scanner: return "the scanner: leave one of them out";
      case Column::step: return "the step: leave one of them out";
      case Column::sigma: return "the standard deviation: leave one of them out";
      case Column::proposed: return "whether a target is proposed: leave one of them out";
    }
    return "";
  }

  StationRow read_row(std::string_view text) const {
    const auto cells = cells_of(separator_ == '\t' ? text : trimmed(text), separator_);
    const bool more = std::any_of(cells.begin() + static_cast<std::ptrdiff_t>(std::min(cells.size(), columns_.size())),
                                  cells.end(), [](const std::string& cell) { return !cell.empty(); });
    if (more)
      refuse("the line has " + std::to_string(cells.size()) + " cells, the header " + std::to_string(columns_.size()) +
             (separator_ == ',' ? "; numbers with decimal commas need ; between the cells" : ""));
    const auto value = [&](Column column) -> std::optional<double> {
      const auto found = at_.find(column);
      if (found == at_.end()) return std::nullopt;
      if (found->second >= cells.size())
        refuse("the line has " + std::to_string(cells.size()) + " cells, too few for " + columns_[found->second]);
      return parse(cells[found->second], columns_[found->second]);
    };
    StationRow row;
    const auto x = value(Column::east), y = value(Column::north), head = value(Column::head),
               ground = value(Column::ground), u = value(Column::u), v = value(Column::v);
    if (x.has_value() != y.has_value() || (!x && (head || ground)) ||
        (x && !head && !ground && (at_.contains(Column::head) || at_.contains(Column::ground))))
      refuse("of x, y and z some are empty");
    if (x && head) row.position = Vec3{*x, *y, *head};
    if (x && ground) row.ground = Vec3{*x, *y, *ground};
    if (x && !head && !ground) row.xy = std::array{*x, *y};
    if (u && v)
      row.uv = Uv{*u, *v};
    else if (u || v)
      refuse("one of u and v is empty");
    if (!x && !u) refuse("the line has neither a position nor (u, v)");
    const auto word = [&](Column column) {
      const auto found = at_.find(column);
      return found != at_.end() && found->second < cells.size() ? cells[found->second] : std::string();
    };
    row.name = text_of_csv_cell(word(Column::name));
    row.scanner = text_of_csv_cell(word(Column::scanner));
    row.check = text_of_csv_cell(word(Column::proposed)) == "check";
    const auto angle = [&](Column column) -> std::optional<Angle> {
      const auto degrees = value(column);
      return degrees ? std::optional(Angle::degrees(*degrees)) : std::nullopt;
    };
    row.setup.heading = angle(Column::heading).value_or(Angle());
    row.setup.tilt = angle(Column::tilt).value_or(Angle());
    row.step = angle(Column::step);
    row.sigma_m = value(Column::sigma);
    return row;
  }

  std::optional<double> parse(const std::string& cell, const std::string& column) const {
    if (cell.empty()) return std::nullopt;
    std::string plain = cell;
    const std::size_t comma = plain.find(',');
    if (comma != std::string::npos) {
      if (plain.find('.') != std::string::npos || plain.find(',', comma + 1) != std::string::npos)
        refuse("\"" + cell + "\" is no number for " + column + "; write it without marks between the thousands");
      plain[comma] = '.';
    }
    const auto number = parse_plain(plain);
    if (!number) refuse("\"" + cell + "\" is no number for " + column);
    return number;
  }

  std::filesystem::path file_;
  std::size_t line_number_ = 0;
  char separator_ = ',';
  std::string header_;
  std::vector<std::string> columns_;
  std::map<Column, std::size_t> at_;
};

}  // namespace

std::vector<StationRow> read_stations_csv(const std::filesystem::path& file) { return Table(file).read(); }

std::vector<Target> read_targets_csv(const std::filesystem::path& file) {
  std::vector<Target> targets;
  for (const StationRow& row : Table(file).read()) {
    const std::string name = row.name.empty() ? "target " + std::to_string(targets.size() + 1) : row.name;
    const auto refuse = [&](const std::string& what) {
      throw Error(Errc::malformed_file, file.string() + ": " + name + " " + what);
    };
    if (!row.position) refuse("has no x, y and z of its centre");
    if (row.sigma_m && !(*row.sigma_m > 0 && *row.sigma_m <= 1))
      refuse("has a sigma that is not above 0 and at most 1 m; leave it empty unless its coordinates are known");
    if (row.check) continue;  // proposed anew for the stations of the day
    targets.push_back({.name = name, .centre = *row.position, .control_m = row.sigma_m.value_or(0)});
  }
  return targets;
}

}  // namespace vantage
