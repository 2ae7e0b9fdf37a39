// SPDX-License-Identifier: Apache-2.0
#include "vantage/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/text.hpp"

namespace vantage {
namespace {

// "S1, S2 and S5"
std::string listed(const std::vector<std::size_t>& stations, const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t k = 0; k < stations.size(); ++k)
    text += (k == 0 ? "" : k + 1 == stations.size() ? " and " : ", ") + names[stations[k]];
  return text;
}

std::string duration(double seconds) {
  const auto minutes = static_cast<long long>(std::llround(seconds / 60));
  const std::string rest = std::to_string(minutes % 60) + " min";
  return minutes < 60 ? rest : std::to_string(minutes / 60) + " h " + rest;
}

std::string captured_text(const Evaluation& evaluation) {
  const Estimate& coverage = evaluation.values.at("coverage");
  const double error = evaluation.exact ? 0 : coverage.standard_error;
  std::string text = percent(coverage.value) + (error > 0 ? " ± " + percent(error) : "") + " of the site";
  const auto capture = evaluation.values.find("capture");
  if (capture == evaluation.values.end() || std::isnan(capture->second.value)) return text;
  const double own = capture->second.standard_error;
  return text + ", " + percent(capture->second.value) + (own > 0 ? " ± " + percent(own) : "") +
         " of what is attainable";
}

std::string links_text(const StationLinks& links, const std::vector<std::string>& names) {
  std::size_t stations = 0;
  for (const auto& part : links.parts) stations += part.size();
  const std::string by = " by " + to_string(links.measure) + " of at least " + number(links.least);
  if (stations == 0) return "no: there is no station to link";
  if (stations == 1) return "one station, nothing to link";
  if (links.parts.size() == 1) {
    std::string text = "yes: all " + std::to_string(stations) + " stations," + by;
    if (links.weakest)
      text += "; weakest link " + names[links.weakest->first] + "–" + names[links.weakest->second] + " with " +
              fixed(links.weakest_value, 3);
    return text;
  }
  std::vector<std::size_t> alone;
  std::string together;
  for (const auto& part : links.parts) {
    if (part.size() == 1)
      alone.push_back(part.front());
    else
      together += (together.empty() ? ": " : "; ") + listed(part, names);
  }
  std::string text = "no: in " + std::to_string(links.parts.size()) + " parts," + by + together;
  if (!alone.empty())
    text +=
        (together.empty() ? ": " : "; ") + listed(alone, names) + (alone.size() == 1 ? " stands" : " stand") + " alone";
  return text;
}

std::vector<std::string> links_advice(const StationLinks& links, const std::vector<std::string>& names) {
  std::vector<std::string> advice;
  for (const StationLinks::Gap& gap : links.gaps) {
    const std::string &inside = names[gap.inside], &outside = names[gap.outside];
    advice.push_back(gap.value > 0
                         ? "link " + inside + " to " + outside + ", the nearest to it with " + fixed(gap.value, 3) +
                               ": put a station on the way between them, in a doorway if there is one, or move them "
                               "closer"
                         : inside + " shares nothing with any station of another part: put a station on the way to " +
                               outside + ", in a doorway if there is one, or tie it in with targets");
  }
  return advice;
}

// "to about 28.5 mm, as predicted; at 95 % 56 mm, where LOA30 allows 15"
std::string registered_text(const Evaluation& evaluation, const Estimate& registered) {
  const double rms_mm = registered.value, sampling_mm = evaluation.exact ? 0 : registered.standard_error;
  std::string text =
      "to about " + fixed(rms_mm, 2) + (sampling_mm > 0 ? " ± " + fixed(sampling_mm, 2) : "") + " mm, as predicted";
  const auto by = static_cast<std::size_t>(
      std::ranges::count_if(evaluation.targets, [](const Target& target) { return target.stations.size() > 1; }));
  if (!evaluation.targets.empty())
    text += " with " + std::to_string(by) + (by == 1 ? " target" : " targets") + " that tie scans together";
  if (evaluation.registration && evaluation.registration->absolute_rms_m)
    text += ", and to " + fixed(1000 * *evaluation.registration->absolute_rms_m, 2) + " mm in the site's frame";
  const double error = error_at_95_percent(rms_mm / 1000), most = largest_error_m(evaluation.accuracy_class);
  const std::string name = to_string(evaluation.accuracy_class), bound = number(1000 * most) + " mm at 95 %";
  return text + (error <= most
                     ? "; " + name + " (" + bound + ") is met"
                     : "; " + fixed(1000 * error, 0) + " mm at 95 %, more than " + name + " allows (" + bound + ")");
}

// A registration that misses its class, if targets were not looked at.
std::vector<std::string> registration_advice(const Evaluation& evaluation, double rms_mm) {
  if (error_at_95_percent(rms_mm / 1000) <= largest_error_m(evaluation.accuracy_class)) return {};
  if (std::ranges::any_of(evaluation.targets, &Target::proposed)) return {};
  return {"surfaces do not hold the scans together to " + to_string(evaluation.accuracy_class) +
          ": let targets be proposed, or add stations that share more walls"};
}

// A sentence for each station that is left out, or stands where none should.
std::vector<std::string> stations_advice(const Evaluation& evaluation, const std::vector<std::string>& names) {
  std::vector<std::string> advice;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const PlacedStation& station = evaluation.stations[k];
    if (station.status == StationStatus::ok) continue;
    advice.push_back(names[k] + " " + explain(station.status) + (active(station) ? "" : ", and is left out") +
                     ": move it");
  }
  return advice;
}

std::vector<std::string> requirements_advice(const Evaluation& evaluation, std::span<const Requirement> requirements) {
  std::vector<std::string> sentences;
  for (const Requirement& requirement : requirements) {
    const double value = evaluation.value(requirement.objective.name);
    if (requirement.missed_by(value) > 0) sentences.push_back(advice(requirement, value));
  }
  return sentences;
}

}  // namespace

std::vector<SummaryLine> summary_lines(const Evaluation& evaluation, std::span<const Requirement> requirements) {
  const std::vector<std::string> names = station_names(evaluation.stations, evaluation.names);
  const std::optional<StationLinks> links = evaluation.links();
  std::vector<SummaryLine> lines{{"captured", captured_text(evaluation)}};
  if (links) lines.push_back({"linked", links_text(*links, names)});
  const auto registered = evaluation.values.find("registration");
  if (registered != evaluation.values.end() && std::isfinite(registered->second.value))
    lines.push_back({"registered", registered_text(evaluation, registered->second)});
  if (evaluation.visit) lines.push_back({"on site", "about " + duration(60 * evaluation.visit->minutes)});
  const auto to_do = [&](const std::vector<std::string>& advice) {
    for (const std::string& text : advice) lines.push_back({"to do", text});
  };
  if (links) to_do(links_advice(*links, names));
  to_do(stations_advice(evaluation, names));
  if (registered != evaluation.values.end() && std::isfinite(registered->second.value))
    to_do(registration_advice(evaluation, registered->second.value));
  to_do(requirements_advice(evaluation, requirements));
  return lines;
}

namespace {
// A pattern for a name, in single quotes for a shell.
std::string quoted_pattern(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return c == '\'' || c < 0x20; }, '?');
  return "'" + name + "'";
}

// "14.2 m² of floor behind a closed door; plan it too with ignore 'Door 12'"
std::string behind_doors(const NotEntered& part) {
  std::string text = fixed(part.area_m2, 1) + " m² of floor behind " +
                     (part.doors.size() == 1 ? "a closed door" : number(part.doors.size()) + " closed doors") +
                     "; plan it too with ";
  for (std::size_t k = 0; k < part.doors.size(); ++k)
    text += (k > 0 ? " and ignore " : "ignore ") + quoted_pattern(part.doors[k]);
  return text;
}
}  // namespace

std::vector<SummaryLine> ground_lines(const SearchArea& area) {
  constexpr std::size_t kMost = 5;
  std::vector<SummaryLine> lines;
  if (area.on_plane()) lines.push_back({"ground", "none in the model: the stations stand on " + area.description()});
  const auto place = [](const Vec3& p) { return fixed(p.x, 2) + "," + fixed(p.y, 2) + "," + fixed(p.z, 2); };
  std::string entries;
  for (const Vec3& entry : area.entries()) entries += "enter " + place(entry) + " and ";
  double rest = 0;
  const std::span<const NotEntered> parts = area.not_entered();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (k >= kMost)
      rest += parts[k].area_m2;
    else if (!parts[k].doors.empty())
      lines.push_back({"closed", behind_doors(parts[k])});
    else
      lines.push_back({"closed", fixed(parts[k].area_m2, 1) + " m² of floor that nothing leads to; plan it too with " +
                                     entries + "enter " + place(parts[k].place)});
  }
  if (rest > 0)
    lines.push_back(
        {"closed", fixed(rest, 1) + " m² of floor in " + std::to_string(parts.size() - kMost) + " more such parts"});
  return lines;
}

std::vector<SummaryLine> summary_lines(const PlanResult& result) {
  std::vector<SummaryLine> lines = summary_lines(result.front.at(answer(result)));
  for (std::string& help : what_would_help(result)) lines.push_back({"to do", std::move(help)});
  if (!result.area) return lines;
  for (SummaryLine& line : ground_lines(*result.area))
    lines.insert(line.heading == "ground" ? lines.begin() : lines.end(), std::move(line));
  return lines;
}

namespace {
std::string as_text(const std::vector<SummaryLine>& lines) {
  std::string text, last;
  for (const SummaryLine& line : lines) {
    std::string heading = line.heading == last ? "" : line.heading;
    last = line.heading;
    heading.resize(11, ' ');
    text += heading + line.text + "\n";
  }
  return text;
}
}  // namespace

std::string summary_text(const Evaluation& evaluation, std::span<const Requirement> requirements) {
  return as_text(summary_lines(evaluation, requirements));
}
std::string summary_text(const PlanResult& result) { return as_text(summary_lines(result)); }

std::string trade_off_text(const PlanResult& result) {
  const std::vector<TradeOffPoint>& points = result.trade_off;
  if (points.empty()) return {};
  // The ends, the knee, the answer, and what is half way between these where that is far.
  std::vector<char> shown(points.size(), 0);
  shown.front() = shown.back() = 1;
  for (std::size_t k = 0; k < points.size(); ++k) shown[k] |= points[k].knee || points[k].answer;
  for (std::size_t from = 0; from + 1 < points.size();) {
    std::size_t to = from + 1;
    while (!shown[to]) ++to;
    if (to - from > 3) shown[(from + to) / 2] = 1;
    from = to;
  }
  std::string text = "stations   captured  registered  on site\n";
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!shown[k]) continue;
    const TradeOffPoint& point = points[k];
    const auto cell = [](std::string value, std::size_t width) {
      return std::string(width > value.size() ? width - value.size() : 0, ' ') + value;
    };
    const auto registered = point.values.find("registration");
    const bool known = registered != point.values.end() && std::isfinite(registered->second.value);
    text += cell(std::to_string(point.stations.size()), 8) + cell(percent(point.values.at("capture").value), 11) +
            cell(known ? fixed(registered->second.value, 2) + " mm" : "–", known ? 12 : 14) + "  " +
            (point.minutes_on_site ? duration(60 * *point.minutes_on_site) : "–") +
            (point.answer ? "  <- the plan" : "") + (point.knee ? "  <- beyond this each station gains less" : "") +
            "\n";
  }
  return text;
}

std::string unmet_text(const PlanResult& result) {
  std::string text;
  for (const Requirement& requirement : result.problem.requirements) {
    const std::string& name = requirement.objective.name;
    double best = std::nan(""), least = std::numeric_limits<double>::infinity();
    for (const PlanEntry& entry : result.front) {
      const double value = entry.value(name), missed = requirement.missed_by(value);
      if (missed < least) least = missed, best = value;
    }
    if (result.front.empty() || !(least > 0)) continue;
    text += "no network has its " + in_words(requirement) +
            (std::isnan(best) ? "" : ": the best has " + value_text(requirement.objective, best)) + "\n";
  }
  return text;
}

}  // namespace vantage
