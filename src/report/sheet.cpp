// SPDX-License-Identifier: Apache-2.0
#include "report/sheet.hpp"

#include <algorithm>
#include <utility>

namespace vantage {
namespace {

// Breaks text at spaces into lines no wider than `width`; a longer word is a line of its own.
std::vector<std::string> wrapped(const Canvas& canvas, const std::string& text, double width, const TextStyle& style) {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t stop = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, stop - at), longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && canvas.text_width(longer, style) > width)
      lines.push_back(std::move(line)), line = word;
    else
      line = longer;
    at = stop + 1;
  }
  if (!line.empty()) lines.push_back(std::move(line));
  return lines;
}

constexpr double kBetween = 12, kLeastWords = 40, kSmallestText = 5.5, kFurtherLine = 11;  // points
constexpr TextStyle kCell{.size = 9}, kTitle{.size = 8.5, .bold = true, .colour = kFaintInk};

// Widths of a table's columns, and the size of its letters relative to the usual one.
struct TableWidths {
  std::vector<double> columns;
  double letters = 1;
};
TableWidths widths_of(const Canvas& canvas, double room, const std::vector<SheetColumn>& columns,
                      const std::vector<std::vector<std::string>>& rows) {
  TableWidths widths;
  double numbers = 0, words = 0, least_words = 0;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    double widest = canvas.text_width(columns[c].title, kTitle);
    for (const std::vector<std::string>& row : rows) widest = std::max(widest, canvas.text_width(row[c], kCell));
    widths.columns.push_back(widest + kBetween);
    if (columns[c].across == Align::end)
      numbers += widths.columns.back();
    else
      words += widths.columns.back(), least_words += std::min(widths.columns.back(), kLeastWords);
  }
  // Numbers are never broken: letters get smaller if numbers alone are too wide.
  if (numbers + least_words > room) {
    widths.letters = std::max(kSmallestText / kCell.size, room / (numbers + least_words));
    for (double& width : widths.columns) width *= widths.letters;
    numbers *= widths.letters, words *= widths.letters;
  }
  // Narrow columns of words keep their width, the wider ones share the rest.
  double left = room - numbers, wanted = words;
  bool taken = wanted > left;
  std::vector<bool> kept(columns.size(), false);
  while (taken) {
    taken = false;
    const auto open = static_cast<double>(
        std::count_if(columns.begin(), columns.end(), [](const SheetColumn& one) { return one.across != Align::end; }) -
        std::count(kept.begin(), kept.end(), true));
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (columns[c].across == Align::end || kept[c] || widths.columns[c] > left / open) continue;
      kept[c] = taken = true;
      left -= widths.columns[c];
      break;
    }
    if (taken) continue;
    for (std::size_t c = 0; c < columns.size(); ++c)
      if (columns[c].across != Align::end && !kept[c]) widths.columns[c] = left / open;
  }
  return widths;
}

}  // namespace

void Sheet::heading(const std::string& text) {
  canvas->text({kMargin, y + 10}, text, {.size = 13, .bold = true});
  y += 28;
}

void Sheet::words(double x, const std::string& text, const TextStyle& style, double end) {
  for (const std::string& line : wrapped(*canvas, text, (end == 0 ? right() : end) - x, style)) {
    canvas->text({x, y}, line, style);
    y += kLine;
  }
}

void Sheet::rule() { canvas->line({kMargin, y - 8}, {right(), y - 8}, {.colour = kRuleInk, .width = 0.6}); }

std::string fitted(const Canvas& canvas, std::string text, double width, const TextStyle& style) {
  if (canvas.text_width(text, style) <= width) return text;
  while (!text.empty() && canvas.text_width(text + "…", style) > width) {
    while (text.size() > 1 && (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80) text.pop_back();
    text.pop_back();
  }
  return text + "…";
}

double fitting_size(const Canvas& canvas, const std::string& text, double width, const TextStyle& style) {
  const double wide = canvas.text_width(text, style);
  return wide <= width ? style.size : std::max(kSmallestText, style.size * width / wide);
}

void write_table(std::vector<Sheet>& sheets, const Paper& paper, const std::vector<SheetColumn>& columns,
                 std::size_t rows, std::size_t most, const std::string& where,
                 const std::function<std::vector<std::string>(std::size_t)>& cells) {
  std::vector<std::vector<std::string>> shown;
  for (std::size_t k = 0; k < std::min(rows, most); ++k) shown.push_back(cells(k));
  const TableWidths widths = widths_of(*sheets.back().canvas, sheets.back().right() - Sheet::kMargin, columns, shown);
  using Lines = std::vector<std::vector<std::string>>;  // of each cell
  const auto lines_of = [&](const std::vector<std::string>& texts, const TextStyle& style) {
    Lines lines;
    for (std::size_t c = 0; c < columns.size(); ++c)
      lines.push_back(columns[c].across == Align::end
                          ? std::vector{texts[c]}
                          : wrapped(*sheets.back().canvas, texts[c], widths.columns[c] - kBetween / 2, style));
    return lines;
  };
  const auto height = [](const Lines& lines) {
    std::size_t most_lines = 1;
    for (const auto& cell : lines) most_lines = std::max(most_lines, cell.size());
    return Sheet::kLine + static_cast<double>(most_lines - 1) * kFurtherLine;
  };
  const auto put = [&](const Lines& lines, TextStyle style) {
    Sheet& sheet = sheets.back();
    double x = Sheet::kMargin;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      style.across = columns[c].across;
      const double at = columns[c].across == Align::end ? x + widths.columns[c] - kBetween * widths.letters : x;
      for (std::size_t k = 0; k < lines[c].size(); ++k)
        sheet.canvas->text({at, sheet.y + static_cast<double>(k) * kFurtherLine},
                           fitted(*sheet.canvas, lines[c][k], widths.columns[c], style), style);
      x += widths.columns[c];
    }
    sheet.y += height(lines);
  };
  TextStyle title = kTitle, cell = kCell;
  title.size *= widths.letters, cell.size *= widths.letters;
  std::vector<std::string> titles;
  for (const SheetColumn& column : columns) titles.push_back(column.title);
  const auto head = [&] {
    put(lines_of(titles, title), title);
    sheets.back().rule();
  };
  head();
  for (const std::vector<std::string>& row : shown) {
    const Lines lines = lines_of(row, cell);
    if (sheets.back().left() < height(lines)) {
      sheets.emplace_back(paper);
      head();
    }
    put(lines, cell);
  }
  if (rows > most)
    sheets.back().words(Sheet::kMargin, "and " + std::to_string(rows - most) + " more: " + where,
                        {.size = 9, .colour = kFaintInk});
  sheets.back().y += 14;
}

}  // namespace vantage
