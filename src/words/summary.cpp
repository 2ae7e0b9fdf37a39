// SPDX-License-Identifier: Apache-2.0
#include "vantage/summary.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "core/tenths.hpp"
#include "core/text.hpp"
#include "evaluate/known_points.hpp"
#include "evaluate/steep_checks.hpp"
#include "plan/answer.hpp"
#include "scene/room_floors.hpp"
#include "vantage/missed.hpp"

namespace vantage {
namespace {

// "S1, S2 and S5"; of many stations the first ones and how many more.
std::string listed(const std::vector<std::size_t>& stations, const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 30;
  const std::size_t named = stations.size() <= kNamed ? stations.size() : kNamed - 1;
  std::string text;
  for (std::size_t k = 0; k < named; ++k)
    text += (k == 0 ? "" : k + 1 == stations.size() ? " and " : ", ") + names[stations[k]];
  if (named < stations.size()) text += " and " + std::to_string(stations.size() - named) + " more";
  return text;
}

std::string duration(double seconds) {
  const auto minutes = static_cast<long long>(std::llround(seconds / 60));
  const std::string rest = std::to_string(minutes % 60) + " min";
  return minutes < 60 ? rest : std::to_string(minutes / 60) + " h " + rest;
}

// "8 h", "450 min"
std::string whole_hours(double minutes) {
  return std::fmod(minutes, 60) == 0 ? number(minutes / 60) + " h" : duration(60 * minutes);
}

std::string counted(std::size_t many, const std::string& what) {
  return std::to_string(many) + " " + what + (many == 1 ? "" : "s");
}

// "4 sessions of at most 8 h: 2 days with 2 crews; the longest takes 7 h 40 min, all together 28 h 5 min"
std::string sessions_text(const Visit& visit) {
  const std::vector<Session>& sessions = visit.sessions;
  std::size_t crews = 0;
  double longest = 0, all = 0;
  for (const Session& one : sessions)
    crews = std::max(crews, one.crew), longest = std::max(longest, one.minutes), all += one.minutes;
  const std::size_t days = sessions.back().day;
  std::string text = counted(sessions.size(), "session") + " of at most " + whole_hours(visit.day_min) + ": " +
                     counted(days, "day") + (crews > 1 ? " with " + counted(crews, "crew") : "") + "; ";
  if (sessions.size() == 1) return text + "it takes " + duration(60 * all);
  return text + "the longest takes " + duration(60 * longest) + ", all together " + duration(60 * all);
}

// "4 of 2 h each, for 6 h 30 min with the scanner on"; of sessions "at most 2 a session and 4 a day, 7 in all, of 2 h
// each, …".
std::string battery_text(const Visit& visit, const BatteryUse& use) {
  const auto either = [](const std::string& minutes, const std::string& scans) {
    return minutes + (minutes.empty() || scans.empty() ? "" : " or ") + scans;
  };
  const bool by_time = use.battery_min > 0, by_scans = use.battery_scans > 0;
  const std::string each = either(
                        by_time ? whole_hours(use.battery_min) : "",
                        by_scans ? number(use.battery_scans) + (use.battery_scans == 1 ? " scan" : " scans") : ""),
                    needed = (by_time ? duration(60 * use.on_min) + " with the scanner on" : std::string()) +
                             (by_time && by_scans ? " and " : "") + (by_scans ? counted(use.scans, "scan") : "");
  std::string many = std::to_string(use.batteries);
  if (visit.sessions.size() > 1) {
    std::size_t most = 0;
    for (const Session& session : visit.sessions)
      for (const BatteryUse& one : session.batteries)
        if (one.instrument == use.instrument) most = std::max(most, one.batteries);
    many = "at most " + std::to_string(most) + " a session and " + std::to_string(use.in_a_day) + " a day, " + many +
           " in all,";
  }
  return many + " of " + each + " each, for " + needed;
}

std::vector<SummaryLine> battery_lines(const Visit& visit) {
  std::vector<SummaryLine> lines;
  const std::vector<BatteryUse> uses = batteries_of(visit);
  for (const BatteryUse& use : uses)
    lines.push_back(
        {"batteries", (uses.size() > 1 ? use.instrument + ": " : std::string()) + battery_text(visit, use)});
  return lines;
}

// "kept at all 5 stations that access windows are for, with 35 min of waiting"
std::string hours_text(const Visit& visit) {
  const std::string all = counted(visit.bound, "station") + " that access windows are for";
  if (!visit.closed.empty())
    return "not kept at " + number(visit.closed.size()) + " of " + all + ", which no session scans";
  double waiting = 0;
  for (const Session& one : visit.sessions) waiting += one.waiting_min;
  return "kept at all " + all + ", with " + (waiting > 0 ? duration(60 * waiting) + " of" : std::string("no")) +
         " waiting";
}

// A sentence for each station whose access windows no session keeps.
std::vector<std::string> hours_advice(const Visit& visit, const std::vector<std::string>& placed) {
  std::vector<std::string> advice;
  for (const ClosedStation& one : visit.closed)
    advice.push_back(placed[one.station] + " is in no session: it " + one.why);
  return advice;
}

// A sentence for each session whose scans no link holds together, or to the others.
std::vector<std::string> sessions_advice(const Visit& visit, const std::vector<std::string>& placed) {
  std::vector<std::string> advice;
  for (const Session& one : visit.sessions) {
    const std::string which = "the session of day " + std::to_string(one.day) + ", crew " + std::to_string(one.crew) +
                              " (" +
                              (one.order.size() == 1 ? placed[one.order.front()]
                                                     : placed[one.order.front()] + " to " + placed[one.order.back()]) +
                              ")";
    if (one.parts > 1)
      advice.push_back(which + " has its scans in " + std::to_string(one.parts) +
                       " groups that no link connects: they hold together only with scans of other sessions");
    if (!one.linked)
      advice.push_back(which +
                       " is linked to no other session: put up targets that both see, or a station between them");
  }
  return advice;
}

// "22 m²", "3.4 m²"
std::string surface_text(double m2) { return (m2 < 10 ? number(std::round(10 * m2) / 10) : fixed(m2, 0)) + " m²"; }

// ", which is known to 0.7 %"
std::string known_to(const std::optional<double>& growth) {
  if (!growth || *growth <= 0) return {};
  constexpr double kLeastTold = 0.001;
  if (*growth >= 1) return " from the few places that were looked at";
  return ", which is known to " + (*growth < kLeastTold ? "less than " : std::string()) +
         percent(std::max(*growth, kLeastTold));
}

std::string captured_text(const Evaluation& evaluation) {
  const Estimate& coverage = evaluation.values.at("coverage");
  const double error = evaluation.exact ? 0 : coverage.standard_error;
  std::string text;
  if (!std::isnan(coverage.value))
    text = percent(coverage.value) + (error > 0 ? " ± " + percent(error) : "") + " of the site";
  const auto capture = evaluation.values.find("capture");
  if (capture == evaluation.values.end() || std::isnan(capture->second.value))
    return text.empty() ? "not known: the time was over first" : text;
  // The share of the site comes second: much of it, such as roofs and undersides, nobody can capture.
  const double own = capture->second.standard_error;
  return (text.empty() ? "about " : "") + percent(capture->second.value) + (own > 0 ? " ± " + percent(own) : "") +
         " of what is attainable" + known_to(evaluation.attainable_growth) + (text.empty() ? "" : "; " + text);
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
  constexpr std::size_t kParts = 6;  // that are named
  std::vector<std::size_t> alone;
  std::string together;
  std::size_t told = 0;
  for (const auto& part : links.parts) {
    if (part.size() == 1)
      alone.push_back(part.front());
    else if (++told <= kParts)
      together += (together.empty() ? ": " : "; ") + listed(part, names);
  }
  if (told > kParts) together += "; " + std::to_string(told - kParts) + " more of several stations";
  std::string text = "no: in " + std::to_string(links.parts.size()) + " parts," + by + together;
  if (!alone.empty())
    text +=
        (together.empty() ? ": " : "; ") + listed(alone, names) + (alone.size() == 1 ? " stands" : " stand") + " alone";
  return text;
}

// The stations of a part and of the others that stand nearest to each other, the part's first.
std::pair<std::size_t, std::size_t> nearest_to_part(const StationLinks& links, std::size_t part,
                                                    std::span<const PlacedStation> stations) {
  std::pair<std::size_t, std::size_t> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t inside : links.parts[part])
    for (std::size_t other = 0; other < links.parts.size(); ++other)
      for (const std::size_t outside : links.parts[other]) {
        const Vec3 apart = stations[outside].position - stations[inside].position;
        if (const double away = dot(apart, apart); other != part && away < least)
          least = away, nearest = {inside, outside};
      }
  return nearest;
}

std::vector<std::string> links_advice(const StationLinks& links, std::span<const PlacedStation> stations,
                                      const std::vector<std::string>& names) {
  std::vector<std::string> advice;
  for (const StationLinks::Gap& pane : links.through_glass)
    advice.push_back(names[pane.inside] + " and " + names[pane.outside] + " share " + fixed(pane.value, 3) +
                     " through glass, which does not count: put a station in a doorway between them, if there is one");
  std::set<std::pair<std::size_t, std::size_t>> told;  // a pair may be the best one of both parts
  for (std::size_t k = 0; k < links.gaps.size(); ++k) {
    const double value = links.gaps[k].value;
    const auto [inside, outside] =
        value > 0 ? std::pair{links.gaps[k].inside, links.gaps[k].outside} : nearest_to_part(links, k + 1, stations);
    if (!told.insert(std::minmax(inside, outside)).second) continue;
    advice.push_back(
        value > 0 ? "link " + names[inside] + " to " + names[outside] + ", the nearest to it with " + fixed(value, 3) +
                        ": put a station on the way between them, in a doorway if there is one, or move "
                        "them closer"
                  : names[inside] + " shares nothing with any station of another part: put a station on the way to " +
                        names[outside] + ", in a doorway if there is one, or tie it in with targets");
  }
  return advice;
}

std::vector<std::string> storeys_advice(std::span<const StoreyTie> ties, const std::vector<std::string>& names) {
  if (ties.empty()) return {};
  constexpr std::size_t kNamed = 6;
  std::string text = "storeys are tied past the stair, through a window or across a void, by ";
  for (std::size_t k = 0; k < std::min(kNamed, ties.size()); ++k)
    text += (k > 0 ? ", " : "") + names[ties[k].a] + "–" + names[ties[k].b] + " (" + fixed(ties[k].apart_m, 1) +
            " m apart, " + fixed(ties[k].way_m, 0) + " m on foot)";
  if (ties.size() > kNamed) text += " and " + std::to_string(ties.size() - kNamed) + " more";
  return {text + ": stations at both ends of the stair would tie them better"};
}

// " S4 (61 mm), S7 (40 mm) and 3 more": stations whose part of the surface misses the class.
std::string beyond_text(const Evaluation& evaluation, const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 3;
  std::vector<std::pair<double, std::size_t>> beyond;
  if (evaluation.registration)
    for (std::size_t k = 0; k < evaluation.registration->stations.size(); ++k) {
      const double error = error_at_95_percent(evaluation.registration->stations[k].rms_m);
      if (error > largest_error_m(evaluation.accuracy_class)) beyond.emplace_back(-error, k);
    }
  std::ranges::sort(beyond);
  std::string text;
  for (std::size_t k = 0; k < std::min(kNamed, beyond.size()); ++k)
    text += (k == 0 ? " " : ", ") + names[beyond[k].second] + " (" + fixed(-1000 * beyond[k].first, 1) + " mm)";
  return text + (beyond.size() > kNamed ? " and " + std::to_string(beyond.size() - kNamed) + " more" : "");
}

// "to about 2.1 mm, as predicted (0.8 mm of it random), with 6 targets (28.5 mm without); LOA30 (15 mm at 95 %) is met
// with 10.9 mm to spare"
std::string registered_text(const Evaluation& evaluation, const Estimate& registered,
                            const std::vector<std::string>& names) {
  const double rms_mm = registered.value, sampling_mm = registered.standard_error;
  std::string text = (rms_mm < kLeastTenth ? "to " : "to about ") + tenths(rms_mm) +
                     (sampling_mm >= kLeastTenth ? " ± " + tenths(sampling_mm) : "") + " mm, as predicted";
  if (evaluation.registration) {
    const RegistrationError& error = *evaluation.registration;
    text += error.random_m < error.rms_m
                ? " (random " + tenths(1000 * error.random_m) + " mm, the rest by what a calibration leaves" +
                      (evaluation.calibration.empty() ? "" : ": " + evaluation.calibration) + ")"
                : " by random errors alone (the scanner states no calibration)";
  }
  const auto by = static_cast<std::size_t>(std::ranges::count_if(
      evaluation.targets, [](const Target& target) { return !target.check && target.stations.size() > 1; }));
  if (any_ties(evaluation.targets)) {
    text += ", with " + std::to_string(by) + (by == 1 ? " target that ties" : " targets that tie") + " scans together";
    if (evaluation.without_targets_m) text += " (" + tenths(1000 * *evaluation.without_targets_m) + " mm without)";
  }
  if (evaluation.registration && evaluation.registration->absolute_rms_m)
    text += ", and to " + tenths(1000 * *evaluation.registration->absolute_rms_m) + " mm in the site's frame";
  const double error_mm = 1000 * error_at_95_percent(rms_mm / 1000),
               most_mm = 1000 * largest_error_m(evaluation.accuracy_class);
  const std::string name = to_string(evaluation.accuracy_class) + " (" + number(most_mm) + " mm at 95 %)";
  const std::string beyond = beyond_text(evaluation, names);
  // Half a millimetre is what a calibration of the day leaves, whatever a prediction says.
  if (error_mm <= most_mm && evaluation.accuracy_class == AccuracyClass::loa50)
    return text + "; " + name + " is within reach, and no prediction promises it: check it on site";
  if (error_mm <= most_mm)
    return text + "; " + name + " is met with " + fixed(most_mm - error_mm, 1) + " mm to spare" +
           (beyond.empty() ? "" : ", but not at" + beyond);
  return text + "; " + name + " is missed by " + fixed(error_mm - most_mm, 1) + " mm" +
         (beyond.empty() ? "" : ", most at" + beyond);
}

// "a target or a sharp corner at C1 (3.21, 4.05, 2.87), 41° above or below the heads of S1 and S4: …",
// one for each instrument.
std::vector<SummaryLine> check_lines(const Evaluation& evaluation, const std::vector<std::string>& names) {
  std::vector<SummaryLine> lines;
  if (!wants_steep_check(evaluation)) return lines;
  const std::string why = ": level sights hide an error of the scanner's vertical index",
                    wanted = "a target more than " + fixed(kLeastElevation_deg, 0) +
                             "° above or below the heads of two stations";
  for (const Target& target : evaluation.targets) {
    if (!target.check) continue;
    double least = 90;
    for (const std::size_t station : target.stations)
      least = std::min(least, elevation_deg(evaluation.stations[station].position, target.centre));
    lines.push_back({"to check", "a target or a sharp corner at " + target.name + " (" + fixed(target.centre.x, 2) +
                                     ", " + fixed(target.centre.y, 2) + ", " + fixed(target.centre.z, 2) + "), " +
                                     fixed(least, 0) + "° or more above or below the heads of " +
                                     listed(target.stations, names) + why});
  }
  for (const std::string& instrument : evaluation.no_steep_check)
    lines.push_back({"to check", wanted + " of " + instrument + why +
                                     "; no surveyed surface is so steep for two of them within " +
                                     fixed(kLongestSight_m, 0) + " m: check it elsewhere"});
  if (lines.empty()) lines.push_back({"to check", wanted + why});
  return lines;
}

// "3 of 5 stations may be set up by known points: S1 (over P1, sights 2), S3 (resection from 3)"
std::string control_text(const Evaluation& evaluation, const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 12;
  const std::vector<KnownPoints> known = known_points(evaluation);
  if (known.empty()) return {};
  std::size_t may = 0;
  std::string text;
  for (std::size_t k = 0; k < known.size(); ++k) {
    if (!may_be_set_up(known[k])) continue;
    if (++may <= kNamed) text += (may > 1 ? ", " : ": ") + names[k] + " (" + set_up_text(known[k], evaluation) + ")";
  }
  if (may > kNamed) text += " and " + std::to_string(may - kNamed) + " more";
  const auto used = static_cast<std::size_t>(std::ranges::count_if(evaluation.stations, active));
  return (may == 0 ? "none" : std::to_string(may)) + " of " + counted(used, "station") +
         " may be set up by known points" + (may == 0 ? ", of which two in range are needed, three for a check" : text);
}

// A registration that misses its class.
std::vector<std::string> registration_advice(const Evaluation& evaluation, double rms_mm) {
  if (error_at_95_percent(rms_mm / 1000) <= largest_error_m(evaluation.accuracy_class)) return {};
  const std::string what = "surfaces do not hold the scans together to " + to_string(evaluation.accuracy_class) + ": ";
  const bool proposed =
      std::ranges::any_of(evaluation.targets, [](const Target& target) { return target.proposed && !target.check; });
  if (!evaluation.without_targets_m || (!proposed && any_ties(evaluation.targets)))
    return {what + "let targets be proposed, or add stations that share more walls"};
  return {what +
          (proposed ? "nor do the proposed targets; " : "no place for a target is near enough to two stations; ") +
          "put stations closer together, or take finer steps or larger targets"};
}

// A sentence for each station that is left out, or stands where none should.
std::vector<std::string> stations_advice(const Evaluation& evaluation, const std::vector<std::string>& names) {
  std::vector<std::string> advice;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const PlacedStation& station = evaluation.stations[k];
    if (station.status == StationStatus::ok) continue;
    const auto move = std::ranges::find(evaluation.moves, k, &StationMove::station);
    advice.push_back(names[k] + " " + explain(station.status) + (active(station) ? "" : ", and is left out") + ": " +
                     (move == evaluation.moves.end() ? "move it" : move_text(station.position, *move)));
  }
  return advice;
}

// "4.2 GB", "76 MB", "210 million", as few digits as an estimate has.
std::string amount(double value, const char* millions, const char* billions) {
  const bool large = value >= 999.5e6;
  const double shown = value / (large ? 1e9 : 1e6);
  return fixed(shown, shown < 9.95 ? 1 : 0) + " " + (large ? billions : millions);
}

// "about 210 million points: 4.2 GB as E57, 7.6 GB as LAS"
std::string data_text(const ScanData& data) {
  const std::string points = data.points < 1e6 ? grouped(static_cast<std::uint64_t>(std::llround(data.points)))
                                               : amount(data.points, "million", "billion");
  return "about " + points + " points: " + amount(data.e57_bytes, "MB", "GB") + " as E57, " +
         amount(data.las_bytes, "MB", "GB") + " as LAS";
}

// "96.3 % ± 0.4 % of what is attainable of IfcWall*, of which at least 95 % were asked for"
std::string of_meshes_text(const Requirement& requirement, const Estimate& share) {
  const std::string& meshes = requirement.objective.meshes;
  return (std::isnan(share.value)
              ? std::string("a share that is not known")
              : percent(share.value) + (share.standard_error > 0 ? " ± " + percent(share.standard_error) : "")) +
         " of what is attainable of " + (meshes.starts_with('!') ? "all but " + meshes.substr(1) : meshes) +
         ", of which " + (requirement.bound == Requirement::Bound::at_least ? "at least " : "at most ") +
         number(std::round(1e8 * requirement.limit) / 1e6) + " % were asked for";
}

std::vector<SummaryLine> of_meshes_lines(const Evaluation& evaluation, std::span<const Requirement> requirements) {
  std::vector<SummaryLine> lines;
  for (const Requirement& requirement : requirements)
    if (!requirement.objective.meshes.empty())
      lines.push_back({"captured", of_meshes_text(requirement, evaluation.estimate(requirement.objective.name))});
  return lines;
}

std::vector<std::string> requirements_advice(const Evaluation& evaluation, std::span<const Requirement> requirements) {
  std::vector<std::string> sentences;
  for (const Requirement& requirement : requirements) {
    const Estimate& value = evaluation.estimate(requirement.objective.name);
    if (requirement.missed_by(value) > 0) sentences.push_back(advice(requirement, value.value));
  }
  return sentences;
}

}  // namespace

std::string mixed_text(const MixedPoints& mixed, std::uint64_t points) {
  const auto share = [&](std::uint64_t many) {
    return points > 0 ? static_cast<double>(many) / static_cast<double>(points) : 0;
  };
  const auto told = [&](std::uint64_t many) {
    return many > 0 && share(many) < 0.0005 ? std::string("less than 0.1 %") : percent(share(many));
  };
  return told(mixed.points) + " of the points lie between surfaces, off all of them by more than 5 mm; " +
         told(mixed.wrong_voxel) + " lie in cells that nothing there returned them from, and do not count";
}

std::vector<SummaryLine> summary_lines(const Evaluation& evaluation, std::span<const Requirement> requirements) {
  const std::vector<std::string> names = station_names(evaluation.stations, evaluation.names);
  const std::optional<StationLinks> links = evaluation.links();
  std::vector<SummaryLine> lines{{"captured", captured_text(evaluation)}};
  const NetworkCounts& counts = evaluation.counts;
  std::ranges::move(of_meshes_lines(evaluation, requirements), std::back_inserter(lines));
  if (!counts.mixed.empty())
    lines.push_back(
        {"mixed", mixed_text(std::accumulate(counts.mixed.begin(), counts.mixed.end(), MixedPoints{}),
                             std::accumulate(counts.points.begin(), counts.points.end(), std::uint64_t{0}))});
  if (links) lines.push_back({"linked", links_text(*links, names)});
  const auto registered = evaluation.values.find("registration");
  const bool several = std::ranges::count_if(evaluation.stations, active) > 1;  // one scan is registered to nothing
  if (several && registered != evaluation.values.end() && std::isfinite(registered->second.value))
    lines.push_back({"registered", registered_text(evaluation, registered->second, names)});
  std::ranges::move(check_lines(evaluation, names), std::back_inserter(lines));
  if (std::string control = control_text(evaluation, names); !control.empty())
    lines.push_back({"control", std::move(control)});
  if (evaluation.visit)
    lines.push_back({"on site", evaluation.visit->sessions.empty() ? "about " + duration(60 * evaluation.visit->minutes)
                                                                   : sessions_text(*evaluation.visit)});
  if (evaluation.visit && evaluation.visit->bound > 0) lines.push_back({"hours", hours_text(*evaluation.visit)});
  if (evaluation.data && evaluation.data->points > 0) lines.push_back({"data", data_text(*evaluation.data)});
  if (evaluation.visit) std::ranges::move(battery_lines(*evaluation.visit), std::back_inserter(lines));
  const auto to_do = [&](const std::vector<std::string>& advice) {
    for (const std::string& text : advice) lines.push_back({"to do", text});
  };
  if (links) to_do(links_advice(*links, evaluation.stations, names));
  to_do(storeys_advice(evaluation.storey_ties, names));
  if (evaluation.visit && !evaluation.visit->not_split.empty())
    to_do({"not split into days: " + evaluation.visit->not_split});
  if (evaluation.visit) {
    const auto existing = static_cast<std::ptrdiff_t>(existing_count(evaluation.stations));
    const std::vector<std::string> placed(names.begin() + existing, names.end());
    to_do(hours_advice(*evaluation.visit, placed));
    to_do(sessions_advice(*evaluation.visit, placed));
  }
  to_do(stations_advice(evaluation, names));
  if (registered != evaluation.values.end() && std::isfinite(registered->second.value))
    to_do(registration_advice(evaluation, registered->second.value));
  to_do(requirements_advice(evaluation, requirements));
  return lines;
}

namespace {

// "storey 3 (z = 6.40 m): 480 m² of floor, no station"
void add_empty_floor(std::vector<SummaryLine>& lines, const std::vector<FloorPart>& parts) {
  constexpr std::size_t kNamed = 6;
  for (const FloorPart::Kind kind : {FloorPart::Kind::storey, FloorPart::Kind::building, FloorPart::Kind::room}) {
    std::vector<const FloorPart*> empty;
    std::size_t all = 0;
    for (const FloorPart& part : parts) {
      all += part.kind == kind;
      if (part.kind == kind && part.stations == 0) empty.push_back(&part);
    }
    if (empty.empty()) continue;
    std::string text =
        std::to_string(empty.size()) + " of " + std::to_string(all) + " " + to_string(kind) + "s without a station: ";
    if (kind == FloorPart::Kind::room)
      std::ranges::stable_sort(empty, std::ranges::greater{}, [](const FloorPart* part) { return part->area_m2; });
    for (std::size_t k = 0; k < std::min(kNamed, empty.size()); ++k) {
      const FloorPart& part = *empty[k];
      const std::string at = kind == FloorPart::Kind::building ? fixed(part.place.x, 1) + "," + fixed(part.place.y, 1)
                                                               : "z = " + fixed(part.place.z, 2) + " m";
      text += (k > 0 ? "; " : "") + part.name + " (" + at + ")" +
              (part.area_m2 > 0 ? ", " + fixed(part.area_m2, part.area_m2 < 10 ? 1 : 0) + " m² of floor"
                                : ", none of its floor is reached");
    }
    if (empty.size() > kNamed) text += "; and " + std::to_string(empty.size() - kNamed) + " more";
    lines.push_back({"no station", std::move(text)});
  }
}

// A pattern for a name, in single quotes for a shell.
std::string quoted_pattern(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return c == '\'' || c < 0x20; }, '?');
  return "'" + name + "'";
}

constexpr double kLowestRung_m = 0.1;

// "behind a closed door", "behind 2 closed doors, a headroom of 1.62 m under them", …
std::string barred(const ClosedPart& part) {
  const std::string doors = part.doors.empty()       ? std::string()
                            : part.doors.size() == 1 ? std::string("a closed door")
                                                     : number(part.doors.size()) + " closed doors";
  const std::string metres = fixed(part.height_m, 2) + " m";
  if (part.kind == ClosedKind::low) return "with a headroom of " + metres;
  const std::string too = doors.empty() ? "" : " and " + doors;
  switch (part.bar) {
    case Bar::door: return "behind " + (doors.empty() ? std::string("a closed door") : doors);
    case Bar::headroom: return "behind a headroom of " + metres + too + ", where a person stoops";
    case Bar::climb:
      return "up or down a ladder, or a stair as steep as one" +
             (part.height_m >= kLowestRung_m ? ", with steps of up to " + metres : std::string()) + too;
    case Bar::step: return (part.height_m > 0 ? "beyond a step of " + metres : "beyond a gap in the floor") + too;
    case Bar::no_way: break;
  }
  return "that nothing leads to";
}

// The settings that plan a closed part, too.
std::string planned_with(const ClosedPart& part, const std::string& entries) {
  if (part.kind == ClosedKind::low) {
    constexpr double kCap_m = 0.1;  // of the scanner above its centre, and a little
    const std::string headroom = fixed(std::floor(part.height_m / 0.05 - 1e-6) * 0.05, 2);
    return "passage 0.6," + headroom + ", headroom " + headroom + " and height " + fixed(part.height_m - 2 * kCap_m, 1);
  }
  if (part.bar != Bar::door || part.doors.empty()) {
    const Vec3& p = part.place;
    return entries + "enter " + fixed(p.x, 2) + "," + fixed(p.y, 2) + "," + fixed(p.z, 2);
  }
  std::string text;
  for (const std::string& door : part.doors) text += (text.empty() ? "ignore " : " and ignore ") + quoted_pattern(door);
  return text;
}

// "13.2 m² of floor (4 % of all) at z = 0.15 m (Archive)"
std::string floor_text(const ClosedPart& part, const Scene& scene) {
  constexpr double kSkin_m = 0.3;  // a room's box may begin above its floor
  const auto room = room_at(scene.rooms(), part.place, kSkin_m);
  return fixed(part.area_m2, 1) + " m² of floor (" + percent(part.share) + " of all) at z = " + fixed(part.place.z, 2) +
         " m" + (room ? " (" + scene.rooms()[*room].name + ")" : std::string());
}

// "the door is 'Door 12'", of many the first.
std::string some_doors(const std::vector<std::string>& doors) {
  constexpr std::size_t kNamed = 3;
  std::string text = doors.size() == 1 ? "the door is " : "the doors are ";
  for (std::size_t k = 0; k < std::min(kNamed, doors.size()); ++k)
    text += (k > 0 ? ", " : "") + quoted_pattern(doors[k]);
  return text + (doors.size() > kNamed ? " and " + number(doors.size() - kNamed) + " more" : "");
}

// A line for each closed part that the surveyor has to decide on, and one for all others of a kind.
void add_closed(std::vector<SummaryLine>& lines, const Scene& scene, const SearchArea& area) {
  constexpr std::size_t kMost = 5;
  std::string entries;
  for (const Vec3& p : area.entries())
    entries += "enter " + fixed(p.x, 2) + "," + fixed(p.y, 2) + "," + fixed(p.z, 2) + " and ";
  double rest = 0;
  std::size_t told = 0, more = 0;
  for (const ClosedPart& part : area.not_entered()) {
    if (!part.to_decide()) continue;
    if (told++ < kMost)
      lines.push_back({"closed", floor_text(part, scene) + " " + barred(part) + ": not reached; plan it too with " +
                                     planned_with(part, entries)});
    else
      rest += part.area_m2, ++more;
  }
  if (more > 0) lines.push_back({"closed", fixed(rest, 1) + " m² of floor in " + number(more) + " more such parts"});
  for (const auto& [kind, where] :
       {std::pair{ClosedKind::attic, "under slopes of roofs or on ceilings, with no way up"},
        std::pair{ClosedKind::top, "on top of what stands on the floor"},
        std::pair{ClosedKind::hollow, "inside of what has no opening"}}) {
    double sum = 0, share = 0;
    const ClosedPart* largest = nullptr;
    for (const ClosedPart& part : area.not_entered()) {
      if (part.kind != kind || part.to_decide()) continue;
      sum += part.area_m2, share += part.share;
      if (!largest) largest = &part;
    }
    if (largest)
      lines.push_back({"closed", fixed(sum, 1) + " m² (" + percent(share) + " of all floor) " + where +
                                     ", not planned: the largest at " + fixed(largest->place.x, 2) + "," +
                                     fixed(largest->place.y, 2) + "," + fixed(largest->place.z, 2)});
  }
}

// A network with more stations than one for so much floor may be right for what is asked, and is no usual survey.
void add_crowded(std::vector<SummaryLine>& lines, const SearchArea& area, std::span<const PlacedStation> stations) {
  constexpr double kFloorOfStation_m2 = 5;
  const auto count = static_cast<double>(std::ranges::count_if(stations, active));
  double floor_m2 = 0;
  const SearchMesh& mesh = area.mesh();
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    floor_m2 += std::abs(cross(b - a, c - a).z) / 2;
  }
  if (count < 2 || floor_m2 >= kFloorOfStation_m2 * count) return;
  lines.push_back({"crowded", number(count) + " stations on " + surface_text(floor_m2) +
                                  " of floor, more than one for each " + surface_text(kFloorOfStation_m2) +
                                  ": look whether so many are needed"});
}

// The reason why a choice of stations ended, where it is not that a further one adds too little.
std::string ended_by(const PlanResult& result, const PlanEntry& entry, const Estimate& captured) {
  const SurveyProblem& problem = result.problem;
  if (result.pays) {
    const bool fewer = captured.value + captured.standard_error < result.pays->capture;
    if (!met(result)) return {};
    if (entry.stations.size() - problem.existing.size() >= problem.stations_max &&
        (fewer || (result.further && result.further->m2 >= result.pays->least_m2)))
      return ", with as many stations as are allowed";
    if (!fewer) return "";
    const bool in_time =
        std::ranges::any_of(problem.requirements, [](const Requirement& r) { return r.objective.needs.time; });
    return in_time ? ", in the time on site that is allowed" : ", as far as links reach";
  }
  for (const Requirement& requirement : problem.requirements) {
    if (!requirement.objective.needs.attainable || !requirement.objective.meshes.empty()) continue;
    if (requirement.bound != Requirement::Bound::at_least) continue;
    const std::string asked = number(std::round(1e8 * requirement.limit) / 1e6) + " %";
    if (captured.value >= requirement.limit) return ", and " + asked + " were asked for";
    if (requirement.missed_by(captured) > 0) return ", but " + asked + " were asked for";
    return ", which meets " + asked + " within the error" +
           (captured.standard_error > 0 ? " of " + percent(captured.standard_error) : std::string());
  }
  return problem.stations_min == problem.stations_max ? ", and so many were asked for" : "";
}

// "Leica RTC360 @6mm, 23 s a scan"
std::string scanner_text(const Scanner& scanner) {
  const double seconds = scanner.seconds();
  return scanner.name + ", " + (seconds < 100 ? fixed(seconds, 0) + " s" : fixed(seconds / 60, 0) + " min") + " a scan";
}

}  // namespace

std::vector<SummaryLine> ground_lines(const Scene& scene, const SearchArea& area,
                                      std::span<const PlacedStation> stations) {
  std::vector<SummaryLine> lines;
  if (area.on_plane()) lines.push_back({"ground", "none in the model: the stations stand on " + area.description()});
  if (std::ranges::any_of(scene.meshes(), [](const MeshInfo& mesh) { return mesh.name == kRoomFloors; }))
    lines.push_back({"ground",
                     "laid at the bottom of rooms that have no floor in the model, whose slabs may be in another file; "
                     "it blocks rays and is not surveyed"});
  add_crowded(lines, area, stations);
  if (std::ranges::any_of(stations, active)) add_empty_floor(lines, floor_parts(scene, area, stations));
  constexpr std::size_t kMost = 5;
  const std::span<const ClosedPart> entered = area.entered();
  double rest = 0;
  for (std::size_t k = 0; k < entered.size(); ++k)
    if (k < kMost)
      lines.push_back(
          {"entered", floor_text(entered[k], scene) + " " + barred(entered[k]) + ": planned as if entered" +
                          (entered[k].doors.empty() ? std::string() : "; " + some_doors(entered[k].doors))});
    else
      rest += entered[k].area_m2;
  if (rest > 0)
    lines.push_back(
        {"entered", fixed(rest, 1) + " m² of floor in " + number(entered.size() - kMost) + " more such parts"});
  add_closed(lines, scene, area);
  return lines;
}

std::vector<SummaryLine> again_lines(const Scene& scene, const Evaluation& evaluation) {
  constexpr std::size_t kNamed = 6;
  if (!evaluation.visit || evaluation.visit->sessions.size() < 2) return {};
  const std::size_t existing = existing_count(evaluation.stations);
  const std::vector<std::vector<std::size_t>> in_rooms = stations_in_rooms(scene.rooms(), evaluation.stations);
  std::size_t again = 0;
  std::string named;
  for (std::size_t k = 0; k < in_rooms.size(); ++k) {
    std::size_t sessions = 0;
    std::string when;
    for (const Session& session : evaluation.visit->sessions) {
      const auto inside = [&](std::size_t station) {
        return std::ranges::find(in_rooms[k], existing + station) != in_rooms[k].end();
      };
      if (std::ranges::none_of(session.order, inside)) continue;
      when += (++sessions > 1 ? "; " : "") + std::string("day ") + std::to_string(session.day) + ", crew " +
              std::to_string(session.crew);
    }
    if (sessions < 2) continue;
    if (++again <= kNamed) named += (again > 1 ? ", " : ": ") + scene.rooms()[k].name + " (" + when + ")";
  }
  if (again == 0) return {};
  if (again > kNamed) named += " and " + std::to_string(again - kNamed) + " more";
  return {
      {"again", counted(again, "room") + (again == 1 ? " is" : " are") + " entered by more than one session" + named}};
}

std::string entered_text(const SearchArea& area) {
  const std::span<const ClosedPart> entered = area.entered();
  if (entered.empty()) return {};
  double sum = 0, share = 0;
  for (const ClosedPart& part : entered) sum += part.area_m2, share += part.share;
  return "planned as if entered: " + fixed(sum, 1) + " m² of floor (" + percent(share) + " of all) " +
         (entered.size() > 1 ? "in " + number(entered.size()) + " parts, the largest " : std::string()) +
         barred(entered.front());
}

std::string planned_text(const PlanResult& result) {
  if (result.front.empty() || !result.problem.fewest) return {};
  const PlanEntry& entry = result.front[answer(result)];
  const auto captured = entry.values.find("capture");
  if (captured == entry.values.end() || std::isnan(captured->second.value)) return {};
  const std::size_t kept = result.problem.existing.size(), placed = entry.stations.size() - kept;
  std::string text = std::to_string(placed) + (kept > 0 ? " further" : "") + (placed == 1 ? " station" : " stations") +
                     (kept > 0 ? " and " + std::to_string(kept) + " that " + (kept == 1 ? "exists" : "exist") : "") +
                     (entry.stations.size() == 1 ? " captures " : " capture ") + percent(captured->second.value) +
                     " of what is attainable" + ended_by(result, entry, captured->second);
  if (!result.further) return text;
  constexpr double kLeastTold_m2 = 0.05;
  const auto [m2, minutes] = *result.further;
  if (m2 < kLeastTold_m2) return text + "; a further one would add nothing";
  const bool too_little = result.pays && m2 < result.pays->least_m2;
  const bool reads_alike = too_little && surface_text(m2) == surface_text(result.pays->least_m2);
  text += std::string("; a further one would add ") + (reads_alike ? "just under " : "some ") + surface_text(m2) +
          " in " + duration(60 * std::max(minutes, 1.0));
  if (!too_little) return text;
  text += ", and has to add " + surface_text(result.pays->least_m2);
  if (result.problem.pays_share > 0 && result.pays->least_m2 > result.problem.pays_m2.value_or(0))
    text += ", " + percent(result.problem.pays_share / static_cast<double>(std::max(few_for_average, placed + kept))) +
            " of what all of these capture";
  return text;
}

std::vector<SummaryLine> summary_lines(const PlanResult& result) {
  const PlanEntry& entry = result.front.at(answer(result));
  std::vector<SummaryLine> lines = summary_lines(entry);
  const std::vector<SummaryLine> of_meshes = of_meshes_lines(entry, result.problem.requirements);
  lines.insert(lines.begin() + 1, of_meshes.begin(), of_meshes.end());
  if (std::string planned = planned_text(result); !planned.empty())
    lines.insert(lines.begin(), {"planned", std::move(planned)});
  if (result.scanners.size() == 1) lines.insert(lines.begin(), {"scanner", scanner_text(result.scanners.front())});
  for (std::string& help : what_would_help(result)) lines.push_back({"to do", std::move(help)});
  if (!result.area || !result.scene) return lines;
  for (SummaryLine& line : ground_lines(*result.scene, *result.area, result.front[answer(result)].stations))
    lines.insert(line.heading == "ground" ? lines.begin() : lines.end(), std::move(line));
  std::ranges::move(again_lines(*result.scene, entry), std::back_inserter(lines));
  return lines;
}

std::string lines_text(std::span<const SummaryLine> lines) {
  std::string text, last;
  for (const SummaryLine& line : lines) {
    std::string heading = line.heading == last ? "" : line.heading;
    last = line.heading;
    heading.resize(11, ' ');
    text += heading + line.text + "\n";
  }
  return text;
}

std::string summary_text(const Evaluation& evaluation, std::span<const Requirement> requirements) {
  return lines_text(summary_lines(evaluation, requirements));
}
std::string summary_text(const PlanResult& result) { return lines_text(summary_lines(result)); }

std::string registration_jump_text(std::span<const TradeOffPoint> points) {
  constexpr double kMuch = 2;
  constexpr double kSmall_mm = 1;  // below that any is good
  const auto value = [](const TradeOffPoint& point, const char* measure) {
    const auto found = point.values.find(measure);
    return found == point.values.end() ? std::numeric_limits<double>::quiet_NaN() : found->second.value;
  };
  const TradeOffPoint *best = nullptr, *worse = nullptr, *fewer = nullptr;
  double most = kMuch;
  for (const TradeOffPoint& point : points) {
    const double here = value(point, "registration");
    if (!std::isfinite(here)) continue;
    if (best && here > kSmall_mm && here > most * value(*best, "registration"))
      most = here / value(*best, "registration"), worse = &point, fewer = best;
    if (!best || here < value(*best, "registration")) best = &point;
  }
  if (!worse) return {};
  const auto stations = [](const TradeOffPoint& point) { return std::to_string(point.stations.size()); };
  std::string text = stations(*worse) + " stations register to " + tenths(value(*worse, "registration")) + " mm, " +
                     stations(*fewer) + " to " + tenths(value(*fewer, "registration")) +
                     " mm: each number is a network of its own, chosen by what it captures";
  const double weak = value(*worse, "link"), strong = value(*fewer, "link");
  if (weak < strong)
    text += ", and the scans of the " + stations(*worse) + " are held together by a link of " + fixed(weak, 2) +
            ", those of the " + stations(*fewer) + " by one of " + fixed(strong, 2);
  return text;
}

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
  const bool targets = !result.front.empty() && any_ties(result.front[answer(result)].targets);
  std::string text =
      "stations   captured  registered  on site" + std::string(targets ? "  (without targets)" : "") + "\n";
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!shown[k]) continue;
    const TradeOffPoint& point = points[k];
    const auto cell = [](std::string value, std::size_t width) {
      return std::string(width > value.size() ? width - value.size() : 0, ' ') + value;
    };
    const auto registered = point.values.find("registration");
    const bool known = registered != point.values.end() && std::isfinite(registered->second.value);
    text += cell(std::to_string(point.stations.size()), 8) + cell(percent(point.values.at("capture").value), 11) +
            cell(known ? fixed(registered->second.value, 1) + " mm" : "–", known ? 12 : 14) + "  " +
            (point.minutes_on_site ? duration(60 * *point.minutes_on_site) : "–") +
            (point.answer ? "  <- the plan" : "") + (point.knee ? "  <- beyond this each station gains less" : "") +
            "\n";
  }
  if (const std::string jump = registration_jump_text(points); !jump.empty()) text += jump + "\n";
  return text;
}

std::string unmet_text(const PlanResult& result) {
  std::string text;
  for (const Requirement& requirement : result.problem.requirements) {
    const std::string& name = requirement.objective.name;
    double best = std::nan(""), least = std::numeric_limits<double>::infinity();
    for (const PlanEntry& entry : result.front) {
      const double value = entry.value(name), missed = requirement.missed_by(entry.estimate(name));
      if (missed < least) least = missed, best = value;
    }
    if (result.front.empty() || !(least > 0)) continue;
    if (requires_what_pays(result, requirement)) {
      text += "what pays is " + percent(requirement.limit) + " of what is attainable; the best network has " +
              (std::isnan(best) ? std::string("an unknown share") : percent(best)) + "\n";
      continue;
    }
    text += "no network has its " + in_words(requirement) +
            (std::isnan(best) ? "" : ": the best has " + value_text(requirement, best)) + "\n";
  }
  return text;
}

}  // namespace vantage
