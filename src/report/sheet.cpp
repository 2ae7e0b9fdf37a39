// SPDX-License-Identifier: Apache-2.0
#include "report/sheet.hpp"

#include <algorithm>

namespace vantage {

void Sheet::heading(const std::string& text) {
  canvas->text({kMargin, y + 10}, text, {.size = 13, .bold = true});
  y += 28;
}

void Sheet::words(double x, const std::string& text, const TextStyle& style, double end) {
  if (end == 0) end = right();
  std::string line;
  const auto put = [&] {
    canvas->text({x, y}, line, style);
    y += kLine;
    line.clear();
  };
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t stop = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, stop - at), longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && canvas->text_width(longer, style) > end - x)
      put(), line = word;
    else
      line = longer;
    at = stop + 1;
  }
  if (!line.empty()) put();
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

void write_table(std::vector<Sheet>& sheets, const Paper& paper, const std::vector<SheetColumn>& columns,
                 std::size_t rows, std::size_t most, const std::string& where,
                 const std::function<std::vector<std::string>(std::size_t)>& cells) {
  const auto line = [&](const std::vector<std::string>& texts, TextStyle style) {
    Sheet& sheet = sheets.back();
    double x = Sheet::kMargin;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      style.across = columns[c].across;
      const double at = columns[c].across == Align::end ? x + columns[c].width - 8 : x;
      sheet.canvas->text({at, sheet.y}, fitted(*sheet.canvas, texts[c], columns[c].width - 8, style), style);
      x += columns[c].width;
    }
    sheet.y += Sheet::kLine;
  };
  std::vector<std::string> titles;
  for (const SheetColumn& column : columns) titles.push_back(column.title);
  const auto head = [&] {
    line(titles, {.size = 8.5, .bold = true, .colour = kFaintInk});
    sheets.back().rule();
  };
  head();
  for (std::size_t k = 0; k < std::min(rows, most); ++k) {
    if (sheets.back().left() < Sheet::kLine) {
      sheets.emplace_back(paper);
      head();
    }
    line(cells(k), {.size = 9});
  }
  if (rows > most)
    sheets.back().words(Sheet::kMargin, "and " + std::to_string(rows - most) + " more: " + where,
                        {.size = 9, .colour = kFaintInk});
  sheets.back().y += 14;
}

}  // namespace vantage
