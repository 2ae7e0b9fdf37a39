// SPDX-License-Identifier: Apache-2.0
#include "vantage/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/text.hpp"
#include "plan/limits.hpp"

namespace vantage {
namespace {

std::vector<bool> used(std::span<const PlacedStation> stations) {
  std::vector<bool> all;
  for (const PlacedStation& station : stations) all.push_back(active(station));
  return all;
}

std::string percent(double share) { return fixed(100 * share, 1) + " %"; }

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

std::string captured_text(const SurveySummary& summary) {
  const auto of = [&](double share, double error) {
    return percent(share) + (error > 0 ? " ± " + percent(error) : "");
  };
  std::string text = of(summary.captured, summary.captured_error) + " of the site";
  if (summary.of_visible) text += ", " + percent(*summary.of_visible) + " of what can be seen";
  return text;
}

std::string links_text(const SurveySummary& summary) {
  const SummaryLinks& links = *summary.links;
  std::size_t stations = 0;
  for (const auto& part : links.parts) stations += part.size();
  const std::string by = " by " + links.measure + " of at least " + number(links.least);
  if (stations == 0) return "no: there is no station to link";
  if (stations == 1) return "one station, nothing to link";
  if (links.parts.size() == 1) {
    std::string text = "yes: all " + std::to_string(stations) + " stations," + by;
    if (links.weakest)
      text += "; weakest link " + summary.names[links.weakest->first] + "–" + summary.names[links.weakest->second] +
              " with " + fixed(links.weakest_value, 3);
    return text;
  }
  std::vector<std::size_t> alone;
  std::string together;
  for (const auto& part : links.parts) {
    if (part.size() == 1)
      alone.push_back(part.front());
    else
      together += (together.empty() ? ": " : "; ") + listed(part, summary.names);
  }
  std::string text = "no: in " + std::to_string(links.parts.size()) + " parts," + by + together;
  if (!alone.empty())
    text += (together.empty() ? ": " : "; ") + listed(alone, summary.names) +
            (alone.size() == 1 ? " stands" : " stand") + " alone";
  return text;
}

std::vector<std::string> links_advice(const SurveySummary& summary) {
  std::vector<std::string> advice;
  if (!summary.links) return advice;
  for (const SummaryLinks::Gap& gap : summary.links->gaps) {
    const std::string &inside = summary.names[gap.inside], &outside = summary.names[gap.outside];
    advice.push_back(gap.value > 0
                         ? "link " + inside + " to " + outside + ", the nearest to it with " + fixed(gap.value, 3) +
                               ": put a station between them, or move them closer"
                         : inside + " shares nothing with any station of another part: put a station between it and " +
                               outside + ", or tie it in with targets");
  }
  return advice;
}

std::string advice_for(const Requirement& requirement) {
  const std::string& name = requirement.objective.name;
  if (name == "coverage" || name == "capture")
    return "allow more stations (--stations), or more places to stand; coverage.ply shows what is missing";
  if (name == "parts" || name == "weakest_link" || name == "link" || name == "overlap")
    return "allow more stations (--stations), or ask for less overlap and tie scans together with targets";
  if (name == "stations" || name == "time") return "ask for less to be captured, or allow more of it";
  return "search longer (--iterations), or ask for less";
}

}  // namespace

SummaryLinks summary_links(const OverlapMatrix& overlap, double least, const std::vector<bool>& used) {
  // the graph of the stations that count, by their places among all
  std::vector<std::size_t> station;
  for (std::size_t k = 0; k < overlap.size(); ++k)
    if (k >= used.size() || used[k]) station.push_back(k);
  OverlapMatrix matrix(station.size());
  for (std::size_t i = 0; i < station.size(); ++i)
    for (std::size_t j = i + 1; j < station.size(); ++j) matrix.set(i, j, overlap(station[i], station[j]));
  const Connectivity graph = connectivity(matrix, least);

  SummaryLinks links{.least = least};
  links.parts.resize(graph.parts);
  for (std::size_t i = 0; i < station.size(); ++i) links.parts[graph.part[i]].push_back(station[i]);
  std::ranges::stable_sort(links.parts, std::ranges::greater{}, &std::vector<std::size_t>::size);
  if (graph.parts == 1 && station.size() > 1) {
    links.weakest = {station[graph.weakest_link.first], station[graph.weakest_link.second]};
    links.weakest_value = graph.weakest_overlap;
  }
  for (std::size_t p = 1; p < links.parts.size(); ++p) {
    SummaryLinks::Gap best{.inside = links.parts[p].front(), .outside = links.parts[0].front(), .value = 0};
    for (const std::size_t inside : links.parts[p])
      for (std::size_t other = 0; other < links.parts.size(); ++other)
        for (const std::size_t outside : links.parts[other])
          if (other != p && overlap(inside, outside) > best.value)
            best = {.inside = inside, .outside = outside, .value = overlap(inside, outside)};
    links.gaps.push_back(best);
  }
  return links;
}

SummaryLinks scan_links(const OverlapMatrix& scan_overlaps, double least, std::span<const PlacedStation> stations) {
  SummaryLinks links = summary_links(scan_overlaps, least, used(stations));
  links.measure = scan_overlap_measure;
  return links;
}

std::vector<SummaryFault> station_faults(std::span<const PlacedStation> stations, std::span<const std::string> names) {
  std::vector<SummaryFault> faults;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    if (stations[k].status == StationStatus::ok) continue;
    std::string what = names[k] + " " + explain(stations[k].status);
    if (!active(stations[k])) what += ", and is left out";
    faults.push_back({what, "move it"});
  }
  return faults;
}

SurveySummary summary_of(const PlanEntry& entry, const PlanResult& result) {
  SurveySummary summary{.names = station_names(entry.stations)};
  const MeasuredValue& covered = entry.values.at("coverage");
  summary.captured = covered.best_known();
  summary.captured_error = entry.confirmed ? 0 : covered.standard_error;
  if (const auto captured = entry.values.find("capture"); captured != entry.values.end())
    summary.of_visible = captured->second.best_known();
  if (const auto error = entry.values.find("registration"); error != entry.values.end())
    summary.registration_mm = error->second.best_known();
  if (entry.visit) summary.seconds_on_site = 60 * entry.visit->minutes;
  if (entry.confirmed && entry.exact_scan_overlap_matrix.size() == 0) {
    summary.links = summary_links(entry.exact_overlap_matrix, result.problem.link_overlap, used(entry.stations));
  } else if (entry.confirmed) {
    const double least = limit_of(result.problem, "link", Requirement::Bound::at_least).value_or(0);
    summary.links = scan_links(entry.exact_scan_overlap_matrix, least, entry.stations);
  }
  summary.faults = station_faults(entry.stations, summary.names);
  for (const Requirement& requirement : result.problem.requirements) {
    const double value = entry.value(requirement.objective.name);
    if (requirement.missed_by(value) > 0)
      summary.faults.push_back(
          {"misses " + to_string(requirement) + ": it has " + fixed(value, 3), advice_for(requirement)});
  }
  return summary;
}

std::vector<SummaryLine> summary_lines(const SurveySummary& summary) {
  std::vector<SummaryLine> lines{{"captured", captured_text(summary)}};
  if (summary.links) lines.push_back({"linked", links_text(summary)});
  if (summary.registration_mm && std::isfinite(*summary.registration_mm))
    lines.push_back({"registered", "to about " + fixed(*summary.registration_mm, 2) + " mm, as predicted"});
  if (summary.seconds_on_site) lines.push_back({"on site", "about " + duration(*summary.seconds_on_site)});
  for (const std::string& advice : links_advice(summary)) lines.push_back({"to do", advice});
  for (const SummaryFault& fault : summary.faults) lines.push_back({"to do", fault.what + ": " + fault.advice});
  return lines;
}

std::string summary_text(const SurveySummary& summary) {
  std::string text, last;
  for (const SummaryLine& line : summary_lines(summary)) {
    std::string heading = line.heading == last ? "" : line.heading;
    last = line.heading;
    heading.resize(11, ' ');
    text += heading + line.text + "\n";
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
    if (name == "parts")
      text += "no network links all its stations by overlaps of at least " + number(result.problem.link_overlap) +
              (best == best ? ": the best falls into " + fixed(best, 0) + " parts" : std::string()) + "\n";
    else
      text += "no network keeps " + to_string(requirement) +
              (best == best ? ": the best has " + fixed(best, 3) : std::string()) + "\n";
  }
  return text;
}

}  // namespace vantage
