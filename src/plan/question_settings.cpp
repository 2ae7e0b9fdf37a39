// SPDX-License-Identifier: Apache-2.0
#include <span>

#include "core/setting_table.hpp"
#include "core/site_reach.hpp"
#include "vantage/question.hpp"

namespace vantage {
namespace {

std::string list_of(std::span<const std::string> names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> names;
  for (const auto part : split(text, ',')) names.emplace_back(part);
  return names;
}

}  // namespace

const SettingTable<SurveyQuestion>& question_settings() {
  using Question = SurveyQuestion;
  static const SettingTable<Question> table =
      SettingRows<Question>()
          .group("Problem")
          .text("problem", "PROBLEM",
                "survey (the default: the connected stations that pay, or the fewest that capture --capture), or " +
                    list_of(problem_names()),
                &Question::problem)
          .number("capture", "SHARE",
                  "Least share of what is attainable that the survey captures, whatever it takes: instead of --pays",
                  &Question::capture, kAnyShare)
          .number("pays", "M2",
                  otherwise("Surface that the others do not capture, in square metres, which a station has to add: the "
                            "survey has as many stations as do, and one in every room and part of the floor",
                            default_pays_m2) +
                      ", or a tenth of what a station captures on average if that is more",
                  &Question::pays_m2, kPositive)
          .number("link", "SHARE",
                  otherwise("Least scan overlap of the links that connect all stations: the share of the smaller scan "
                            "that the other sees too, over all surfaces",
                            default_link),
                  &Question::link, kAnyShare)
          .number(
              "apart", "M",
              otherwise("Least distance between two stations, in metres; none for problems by name", default_apart_m),
              &Question::apart_m, {.low = 0, .high = kSiteReach_m})
          .optional("max-time-on-site", "T", "Longest time of the survey on site: 90min or 6h",
                    &Question::minutes_on_site,
                    [](const std::string& text, const std::string& what) { return parse_duration(text, what) / 60; })
          .checked([](const Question& q, const std::string& what) {
            if (q.minutes_on_site) check_number(*q.minutes_on_site, what, kPositive);
          })
          .include(on_site_settings(), &Question::on_site)
          .custom(
              "objectives", "LIST",
              "Objectives of the search once the number is decided, or at once if a number is given: any of " +
                  list_of(objective_names()),
              [](Question& q, const std::string& text, const std::string&) { q.objectives = names_in(text); },
              [](const Question& q) { return !q.objectives.empty(); })
          .texts(
              "require", "OBJECTIVE>=LIMIT",
              "Requirement on the network, such as coverage>=0.9, stations<=8 or capture(IfcWall*)>=0.95 by meshes; "
              "may be repeated",
              [](Question & q) -> auto& { return q.requirements; })
          .optional("stations", "N|A..B",
                    "Number of stations, or its range A to B (A,B) to search, up to " + std::to_string(max_stations),
                    &Question::stations,
                    [](const std::string& text, const std::string& what) {
                      std::string range = text;
                      if (const auto comma = range.find(','); comma != std::string::npos) range.replace(comma, 1, "..");
                      const CountRange found = parse_count_range(range, what, 1, max_stations);
                      return std::array{found.low, found.high};
                    })
          .checked([](const Question& q, const std::string& what) {
            if (q.stations)
              parse_count_range(std::to_string((*q.stations)[0]) + ".." + std::to_string((*q.stations)[1]), what, 1,
                                max_stations);
          })
          .custom(
              "search-step", "LIST",
              "Steps to choose from for each station: degrees, such as 0.2,0.1,0.05, or settings of the scanner, "
              "such as 12mm,3mm",
              [](Question& q, const std::string& text, const std::string&) { q.search_steps = names_in(text); },
              [](const Question& q) { return !q.search_steps.empty(); })
          .numbers("heights", "LOW,HIGH", "Range of heights to search for each station, in metres",
                   &Question::heights_m, 2, kNotNegative)
          .number("link-overlap", "W", otherwise("Least overlap of a link, 0 to 1", default_link_overlap),
                  &Question::link_overlap, kAnyShare)
          .advanced()
          .number("min-overlap", "W",
                  "Least overlap of the links that connect all stations: sets link-overlap to W and requires "
                  "parts<=1",
                  &Question::min_overlap, kAnyShare)
          .advanced()
          .optional("fitness", "L1,L2,L3",
                    "Search one network of the largest fitness: weights of coverage, number and visibility, such as "
                    "0.4,0.4,0.2",
                    &Question::fitness,
                    [](const std::string& text, const std::string& what) {
                      const auto weights = parse_numbers(text, what, 3, 3, kNotNegative);
                      return FitnessWeights{weights[0], weights[1], weights[2]};
                    })
          .advanced()
          .checked([](const Question& q, const std::string& what) {
            if (q.fitness)
              for (const double weight : {q.fitness->coverage, q.fitness->station_count, q.fitness->visibility})
                check_number(weight, what, kNotNegative);
          })
          .include(registration_settings(), &Question::registration)
          .group("Targets")
          .custom(
              "targets", "auto|off|N",
              "Targets to propose, spheres or checkerboards that tie scans together: as few as the registration needs "
              "where surfaces do not hold scans (auto, the default), none, or a number",
              [](Question& q, const std::string& text, const std::string& what) {
                if (text == "auto")
                  q.targets.reset();
                else
                  q.targets = text == "off" ? 0 : parse_count(text, what, 0, 1000);
              },
              [](const Question& q) { return q.targets.has_value(); })
          .checked([](const Question& q, const std::string& what) {
            if (q.targets) parse_count(std::to_string(*q.targets), what, 0, 1000);
          })
          .include(target_settings(), &Question::target)
          .take();
  return table;
}

}  // namespace vantage
