// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "core/text.hpp"
#include "export/chart.hpp"
#include "export/missed_colours.hpp"
#include "export/pictures.hpp"
#include "report/report.hpp"
#include "vantage/summary.hpp"
#include "vantage/version.hpp"

namespace vantage {
namespace {

constexpr double kWidth = 595, kHeight = 842, kMargin = 48, kLine = 15;  // A4, in points
constexpr Colour kFaint{0.36, 0.38, 0.42}, kRule{0.80, 0.81, 0.83}, kAlert{0.72, 0.12, 0.12};

std::string percent(double share) { return fixed(100 * share, 1) + " %"; }

// A sheet, written from the top.
struct Sheet {
  std::unique_ptr<Canvas> canvas = std::make_unique<Canvas>(kWidth, kHeight);
  double y = kMargin;

  double left() const { return kHeight - kMargin - y; }
  void heading(const std::string& text) {
    canvas->text({kMargin, y + 10}, text, {.size = 13, .bold = true});
    y += 28;
  }
  // Writes text in lines no wider than the sheet.
  void words(double x, const std::string& text, const TextStyle& style) {
    std::string line;
    const auto put = [&] {
      canvas->text({x, y}, line, style);
      y += kLine;
      line.clear();
    };
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find(' ', at), text.size());
      const std::string word = text.substr(at, end - at), longer = line.empty() ? word : line + " " + word;
      if (!line.empty() && canvas->text_width(longer, style) > kWidth - kMargin - x)
        put(), line = word;
      else
        line = longer;
      at = end + 1;
    }
    if (!line.empty()) put();
  }
  void rule() { canvas->line({kMargin, y - 8}, {kWidth - kMargin, y - 8}, {.colour = kRule, .width = 0.6}); }
};

// Text shortened to a width, with an ellipsis.
std::string fitted(const Canvas& canvas, std::string text, double width, const TextStyle& style) {
  if (canvas.text_width(text, style) <= width) return text;
  while (!text.empty() && canvas.text_width(text + "…", style) > width) {
    while (text.size() > 1 && (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80) text.pop_back();
    text.pop_back();
  }
  return text + "…";
}

struct Column {
  std::string title;
  double width;
  Align across = Align::end;
};

// Writes as many rows as fit; a line tells how many more there are, and where.
void table(Sheet& sheet, const std::vector<Column>& columns, std::size_t rows, const std::string& where,
           const std::function<std::vector<std::string>(std::size_t)>& cells) {
  const auto line = [&](const std::vector<std::string>& texts, TextStyle style) {
    double x = kMargin;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      style.across = columns[c].across;
      const double at = columns[c].across == Align::end ? x + columns[c].width - 8 : x;
      sheet.canvas->text({at, sheet.y}, fitted(*sheet.canvas, texts[c], columns[c].width - 8, style), style);
      x += columns[c].width;
    }
    sheet.y += kLine;
  };
  std::vector<std::string> titles;
  for (const Column& column : columns) titles.push_back(column.title);
  line(titles, {.size = 8.5, .bold = true, .colour = kFaint});
  sheet.rule();
  const auto room = static_cast<std::size_t>(std::max(0.0, sheet.left() / kLine - 1));
  for (std::size_t k = 0; k < std::min(rows, room); ++k) line(cells(k), {.size = 9});
  if (rows > room)
    sheet.words(kMargin, "and " + std::to_string(rows - room) + " more: " + where, {.size = 9, .colour = kFaint});
  sheet.y += 14;
}

Sheet summary_sheet(const Report& report, const Simulator& simulator, const SearchArea& area) {
  const Evaluation& network = report.shown();
  Sheet sheet;
  sheet.canvas->text({kMargin, sheet.y + 8},
                     fitted(*sheet.canvas, report.options.title, kWidth - 2 * kMargin, {.size = 22, .bold = true}),
                     {.size = 22, .bold = true});
  sheet.y += 32;
  sheet.words(kMargin, "Laser scanning survey plan: " + report.question, {.size = 10, .colour = kFaint});
  sheet.y += 14;
  std::vector<SummaryLine> lines = summary_lines(network, report.requirements);
  lines.insert(lines.end(), report.ground.begin(), report.ground.end());
  for (const auto& [heading, text] : lines) {
    sheet.canvas->text({kMargin, sheet.y}, heading,
                       {.size = 10, .bold = true, .colour = heading == "to do" ? kAlert : Colour{0.15, 0.15, 0.17}});
    sheet.words(kMargin + 68, text, {.size = 10});
    sheet.y += 2;
  }
  sheet.y += 10;
  std::span<const StationError> errors;
  if (network.registration) errors = network.registration->stations;
  const StationLinks links = network.links().value_or(StationLinks{.least = network.link_overlap});
  const auto pages = plan_view_pictures({.scene = simulator.scene(),
                                         .area = area,
                                         .stations = network.stations,
                                         .names = station_names(network.stations, network.names),
                                         .links = links,
                                         .title = "Plan",
                                         .errors = errors});
  const Canvas& plan = *pages.front().canvas;
  const double scale = std::min((kWidth - 2 * kMargin) / plan.width(), sheet.left() / plan.height());
  sheet.canvas->page({kMargin, sheet.y, plan.width() * scale, plan.height() * scale}, plan);
  sheet.y += plan.height() * scale + 24;
  return sheet;
}

void stations_table(Sheet& sheet, const Evaluation& network, const std::vector<std::string>& names) {
  const std::vector<std::uint64_t>& points = network.counts.points_on_surveyed;
  sheet.heading("Stations");
  sheet.words(kMargin, "Survey frame, metres. The head is the scanner's; the ground is where the tripod stands.",
              {.size = 9, .colour = kFaint});
  sheet.y += 6;
  table(sheet,
        {{"Name", 66, Align::start},
         {"x (m)", 74},
         {"y (m)", 74},
         {"head z (m)", 74},
         {"ground z (m)", 82},
         {"points on site", 86},
         {"", 43, Align::start}},
        network.stations.size(), "stations.csv has all", [&](std::size_t k) -> std::vector<std::string> {
          const PlacedStation& s = network.stations[k];
          const std::string note = s.kept ? "kept" : active(s) ? "" : "left out";
          if (s.status == StationStatus::hole) return {names[k], "", "", "", "", "", "no ground"};
          return {names[k],
                  fixed(s.position.x, 3),
                  fixed(s.position.y, 3),
                  fixed(s.position.z, 3),
                  fixed(s.ground.z, 3),
                  network.exact && k < points.size() ? grouped(points[k]) : "",
                  note};
        });
}

struct Link {
  std::size_t a, b;
  double value;
  bool bridge;
};

// The most important first: bridges, then the weakest.
std::vector<Link> links_of(const StationLinks& network) {
  std::vector<Link> links;
  const Connectivity graph = connectivity(network.values, network.least);
  for (std::size_t i = 0; i < network.values.size(); ++i)
    for (std::size_t j = i + 1; j < network.values.size(); ++j)
      if (const double value = network.values(i, j); value > 0 && value >= network.least)
        links.push_back({i, j, value, std::ranges::count(graph.bridges, std::pair(i, j)) > 0});
  std::ranges::stable_sort(
      links, [](const Link& l, const Link& r) { return l.bridge != r.bridge ? l.bridge : l.value < r.value; });
  return links;
}

void links_table(Sheet& sheet, const StationLinks& network, const std::vector<Link>& links,
                 const std::vector<std::string>& names) {
  const std::string measure = to_string(network.measure);
  sheet.heading("Links");
  sheet.words(kMargin,
              "Pairs of stations with " + measure + " of at least " + number(network.least) +
                  ". Bridges, the only link between two parts, come first, then the weakest.",
              {.size = 9, .colour = kFaint});
  sheet.y += 6;
  if (links.empty()) return sheet.words(kMargin, "No two stations are linked.", {.size = 10, .colour = kAlert});
  table(sheet, {{"From", 90, Align::start}, {"To", 90, Align::start}, {measure, 90}, {"", 200, Align::start}},
        links.size(), "report.html has all", [&](std::size_t k) -> std::vector<std::string> {
          const Link& link = links[k];
          std::string note = link.bridge ? "bridge" : "";
          if (network.weakest == std::pair(link.a, link.b))
            note += std::string(note.empty() ? "" : ", ") + "weakest that all hang by";
          return {names[link.a], names[link.b], percent(link.value), note};
        });
}

void missed_table(Sheet& sheet, const std::vector<MissedShare>& shares) {
  sheet.heading("What is missed, and why");
  const MissedShare& all = shares.front();
  double at = kMargin;
  const double width = kWidth - 2 * kMargin;
  for (const MissedStyle& style : kMissedStyles) {
    const double part = width * all.share(style.why);
    sheet.canvas->fill({at, sheet.y, part, 16}, style.colour);
    at += part;
  }
  sheet.y += 30;
  at = kMargin;
  for (const MissedStyle& style : kMissedStyles) {
    const std::string text = std::string(style.words) + " " + percent(all.share(style.why));
    const double room = 22 + sheet.canvas->text_width(text, {.size = 9});
    if (at + room > kWidth - kMargin) at = kMargin, sheet.y += kLine;
    sheet.canvas->fill({at, sheet.y - 5, 10, 10}, style.colour);
    sheet.canvas->text({at + 14, sheet.y}, text, {.size = 9});
    at += room + 10;
  }
  sheet.y += 26;
  std::vector<const MissedShare*> nodes;
  for (std::size_t k = 1; k < shares.size(); ++k) nodes.push_back(&shares[k]);
  std::ranges::stable_sort(nodes, std::ranges::greater{}, [](const MissedShare* s) {
    return static_cast<double>(s->voxels) * (1 - s->share(WhyMissed::captured));
  });
  const auto share = [](const MissedShare& s, WhyMissed why) { return fixed(100 * s.share(why), 1); };
  table(sheet,
        {{"Mesh, shares in %", 135, Align::start},
         {"dense enough", 66},
         {"not chosen", 72},
         {"hidden", 50},
         {"too far", 50},
         {"too flat", 50},
         {"too sparse", 60}},
        nodes.size(), "missed.csv has all", [&](std::size_t k) -> std::vector<std::string> {
          const MissedShare& s = *nodes[k];
          return {s.node,
                  share(s, WhyMissed::captured),
                  share(s, WhyMissed::not_chosen),
                  share(s, WhyMissed::hidden),
                  share(s, WhyMissed::far),
                  share(s, WhyMissed::flat),
                  share(s, WhyMissed::sparse)};
        });
}

}  // namespace

void write_report_pdf(const std::filesystem::path& file, const Report& report, const Simulator& simulator,
                      const SearchArea& area) {
  const Evaluation& network = report.shown();
  const std::vector<std::string> names = station_names(network.stations, network.names);
  std::vector<Sheet> sheets;
  sheets.push_back(summary_sheet(report, simulator, area));
  // Continues on the previous sheet if all of it fits there.
  const auto sheet_for = [&](std::size_t rows) -> Sheet& {
    if (sheets.back().left() < 90 + kLine * static_cast<double>(rows)) sheets.emplace_back();
    return sheets.back();
  };
  stations_table(sheet_for(network.stations.size()), network, names);
  if (const auto links = network.links()) {
    const std::vector<Link> rows = links_of(*links);
    links_table(sheet_for(rows.size()), *links, rows, names);
  }
  if (report.options.missed && !report.options.missed->shares.empty()) {
    Sheet missed;
    missed_table(missed, report.options.missed->shares);
    sheets.push_back(std::move(missed));
  }
  std::vector<std::unique_ptr<Canvas>> pages;
  for (Sheet& sheet : sheets) {
    const double y = kHeight - 26;
    const TextStyle style{.size = 8, .colour = kFaint};
    const std::string page = "vantage " + std::string(version()) + "   " + std::to_string(pages.size() + 1) + " / " +
                             std::to_string(sheets.size());
    const double room = kWidth - 2 * kMargin - sheet.canvas->text_width(page, style) - 20;
    sheet.canvas->text({kMargin, y}, fitted(*sheet.canvas, report.options.command, room, style), style);
    sheet.canvas->text({kWidth - kMargin, y}, page, {.size = 8, .colour = kFaint, .across = Align::end});
    pages.push_back(std::move(sheet.canvas));
  }
  Canvas::save_pages(file, pages, report.options.title);
}

}  // namespace vantage
