// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/first_numbers.hpp"
#include "core/parallel.hpp"
#include "core/tenths.hpp"
#include "core/text.hpp"
#include "map/chart.hpp"
#include "map/missed_colours.hpp"
#include "map/pictures.hpp"
#include "map/shown_links.hpp"
#include "report/field_sheets.hpp"
#include "report/report.hpp"
#include "report/sheet.hpp"
#include "report/station_facts.hpp"
#include "vantage/image.hpp"
#include "vantage/summary.hpp"
#include "vantage/version.hpp"

namespace vantage {
namespace {

// Draws the logo at the right of the head, no wider and higher than kWidth and kHeight.
void draw_logo(Sheet& sheet, const std::filesystem::path& file) {
  constexpr double kWidth = 130, kHeight = 52;
  const Image logo = read_image(file);
  if (logo.width == 0 || logo.height == 0) return;
  std::vector<std::uint32_t> pixels;
  for (std::size_t k = 0; k + 3 < logo.rgba.size(); k += 4) {
    const std::uint32_t alpha = logo.rgba[k + 3];
    const auto channel = [&](std::size_t c) { return (logo.rgba[k + c] * alpha + 127) / 255; };
    pixels.push_back(alpha << 24 | channel(0) << 16 | channel(1) << 8 | channel(2));
  }
  const double scale = std::min(kWidth / logo.width, kHeight / logo.height);
  sheet.canvas->image({sheet.right() - scale * logo.width, 34, scale * logo.width, scale * logo.height}, pixels,
                      logo.width);
}

// Draws the plan view. If there are several storeys, those with most stations, as far as there is room.
void front_plans(Sheet& sheet, const Report& report, Site& site, const std::stop_token& stop) {
  const Evaluation& network = report.shown();
  std::vector<PlanPage> drawn;
  if (report.plan.empty()) {
    std::span<const StationError> errors;
    if (network.registration) errors = network.registration->stations;
    const StationLinks links = links_to_draw(network);
    drawn = plan_view_pictures({.scene = site.scene(),
                                .area = site.area(),
                                .stations = network.stations,
                                .names = station_names(network.stations, network.names),
                                .links = links,
                                .title = "Stations and links",
                                .errors = errors,
                                .targets = network.targets},
                               stop);
  }
  if (stop.stop_requested()) return;  // the sheet is not kept
  const std::span<const PlanPage> pages = report.plan.empty() ? drawn : report.plan;
  std::vector<const Canvas*> plans;
  for (std::size_t k = pages.size() > 1 ? 1 : 0; k < pages.size(); ++k)
    if (pages[k].canvas) plans.push_back(pages[k].canvas.get());
  const std::vector<PlanLevel> levels = cut_levels(site.scene(), site.area().mesh(), network.stations);
  if (levels.size() == plans.size()) {
    const auto standing = [&](std::size_t k) {
      return std::ranges::count_if(network.stations, [&](const PlacedStation& s) {
        return s.status != StationStatus::hole && levels[k].holds(s.ground.z);
      });
    };
    std::vector<std::size_t> order = first_numbers(plans.size());
    std::ranges::stable_sort(order, std::ranges::greater{}, standing);
    std::vector<const Canvas*> sorted;
    for (const std::size_t k : order) sorted.push_back(plans[k]);
    plans = std::move(sorted);
  }
  for (const Canvas* const plan : plans) {
    const bool first = plan == plans.front();
    const double width = sheet.right() - Sheet::kMargin, whole = width / plan->width();
    if (!first && sheet.left() < whole * plan->height()) break;
    const double scale = std::min(whole, sheet.left() / plan->height());
    sheet.canvas->page({Sheet::kMargin, sheet.y, plan->width() * scale, plan->height() * scale}, *plan);
    sheet.y += plan->height() * scale + 6;
  }
}

Sheet front_sheet(const Report& report, Site& site, const std::stop_token& stop) {
  const Evaluation& network = report.shown();
  const double margin = Sheet::kMargin;
  Sheet sheet(a4());
  double end = sheet.right();
  if (!report.options.logo.empty()) {
    draw_logo(sheet, report.options.logo);
    end -= 150;
  }
  const TextStyle title{.size = 22, .bold = true};
  sheet.canvas->text({margin, sheet.y + 8}, fitted(*sheet.canvas, report.options.title, end - margin, title), title);
  sheet.y += 32;
  if (!report.options.date.empty()) sheet.words(margin, report.options.date, {.size = 10}, end);
  sheet.words(margin, "Laser scanning survey plan: " + report.question, {.size = 10, .colour = kFaintInk}, end);
  sheet.y = std::max(sheet.y, 92.0) + 8;
  const auto line = [&](const std::string& heading, const std::string& text, bool alert) {
    sheet.canvas->text({margin, sheet.y}, heading,
                       {.size = 9.5, .bold = true, .colour = alert ? kAlertInk : style::kInk});
    sheet.words(margin + 72, text, {.size = 9.5});
    sheet.y += 1;
  };
  // Leaves this much room, in points, below the advice.
  constexpr double kLeastLeft = 300;
  std::size_t more = 0;
  std::vector<SummaryLine> lines = summary_lines(network, report.requirements);
  lines.insert(lines.end(), report.ground.begin(), report.ground.end());
  lines.insert(lines.end(), report.again.begin(), report.again.end());
  for (const auto& [heading, text] : lines) {
    if (heading == "to do" && sheet.left() < kLeastLeft)
      ++more;
    else
      line(heading, text, heading == "to do");
  }
  if (more > 0) line("", "and " + std::to_string(more) + " more: report.html has all", true);
  sheet.y += 4;
  sheet.rule();
  sheet.y += 4;
  for (const auto& [heading, text] : report.facts)
    line(heading, text + (heading == "computed" ? "; report.html has every parameter" : ""), false);
  sheet.y += 8;
  front_plans(sheet, report, site, stop);
  return sheet;
}

// Begins a section of `lines` lines: below the last content if the last sheet is A4 and has room for all of it, else on
// a new sheet.
void begin_section(std::vector<Sheet>& sheets, std::size_t lines) {
  constexpr double kHead = 110;
  const Sheet& last = sheets.back();
  const bool fits =
      last.canvas->width() == a4().width && kHead + Sheet::kLine * static_cast<double>(lines) <= last.left();
  if (fits)
    sheets.back().y += 18;
  else
    sheets.emplace_back(a4());
}

// Tables the sessions: who takes which stations, and how long that is.
void sessions_table(std::vector<Sheet>& sheets, const Evaluation& network, const std::vector<std::string>& names) {
  const std::vector<Session>& sessions = network.visit->sessions;
  const std::vector<SheetRound> rounds = sheet_rounds(network);
  const bool batteries = !batteries_of(*network.visit).empty();
  begin_section(sheets, sessions.size());
  Sheet& sheet = sheets.back();
  sheet.heading("Sessions");
  sheet.words(Sheet::kMargin,
              "Each begins and ends at the entrance, at these times of the day; its stations stand in the table of "
              "stations in their order. " +
                  std::string(batteries ? "Batteries: charged ones that it takes. " : "") +
                  "Links: whether its scans hold together by themselves, and with those of other sessions.",
              {.size = 9, .colour = kFaintInk});
  sheet.y += 6;
  std::vector<SheetColumn> columns{{"Session", Align::start},
                                   {"Time"},
                                   {"Stations"},
                                   {"From, to", Align::start},
                                   {"At stations"},
                                   {"Walking"},
                                   {"Walk, m"},
                                   {"In all"},
                                   {"Batteries"},
                                   {"Links", Align::start}};
  constexpr std::size_t kBatteries = 8;  // their column
  if (!batteries) columns.erase(columns.begin() + kBatteries);
  write_table(
      sheets, a4(), columns, sessions.size(), sessions.size(), "", [&](std::size_t k) -> std::vector<std::string> {
        const Session& one = sessions[k];
        const std::vector<std::size_t>& stations = rounds[k].stations;
        std::vector<std::string> cells{rounds[k].name,
                                       clock_text(one.start_min) + "–" + clock_text(one.start_min + one.minutes),
                                       std::to_string(stations.size()),
                                       names[stations.front()] + ", " + names[stations.back()],
                                       minutes_text(one.minutes - one.walk_min - one.waiting_min),
                                       minutes_text(one.walk_min),
                                       fixed(one.walk_m, 0),
                                       minutes_text(one.minutes),
                                       batteries_text(one),
                                       session_links(one, network)};
        if (!batteries) cells.erase(cells.begin() + kBatteries);
        return cells;
      });
}

// Tables all stations, in the order of visiting. `first_map`: number of the first map's sheet.
void stations_table(std::vector<Sheet>& sheets, const Evaluation& network, const std::vector<StationFacts>& facts,
                    const std::vector<std::size_t>& sheet_of, std::size_t first_map) {
  const std::vector<std::uint64_t>& points = network.counts.points_on_surveyed;
  const Paper paper = lying(a4());
  const bool sessions = network.visit && !network.visit->sessions.empty();
  // A tunnel has no corners, so the column may be empty.
  const bool corners = std::ranges::any_of(facts, [](const StationFacts& f) { return !f.corners.empty(); });
  constexpr std::size_t kCorners = 7;  // their column
  std::vector<SheetColumn> columns{{"No."},    {"Station", Align::start},
                                   {"Sheet"},  {"x"},
                                   {"y"},      {"z"},
                                   {"Head"},   {"Corners"},
                                   {"Walk"},   {"Done at"},
                                   {"Points"}, {"Notes", Align::start}};
  if (!corners) columns.erase(columns.begin() + kCorners);
  sheets.emplace_back(paper);
  sheets.back().heading("All stations, in the order of visiting");
  sheets.back().words(
      Sheet::kMargin,
      "Metres. x, y and z are of the ground under the tripod, the head stands so high over it. " +
          std::string(corners ? "Corners: tape distances to the two corners that the map marks. " : "") +
          "Done at: " + std::string(sessions ? "the time of the day" : "since the start of the round") +
          ". Field software "
          "registers each scan to the one before; a station that has no link to that says to which station instead.",
      {.size = 9, .colour = kFaintInk});
  sheets.back().y += 6;
  const auto table = [&](const std::vector<std::size_t>& order) {
    write_table(sheets, paper, columns, order.size(), order.size(), "",
                [&](std::size_t row) -> std::vector<std::string> {
                  const std::size_t k = order[row];
                  const PlacedStation& s = network.stations[k];
                  const StationFacts& f = facts[k];
                  const bool placed = s.status != StationStatus::hole;
                  std::string notes = f.note;
                  const auto add = [&](const std::string& text) { notes += (notes.empty() ? "" : "; ") + text; };
                  if (!f.register_to.empty()) add(f.register_to);
                  if (!f.set_up.empty()) add(f.set_up);
                  constexpr double kLeastTold = 0.0005;
                  if (f.alone >= kLeastTold) add("alone sees " + percent(f.alone) + ": " + f.alone_where);
                  std::vector<std::string> cells{f.stop > 0 ? std::to_string(f.stop) : "",
                                                 f.name,
                                                 sheet_of[k] > 0 ? std::to_string(first_map + sheet_of[k] - 1) : "",
                                                 placed ? fixed(s.ground.x, 3) : "",
                                                 placed ? fixed(s.ground.y, 3) : "",
                                                 placed ? fixed(s.ground.z, 3) : "",
                                                 placed ? fixed(s.position.z - s.ground.z, 2) : "",
                                                 tape_text(f.corners),
                                                 f.visit > 0 ? fixed(f.walk_m, 1) : "",
                                                 f.visit == 0        ? ""
                                                 : f.done_at.empty() ? minutes_text(f.done_min)
                                                                     : f.done_at,
                                                 network.exact && k < points.size() ? grouped(points[k]) : "",
                                                 notes};
                  if (!corners) cells.erase(cells.begin() + kCorners);
                  return cells;
                });
  };
  std::vector<std::size_t> order = visiting_order(facts);
  if (!sessions) return table(order);
  std::erase_if(order, [&](std::size_t k) { return facts[k].visit > 0; });
  constexpr double kLeastLeft = 90;
  const auto part = [&](const std::string& title, const std::vector<std::size_t>& stations) {
    if (sheets.back().left() < kLeastLeft) sheets.emplace_back(paper);
    Sheet& sheet = sheets.back();
    sheet.y += 12;
    sheet.words(Sheet::kMargin, title, {.size = 10, .bold = true});
    sheet.y += 2;
    table(stations);
  };
  for (const SheetRound& round : sheet_rounds(network)) {
    const std::string batteries = batteries_text(*round.round);
    part(round.name + ", from " + clock_text(*round.start_min) + ": " + minutes_text(round.round->minutes) +
             (batteries.empty() ? "" : "; charged batteries: " + batteries),
         round.stations);
  }
  if (!order.empty()) part("In no session", order);
}

// Tables the place of each target, and then the targets that each station must see.
void targets_tables(std::vector<Sheet>& sheets, const Evaluation& network, const std::vector<StationFacts>& facts,
                    const std::vector<TargetFacts>& of_targets) {
  sheets.emplace_back(a4());
  const auto head = [&](const std::string& title, const std::string& words) {
    Sheet& sheet = sheets.back();
    sheet.heading(title);
    sheet.words(Sheet::kMargin, words, {.size = 9, .colour = kFaintInk});
    sheet.y += 6;
  };
  head(
      "Targets",
      "Metres; x, y and z are of a target's centre. Corners: tape distances to the two corners that the map marks; "
      "behind a station's name its distance in plan. Put all up before the first scan, and leave them until the last.");
  write_table(sheets, a4(),
              {{"Target", Align::start},
               {"x"},
               {"y"},
               {"z"},
               {"Corners"},
               {"Kind", Align::start},
               {"Measured by, at", Align::start}},
              of_targets.size(), of_targets.size(), "", [&](std::size_t k) -> std::vector<std::string> {
                const Target& target = network.targets[k];
                return {target.name,
                        fixed(target.centre.x, 3),
                        fixed(target.centre.y, 3),
                        fixed(target.centre.z, 3),
                        tape_text(of_targets[k].corners),
                        of_targets[k].kind,
                        of_targets[k].stations.empty() ? "no station" : of_targets[k].stations};
              });
  std::vector<std::size_t> order = visiting_order(facts);
  std::erase_if(order, [&](std::size_t k) { return facts[k].targets.empty(); });
  constexpr double kLeastLeft = 140;
  if (sheets.back().left() < kLeastLeft) sheets.emplace_back(a4());
  sheets.back().y += 18;
  head("Targets that each station must see",
       "In the order of visiting. Before a scan, look along the line to each: nothing may stand in it.");
  write_table(sheets, a4(), {{"No."}, {"Station", Align::start}, {"Targets", Align::start}}, order.size(), order.size(),
              "", [&](std::size_t row) -> std::vector<std::string> {
                const StationFacts& f = facts[order[row]];
                return {f.stop > 0 ? std::to_string(f.stop) : "", f.name, f.targets};
              });
}

// The links that the survey depends on, its maximum spanning tree: bridges first, then the weakest.
std::vector<ShownLink> tree_of(const StationLinks& network) {
  std::vector<ShownLink> links = links_of(network);
  std::erase_if(links, [](const ShownLink& link) { return !link.tree; });
  std::ranges::stable_sort(links, [](const ShownLink& l, const ShownLink& r) {
    return l.bridge != r.bridge ? l.bridge : l.overlap < r.overlap;
  });
  return links;
}

void links_table(std::vector<Sheet>& sheets, const StationLinks& network, const std::vector<std::string>& names) {
  const std::string measure = to_string(network.measure);
  const std::vector<ShownLink> links = tree_of(network);
  constexpr std::size_t kMost = 40;  // a sheet
  begin_section(sheets, std::min(kMost, links.size()));
  Sheet& sheet = sheets.back();
  sheet.heading("Links that the survey depends on");
  sheet.words(Sheet::kMargin,
              "The strongest links that connect all stations, by " + measure + " of at least " + number(network.least) +
                  ". Bridges, the only link between two parts, come first, then the weakest.",
              {.size = 9, .colour = kFaintInk});
  sheet.y += 6;
  if (links.empty())
    return sheet.words(Sheet::kMargin, "No two stations are linked.", {.size = 10, .colour = kAlertInk});
  write_table(sheets, a4(), {{"From", Align::start}, {"To", Align::start}, {measure}, {"", Align::start}}, links.size(),
              kMost, "report.html has all", [&](std::size_t k) -> std::vector<std::string> {
                const ShownLink& link = links[k];
                std::string note = link.bridge ? "bridge" : "";
                if (network.weakest == std::pair(link.a, link.b))
                  note += std::string(note.empty() ? "" : ", ") + "weakest that the survey depends on";
                return {names[link.a], names[link.b], percent(link.overlap), note};
              });
}

// Tables the places that miss the class. The others appear as a number, with the worst of them.
void accuracy_table(std::vector<Sheet>& sheets, const Accuracy& accuracy, AccuracyClass wanted) {
  begin_section(sheets, static_cast<std::size_t>(std::ranges::count_if(
                            accuracy.places, [](const PlaceAccuracy& place) { return place.beyond > 0; })));
  Sheet& sheet = sheets.back();
  const std::string what = accuracy.by_room ? "room" : "mesh";
  sheet.heading("Accuracy by " + what);
  std::vector<const PlaceAccuracy*> missed;
  const PlaceAccuracy* worst_met = nullptr;
  for (const PlaceAccuracy& place : accuracy.places)
    if (place.beyond > 0)
      missed.push_back(&place);
    else if (!worst_met || place.worst_m > worst_met->worst_m)
      worst_met = &place;
  const std::size_t met = accuracy.places.size() - missed.size();
  std::string words = "Predicted registration error at 95 %. " + to_string(wanted) + " allows " +
                      number(1000 * largest_error_m(wanted)) + " mm. ";
  if (worst_met) {
    words += missed.empty() ? "It is met everywhere: " : "It is met in ";
    words += missed.empty() ? "" : std::to_string(met) + " of " + std::to_string(accuracy.places.size()) + " places: ";
    words += "the worst there is " + worst_met->name + " with " + fixed(1000 * worst_met->worst_m, 1) + " mm. ";
  }
  if (!missed.empty()) words += "Not met in those below, the worst first; beyond: share of the seen surface with more.";
  sheet.words(Sheet::kMargin, words, {.size = 9, .colour = kFaintInk});
  if (missed.empty()) return;
  sheet.y += 6;
  const auto rows = static_cast<std::size_t>(std::max(0.0, sheet.left() / Sheet::kLine - 3));
  write_table(sheets, a4(),
              {{accuracy.by_room ? "Room" : "Mesh", Align::start}, {"mean, mm"}, {"worst place, mm"}, {"beyond"}},
              missed.size(), rows, "report.html has all", [&](std::size_t k) -> std::vector<std::string> {
                const PlaceAccuracy& place = *missed[k];
                return {place.name, tenths(1000 * place.mean_m), tenths(1000 * place.worst_m), percent(place.beyond)};
              });
}

void rooms_table(std::vector<Sheet>& sheets, const std::vector<RoomFacts>& rooms) {
  begin_section(sheets, rooms.size());
  Sheet& sheet = sheets.back();
  sheet.heading("Rooms");
  sheet.words(Sheet::kMargin,
              "Captured: share of the surfaces in and around a room. A room without a station says why it has none.",
              {.size = 9, .colour = kFaintInk});
  sheet.y += 6;
  write_table(
      sheets, a4(),
      {{"Room", Align::start}, {"Storey", Align::start}, {"floor, m²"}, {"captured"}, {"Stations", Align::start}},
      rooms.size(), rooms.size(), "", [&](std::size_t k) -> std::vector<std::string> {
        const RoomFacts& room = rooms[k];
        return {room.name, room.storey, fixed(room.floor_m2, 1), room.captured ? percent(*room.captured) : "–",
                room.stations.empty() ? "none: " + room.why : room.stations};
      });
}

void missed_table(std::vector<Sheet>& sheets, const std::vector<MissedShare>& shares) {
  constexpr std::size_t kBar = 6;  // lines
  begin_section(sheets, kBar + shares.size());
  Sheet& sheet = sheets.back();
  constexpr double kMargin = Sheet::kMargin;
  sheet.heading("What is missed, and why");
  const MissedShare& all = shares.front();
  double at = kMargin;
  const double width = sheet.right() - kMargin;
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
    if (at + room > sheet.right()) at = kMargin, sheet.y += Sheet::kLine;
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
  const auto rows = static_cast<std::size_t>(std::max(0.0, sheet.left() / Sheet::kLine - 3));
  write_table(sheets, a4(),
              {{"Mesh, shares in %", Align::start},
               {"captured"},
               {"others would"},
               {"hidden"},
               {"too far"},
               {"too flat"},
               {"too dark"},
               {"too sparse"}},
              nodes.size(), rows, "missed.csv has all", [&](std::size_t k) -> std::vector<std::string> {
                const MissedShare& s = *nodes[k];
                return {s.node,
                        share(s, WhyMissed::captured),
                        share(s, WhyMissed::not_chosen),
                        share(s, WhyMissed::hidden),
                        share(s, WhyMissed::far),
                        share(s, WhyMissed::flat),
                        share(s, WhyMissed::dark),
                        share(s, WhyMissed::sparse)};
              });
}

}  // namespace

bool write_report_pdf(const std::filesystem::path& file, const Report& report, Site& site,
                      const std::stop_token& stop) {
  const Evaluation& network = report.shown();
  const std::vector<StationFacts> facts = station_facts(report, site.simulator());
  const std::vector<TargetFacts> of_targets = target_facts(report, site.simulator());
  std::vector<Sheet> sheets;
  FieldSheets maps;
  parallel::both([&] { sheets.push_back(front_sheet(report, site, stop)); },
                 [&] { maps = field_sheets(report, facts, of_targets, site, stop); });
  if (stop.stop_requested()) return false;
  const std::size_t first_map = sheets.size() + 1;
  std::ranges::move(maps.sheets, std::back_inserter(sheets));
  if (network.visit && !network.visit->sessions.empty())
    sessions_table(sheets, network, station_names(network.stations, network.names));
  stations_table(sheets, network, facts, maps.of_station, first_map);
  if (!network.targets.empty()) targets_tables(sheets, network, facts, of_targets);
  if (const auto links = network.links()) links_table(sheets, *links, station_names(network.stations, network.names));
  if (report.accuracy && !report.accuracy->places.empty())
    accuracy_table(sheets, *report.accuracy, network.accuracy_class);
  if (!report.rooms.empty()) rooms_table(sheets, report.rooms);
  if (report.options.missed && !report.options.missed->shares.empty())
    missed_table(sheets, report.options.missed->shares);
  std::vector<std::unique_ptr<Canvas>> pages;
  for (Sheet& sheet : sheets) {
    const double y = sheet.canvas->height() - 18, margin = 28;
    const TextStyle style{.size = 7.5, .colour = kFaintInk};
    const std::string page = "vantage " + std::string(version()) + "   sheet " + std::to_string(pages.size() + 1) +
                             " of " + std::to_string(sheets.size());
    const double width = sheet.canvas->width(), room = width - 2 * margin - sheet.canvas->text_width(page, style) - 20;
    sheet.canvas->text({margin, y}, fitted(*sheet.canvas, report.options.command, room, style), style);
    sheet.canvas->text({width - margin, y}, page, {.size = 7.5, .colour = kFaintInk, .across = Align::end});
    pages.push_back(std::move(sheet.canvas));
  }
  Canvas::save_pages(file, pages, report.options.title);
  return true;
}

}  // namespace vantage
