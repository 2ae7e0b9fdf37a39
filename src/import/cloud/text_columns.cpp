// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/text_columns.hpp"

#include <algorithm>
#include <cmath>

#include "import/cloud/byte_file.hpp"
#include "import/cloud/scalar_field.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::string_view kBlanks = " \t";

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view word_itself(std::string_view word) {
  const auto first = word.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  word = word.substr(first, word.find_last_not_of(kBlanks) + 1 - first);
  if (word.size() >= 2 && word.front() == '"' && word.back() == '"') word = word.substr(1, word.size() - 2);
  return word;
}

// A number in quotes may be cut at its comma, so that each part has one quote.
std::string_view without_quotes(std::string_view word) {
  if (word.starts_with('"')) word.remove_prefix(1);
  if (word.ends_with('"')) word.remove_suffix(1);
  return word;
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

[[noreturn]] void ask(std::span<const std::string> lines, const std::string& what, const std::string& remedy) {
  constexpr std::size_t kShown = 3, kLongest = 70;
  std::string text = what + "; its first lines are";
  for (std::size_t k = 0; k < std::min(kShown, lines.size()); ++k)
    text += std::string(k > 0 ? ", \"" : " \"") + lines[k].substr(0, kLongest) + "\"";
  throw Refused(text + "; " + remedy);
}

constexpr const char* kGiveColumns = "give the setting columns, e.g. -,x,y,z where one column stands before them";

// Returns true if digits stand in groups of three, counted from the decimal mark. `body`: the number without sign,
// fraction and exponent.
bool grouped(std::string_view body, char decimal) {
  std::size_t digits = 0;
  char mark = 0;
  for (std::size_t k = body.size(); k-- > 0;) {
    const char c = body[k];
    if (is_digit(c)) {
      ++digits;
      continue;
    }
    const bool known = c == '\'' || c == ' ' || c == (decimal == '.' ? ',' : '.');
    if (!known || digits != 3 || (mark != 0 && c != mark)) return false;
    digits = 0, mark = c;
  }
  return mark == 0 || (digits >= 1 && digits <= 3 && body.front() != '0');
}

// Styles, the simplest first.
constexpr std::array kStyles{NumberStyle{'.', false}, NumberStyle{',', false}, NumberStyle{'.', true},
                             NumberStyle{',', true}};

// Returns true if people read it as a number: digits, and signs that stand in numbers.
bool looks_numeric(std::string_view word) {
  return !word.empty() && std::ranges::any_of(word, is_digit) &&
         word.find_first_not_of("0123456789+-.,'eE ") == std::string_view::npos && word.front() != 'e' &&
         word.front() != 'E';
}

struct Layout {
  char between = 0;
  NumberStyle numbers;
};

// Returns the separator of words. REQUIRES: lines that begin points.
char separator_of(std::span<const std::string> lines) {
  const auto share = [&](auto&& has) {
    return 2 * static_cast<std::size_t>(std::ranges::count_if(lines, has)) > lines.size();
  };
  const auto several = [&](char c) {
    return share([&](const std::string& line) { return std::ranges::count(line, c) >= 2; });
  };
  if (several(';')) return ';';
  if (several('\t')) return '\t';
  // A comma between two digits belongs to a number if blanks separate words.
  const bool blanks = several(' ');
  const bool inner = std::ranges::all_of(lines, [](const std::string& line) {
    for (std::size_t k = 0; k < line.size(); ++k)
      if (line[k] == ',' && (k == 0 || k + 1 == line.size() || !is_digit(line[k - 1]) || !is_digit(line[k + 1])))
        return false;
    return true;
  });
  const bool commas = std::ranges::any_of(lines, [](const std::string& line) { return line.find(',') < line.size(); });
  const bool apostrophes =
      std::ranges::any_of(lines, [](const std::string& line) { return line.find('\'') < line.size(); });
  if (blanks && (commas ? inner : apostrophes)) return ' ';
  return several(',') ? ',' : 0;
}

Layout layout_of(std::span<const std::string> lines) {
  Layout layout{separator_of(lines), {}};
  if (layout.between == 0) return layout;
  if (layout.between == ',') {
    // Commas alone separate numbers, unless no number has a point and every other one looks like a fraction.
    const auto no_point = [](const std::string& line) {
      return line.find('.') == std::string::npos && line.find(' ') == std::string::npos;
    };
    const bool whole = std::ranges::all_of(lines, no_point);
    std::size_t fields = 0;
    bool fractions = whole && !lines.empty();
    bool leading_zero = false;
    for (const std::string& line : lines) {
      Words words;
      TextColumns{.between = ','}.split(line, words);
      if (fields == 0) fields = words.size();
      fractions = fractions && words.size() == fields && fields >= 6 && fields % 2 == 0;
      for (std::size_t k = 1; fractions && k < words.size(); k += 2) {
        fractions = words[k].size() == words[1].size() && words[k].size() >= 2;
        leading_zero |= words[k].starts_with('0');
      }
    }
    if (fractions && leading_zero)
      ask(lines, "whether commas stand between its numbers or in them is not clear",
          "export it with points in its numbers");
  }
  // Takes the simplest style that reads all words.
  std::array<bool, kStyles.size()> reads{};
  reads.fill(true);
  TextColumns columns{.between = layout.between};
  Words words;
  for (const std::string& line : lines) {
    columns.split(line, words);
    for (const std::string_view word : words)
      if (looks_numeric(word))
        for (std::size_t s = 0; s < kStyles.size(); ++s) reads[s] = reads[s] && kStyles[s].value(word).has_value();
  }
  const auto first = static_cast<std::size_t>(std::ranges::find(reads, true) - reads.begin());
  if (first == kStyles.size()) return {0, {}};  // lines are read as usual, as far as they can
  if (kStyles[first].decimal == ',' && !kStyles[first].thousands && reads[2])
    ask(lines, "whether its commas stand before decimals or between thousands is not clear",
        "export it with points before decimals");
  layout.numbers = kStyles[first];
  return layout;
}

enum class Role { x, y, z, degrees, other };

struct Title {
  Role role = Role::other;
  double metres = 0;
  bool direction = false;  // named east or north, not by the letter of an axis, which geodesists may swap
};

// Returns true if these look like northings before eastings: UTM and the like, Gauss-Krueger of zones 2 to 4 (the zone
// leads the easting), Swiss LV95, or Krovak.
bool north_first(double a, double b) {
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  return (within(a, 2.6e6, 1e7) && within(b, 1e5, 9e5)) || (within(a, 5.2e6, 6.2e6) && within(b, 2.3e6, 4.7e6)) ||
         (within(a, 1.07e6, 1.3e6) && within(b, 2.48e6, 2.84e6)) || (a < -9e5 && within(b, -9.1e5, -4e5));
}
constexpr const char* kGiveOrder = "give the setting columns, e.g. y,x,z where northings come first, or x,y,z";

Title title_of(std::string_view word) {
  std::string name = lower_case(word_itself(word));
  while (!name.empty() && (name.front() == '#' || name.front() == '/' || name.front() == '%')) name.erase(0, 1);
  Title title;
  // Takes a unit in brackets or behind an underscore.
  const std::size_t bracket = name.find_first_of("[(");
  std::string unit;
  if (bracket != std::string::npos) {
    unit = name.substr(bracket + 1, name.find_first_of("])", bracket) - bracket - 1);
    name.resize(bracket);
  } else if (const std::size_t line = name.rfind('_'); line != std::string::npos && line > 0) {
    unit = name.substr(line + 1);
  }
  struct Unit {
    std::string_view name;
    double metres;
  };
  constexpr std::array kUnits{Unit{"m", 1},       Unit{"cm", 0.01},     Unit{"mm", 0.001},
                              Unit{"ft", 0.3048}, Unit{"feet", 0.3048}, Unit{"usft", 1200.0 / 3937},
                              Unit{"in", 0.0254}, Unit{"inch", 0.0254}};
  if (const auto found = std::ranges::find(kUnits, unit, &Unit::name); found != kUnits.end()) {
    title.metres = found->metres;
    if (bracket == std::string::npos) name.resize(name.rfind('_'));
  }
  std::erase_if(name, [](char c) { return c == ' ' || c == '_' || c == '-' || c == '.' || c == ':'; });
  constexpr std::array kX{
      std::string_view("x"),          std::string_view("east"),       std::string_view("easting"),
      std::string_view("eastings"),   std::string_view("e"),          std::string_view("rechts"),
      std::string_view("rechtswert"), std::string_view("ost"),        std::string_view("ostwert"),
      std::string_view("est"),        std::string_view("xcoord"),     std::string_view("xcoordinate"),
      std::string_view("coordx"),     std::string_view("posx"),       std::string_view("positionx"),
      std::string_view("px"),         std::string_view("cartesianx"), std::string_view("points0")};
  constexpr std::array kY{
      std::string_view("y"),         std::string_view("north"),      std::string_view("northing"),
      std::string_view("northings"), std::string_view("n"),          std::string_view("hoch"),
      std::string_view("hochwert"),  std::string_view("nord"),       std::string_view("nordwert"),
      std::string_view("norte"),     std::string_view("ycoord"),     std::string_view("ycoordinate"),
      std::string_view("coordy"),    std::string_view("posy"),       std::string_view("positiony"),
      std::string_view("py"),        std::string_view("cartesiany"), std::string_view("points1")};
  constexpr std::array kZ{std::string_view("z"),           std::string_view("height"), std::string_view("elevation"),
                          std::string_view("elev"),        std::string_view("h"),      std::string_view("hoehe"),
                          std::string_view("h\xC3\xB6he"), std::string_view("alt"),    std::string_view("altitude"),
                          std::string_view("level"),       std::string_view("rl"),     std::string_view("zcoord"),
                          std::string_view("zcoordinate"), std::string_view("coordz"), std::string_view("posz"),
                          std::string_view("positionz"),   std::string_view("pz"),     std::string_view("cartesianz"),
                          std::string_view("points2")};
  constexpr std::array kDegrees{std::string_view("lat"),  std::string_view("latitude"), std::string_view("lon"),
                                std::string_view("long"), std::string_view("lng"),      std::string_view("longitude")};
  const auto is_in = [&](const auto& names) { return std::ranges::find(names, name) != names.end(); };
  title.role = is_in(kX)         ? Role::x
               : is_in(kY)       ? Role::y
               : is_in(kZ)       ? Role::z
               : is_in(kDegrees) ? Role::degrees
                                 : Role::other;
  title.direction = name.find_first_of("xy01") == std::string::npos;
  return title;
}

// Returns the median coordinate along an axis.
double middle_of(std::span<const std::string> lines, const TextColumns& columns, std::size_t axis) {
  std::vector<double> values;
  Words words;
  for (const std::string& line : lines) {
    columns.split(line, words);
    if (columns.place[axis] >= words.size()) continue;
    if (const auto value = columns.numbers.value(words[columns.place[axis]])) values.push_back(*value);
  }
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// Finds the places of x, y and z by the titles in a line; empty if it does not name all three once.
std::optional<TextColumns> by_titles(std::span<const std::string> lines, const std::string& line, Layout layout) {
  TextColumns out{.between = layout.between, .numbers = layout.numbers};
  Words words;
  std::string text = line;
  if (const std::size_t begin = text.find_first_not_of("#/% \t"); begin != std::string::npos) text.erase(0, begin);
  Words values;
  out.split(lines.front(), values);
  out.split(text, words);
  if (words.size() != values.size()) TextColumns{}.split(text, words);  // titles may be separated by blanks alone
  if (words.size() > values.size()) return {};                          // prose
  std::array<int, 3> found{};
  bool directions = false;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const Title title = title_of(words[k]);
    if (title.role == Role::degrees)
      throw Refused("its columns are degrees of latitude and longitude; project them to metres, e.g. UTM");
    if (title.role == Role::other) continue;
    const auto axis = static_cast<std::size_t>(title.role);
    directions = directions || (title.role != Role::z && title.direction);
    if (++found[axis] > 1) return {};
    out.place[axis] = k;
    if (title.metres > 0 && out.metres > 0 && title.metres != out.metres)
      ask(lines, "its columns have several units", "export it in metres");
    if (title.metres > 0) out.metres = title.metres;
  }
  if (found[0] + found[1] == 2 && found[2] == 0 && words.size() >= 3)
    ask(lines, "none of its columns is titled as a height", kGiveColumns);
  if (found != std::array{1, 1, 1}) return {};
  if (!directions && north_first(middle_of(lines, out, 0), middle_of(lines, out, 1)))
    ask(lines, "which of its columns is east is not clear: the one titled x could be northings", kGiveOrder);
  return out;
}

struct Column {
  std::size_t numbers = 0;
  bool whole = true, rising = true, by_one = true;
  double low = 0, high = 0, last = 0;

  void add(double value, bool has_point) {
    if (numbers > 0) rising = rising && value > last, by_one = by_one && value == last + 1;
    low = numbers > 0 ? std::min(low, value) : value, high = numbers > 0 ? std::max(high, value) : value;
    last = value;
    whole = whole && !has_point;
    ++numbers;
  }
  double middle() const { return 0.5 * (low + high); }
};

// Recognises the columns by the values of points alone.
TextColumns by_values(std::span<const std::string> points, Layout layout) {
  TextColumns out{.between = layout.between, .numbers = layout.numbers};
  const bool quotes = points.front().find('"') != std::string::npos;
  if (out.numbers.decimal == '.' && !out.numbers.thousands && !quotes)
    out.between = 0;  // usual words need no such care
  std::vector<Column> columns;
  Words words;
  for (const std::string& line : points) {
    out.split(line, words);
    if (columns.size() < words.size()) columns.resize(words.size());
    for (std::size_t k = 0; k < words.size(); ++k)
      if (const auto value = layout.numbers.value(words[k]))
        columns[k].add(*value, words[k].find_first_of(layout.numbers.decimal) != std::string_view::npos);
  }
  const auto numeric = [&](std::size_t k) { return 10 * columns[k].numbers > 9 * points.size(); };
  std::size_t first = 0;
  while (first + 3 < columns.size() && !numeric(first)) ++first;  // names of points
  const auto decimals = [&](std::size_t from) {
    if (from + 3 > columns.size()) return false;
    return std::all_of(columns.begin() + static_cast<std::ptrdiff_t>(from),
                       columns.begin() + static_cast<std::ptrdiff_t>(from + 3),
                       [&](const Column& c) { return !c.whole && c.numbers > 0; });
  };
  const auto at = [&](std::size_t k) -> const Column& { return columns[first + k]; };
  std::size_t rest = columns.size() - first;
  constexpr std::size_t kFew = 20;
  if (rest >= 4 && points.size() >= kFew) {
    std::size_t whole = 0;
    while (whole + 3 < rest && numeric(first + whole) && at(whole).whole) ++whole;
    if (at(0).whole && at(0).by_one && !decimals(first)) {
      first += 1, rest -= 1;  // numbered points
    } else if (whole > 0 && decimals(first + whole)) {
      first += whole, rest -= whole;  // intensities or colours
    } else if (decimals(first) && !at(3).whole) {
      const bool share = at(0).low >= 0 && at(0).high <= 1 && (at(3).low < 0 || at(3).high > 1);
      constexpr double kTime = 1e5;
      const bool time = at(0).rising && at(0).low > kTime && at(3).low < at(0).low;
      if (share || time)
        ask(points,
            "which of its columns are x, y and z is not clear: the first one could be " +
                std::string(share ? "an intensity" : "a time"),
            kGiveColumns);
    }
  }
  // Swapped columns would mirror the site.
  if (rest >= 3 && points.size() >= kFew && north_first(at(0).middle(), at(1).middle()))
    ask(points, "which of its columns are x, y and z is not clear: the first one could be northings", kGiveOrder);
  if (first > 0) {
    out.place = {first, first + 1, first + 2};
    out.note = "its columns " + std::to_string(first + 1) + " to " + std::to_string(first + 3) +
               " are taken as x, y and z; the setting columns tells others";
  }
  return out;
}

TextColumns as_told(std::span<const std::string> lines, const std::string& told, Layout layout) {
  TextColumns out{.between = layout.between, .numbers = layout.numbers};
  std::array<int, 3> found{};
  Words words;
  TextColumns{}.split(told, words);
  for (std::size_t k = 0; k < words.size(); ++k) {
    const Role role = title_of(words[k]).role;
    if (role == Role::other || role == Role::degrees) continue;
    const auto axis = static_cast<std::size_t>(role);
    ++found[axis];
    out.place[axis] = k;
  }
  if (found != std::array{1, 1, 1})
    ask(lines, "the setting columns=" + told + " does not name x, y and z once each", kGiveColumns);
  std::array<std::size_t, 3> numbers{};
  for (const std::string& line : lines) {
    out.split(line, words);
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (out.place[axis] < words.size() && out.numbers.value(words[out.place[axis]])) ++numbers[axis];
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (2 * numbers[axis] < lines.size())
      ask(lines,
          "the setting columns=" + told + " names column " + std::to_string(out.place[axis] + 1) + " " +
              std::string(1, "xyz"[axis]) + ", and most lines have no number there",
          kGiveColumns);
  return out;
}

}  // namespace

std::optional<double> NumberStyle::value(std::string_view word) const {
  if (decimal == '.' && !thousands) return number_of(word);
  std::string plain;
  std::string_view body = word;
  if (body.starts_with('+') || body.starts_with('-')) body.remove_prefix(1);
  const std::size_t exponent = std::min(body.find_first_of("eE"), body.size());
  const std::size_t mark = std::min(body.substr(0, exponent).find(decimal), exponent);
  const std::string_view whole = body.substr(0, mark);
  if (!thousands && whole.find_first_not_of("0123456789") != std::string_view::npos) return {};
  if (thousands && (whole.empty() || !grouped(whole, decimal))) return {};
  if (word.starts_with('-')) plain += '-';
  for (const char c : whole)
    if (is_digit(c)) plain += c;
  if (mark < exponent) {
    const std::string_view fraction = body.substr(mark + 1, exponent - mark - 1);
    if (fraction.find_first_not_of("0123456789") != std::string_view::npos) return {};
    plain += '.';
    plain += fraction;
  }
  plain += body.substr(exponent);
  return number_of(plain);
}

void TextColumns::split(std::string_view line, std::vector<std::string_view>& words) const {
  words.clear();
  if (between == 0 || between == ' ') {
    constexpr std::string_view kAny = " \t,;", kOnlyBlanks = " \t";
    const std::string_view marks = between == 0 ? kAny : kOnlyBlanks;
    for (std::size_t at = line.find_first_not_of(marks); at < line.size();) {
      const std::size_t end = std::min(line.find_first_of(marks, at), line.size());
      words.push_back(word_itself(line.substr(at, end - at)));
      at = line.find_first_not_of(marks, end);
    }
    return;
  }
  for (;;) {
    const std::size_t first = std::min(line.find_first_not_of(kBlanks), line.size());
    const std::size_t closing = first < line.size() && line[first] == '"' ? line.find('"', first + 1) : 0;
    const std::size_t end = line.find(between, closing == std::string_view::npos ? 0 : closing);
    words.push_back(word_itself(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

TextColumns columns_of(std::span<const std::string> lines, const std::string& told) {
  // A line of a point has three words or more that look like numbers, and no more others than these.
  std::vector<std::string> points;
  std::vector<std::string> titles;
  for (const std::string& line : lines) {
    std::size_t numeric = 0, other = 0;
    std::string_view rest = line;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest))
      ++(looks_numeric(without_quotes(word)) ? numeric : other);
    const bool comment = line.starts_with('#') || line.starts_with("//") || line.starts_with('%');
    if (!comment && numeric >= 3 && numeric >= other)
      points.push_back(line);
    else if (points.empty())
      titles.push_back(line);
  }
  if (points.empty()) return {};
  const Layout layout = layout_of(points);
  if (!told.empty()) return as_told(points, told, layout);
  for (auto title = titles.rbegin(); title != titles.rend(); ++title)
    if (auto named = by_titles(points, *title, layout)) {
      if (named->place != std::array<std::size_t, 3>{0, 1, 2})
        named->note = "by its titles, x is column " + std::to_string(named->place[0] + 1) + ", y " +
                      std::to_string(named->place[1] + 1) + " and z " + std::to_string(named->place[2] + 1);
      return *named;
    }
  return by_values(points, layout);
}

}  // namespace vantage::importer
