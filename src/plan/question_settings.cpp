// SPDX-License-Identifier: Apache-2.0
#include <span>

#include "core/setting_table.hpp"
#include "vantage/question.hpp"

namespace vantage {
namespace {

std::string list_of(std::span<const std::string> names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

constexpr Interval share{.low = 0, .high = 1};

std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> names;
  for (const auto part : split(text, ',')) names.emplace_back(part);
  return names;
}

}  // namespace

const SettingTable<OnSiteOptions>& on_site_settings() {
  static const SettingTable<OnSiteOptions> table =
      SettingRows<OnSiteOptions>()
          .group("Problem")
          .number("set-up", "MIN", "Minutes at each station besides the scan itself", &OnSiteOptions::set_up_min,
                  not_negative)
          .number("photos", "MIN", "Minutes at each station for pictures, where the scanner takes some",
                  &OnSiteOptions::photos_min, not_negative)
          .number("walking", "M/S", "Walking speed with the scanner, in metres per second",
                  &OnSiteOptions::walking_m_per_s, positive)
          .take();
  return table;
}

const SettingTable<TargetOptions>& target_settings() {
  using Options = TargetOptions;
  static const SettingTable<Options> table = [] {
    return SettingRows<Options>()
        .group("Targets")
        .number("target-diameter", "M", "Diameter of a target, a sphere or checkerboard", &Options::diameter_m,
                {.low = 0.01, .high = 2})
        .number("target-height", "M", "Height of a proposed target's centre above the ground", &Options::height_m,
                {.low = 0.05, .high = 10})
        .number("target-sigma", "M", "Standard deviation of a target's centre in a scan, besides range noise",
                &Options::sigma_m, {.low = 1e-5, .high = 0.1})
        .custom("accuracy-class", "LOA20|LOA30|LOA40|LOA50",
                "What the registration error is judged by, at 95 %: 50, 15, 5 or 1 mm; LOA30 otherwise",
                [](Options& options, const std::string& text, const std::string& what) {
                  options.wanted = named(what, [&] { return accuracy_class_from_string(text); });
                })
        .take();
  }();
  return table;
}

const SettingTable<RegistrationOptions>& registration_settings() {
  static const SettingTable<RegistrationOptions> table = [] {
    using Options = RegistrationOptions;
    const Options usual;
    const auto number = [](auto member, Interval interval) {
      return [member, interval](Options& options, const std::string& text, const std::string& what) {
        member(options) = parse_number(text, what, interval);
      };
    };
    const auto degrees = [](Angle Options::*member, Interval interval) {
      return [member, interval](Options& options, const std::string& text, const std::string& what) {
        options.*member = Angle::degrees(parse_number(text, what, interval));
      };
    };
    return SettingRows<Options>()
        .group("Registration")
        .custom("registration-rho", "M",
                otherwise("Modelling error of a scan's surface besides range noise, the same over a patch, in metres",
                          usual.model.rho_m),
                number([](Options& o) -> double& { return o.model.rho_m; }, {.low = 1e-6, .high = 1}))
        .custom("registration-patch", "M", otherwise("Side of such a patch, in metres", usual.model.patch_m),
                number([](Options& o) -> double& { return o.model.patch_m; }, {.low = 1e-3, .high = 100}))
        .custom("registration-position", "M",
                otherwise("Standard deviation of a head's position before registration, in metres", usual.position_m),
                number([](Options& o) -> double& { return o.position_m; }, {.low = 1e-6, .high = 1e4}))
        .custom("registration-heading", "DEG",
                otherwise("Standard deviation of a scan's heading before registration, in degrees",
                          usual.heading.in_degrees()),
                degrees(&Options::heading, {.low = 1e-6, .high = 180}))
        .custom("registration-tilt", "DEG",
                otherwise("Standard deviation of a scan's tilts, from its compensator, in degrees; 0: exactly level, "
                          "some degrees: not levelled",
                          usual.tilt.in_degrees()),
                degrees(&Options::tilt, {.low = 0, .high = 180}))
        .custom("registration-surfaces", "surveyed|all",
                "Surfaces that scans register on: surveyed ones, or all; surveyed otherwise",
                [](Options& options, const std::string& text, const std::string& what) {
                  if (text != "all" && text != "surveyed")
                    throw Error(Errc::invalid_argument, what + ": '" + text + "' is neither surveyed nor all");
                  options.surfaces = text == "all" ? RegistrationSurfaces::all : RegistrationSurfaces::surveyed;
                })
        .take();
  }();
  return table;
}

const SettingTable<SurveyQuestion>& question_settings() {
  using Question = SurveyQuestion;
  static const SettingTable<Question> table =
      SettingRows<Question>()
          .group("Problem")
          .text(
              "problem", "PROBLEM",
              "survey (the default: the fewest connected stations that capture enough), or " + list_of(problem_names()),
              &Question::problem)
          .number("capture", "SHARE",
                  otherwise("Least share of what is attainable that the survey captures", default_capture),
                  &Question::capture, share)
          .number("link", "SHARE",
                  otherwise("Least scan overlap of the links that connect all stations: the share of the smaller scan "
                            "that the other sees too, over all surfaces",
                            default_link),
                  &Question::link, share)
          .number(
              "apart", "M",
              otherwise("Least distance between two stations, in metres; none for problems by name", default_apart_m),
              &Question::apart_m, not_negative)
          .optional("max-time-on-site", "T", "Longest time of the survey on site: 90min or 6h",
                    &Question::minutes_on_site,
                    [](const std::string& text, const std::string& what) { return parse_duration(text, what) / 60; })
          .include(on_site_settings(), &Question::on_site)
          .custom(
              "objectives", "LIST",
              "Objectives of the search once the number is decided, or at once if a number is given: any of " +
                  list_of(objective_names()),
              [](Question& q, const std::string& text, const std::string&) { q.objectives = names_in(text); },
              [](const Question& q) { return !q.objectives.empty(); })
          .texts(
              "require", "OBJECTIVE>=LIMIT",
              "Requirement on the network, such as coverage>=0.9 or stations<=8; may be repeated",
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
          .custom(
              "search-step", "LIST",
              "Steps to choose from for each station: degrees, such as 0.2,0.1,0.05, or settings of the scanner, "
              "such as 12mm,3mm",
              [](Question& q, const std::string& text, const std::string&) { q.search_steps = names_in(text); },
              [](const Question& q) { return !q.search_steps.empty(); })
          .numbers("heights", "LOW,HIGH", "Range of heights to search for each station, in metres",
                   &Question::heights_m, 2, not_negative)
          .number("link-overlap", "W", otherwise("Least overlap of a link, 0 to 1", default_link_overlap),
                  &Question::link_overlap, share)
          .number("min-overlap", "W",
                  "Least overlap of the links that connect all stations: sets link-overlap to W and requires "
                  "parts<=1",
                  &Question::min_overlap, share)
          .optional("fitness", "L1,L2,L3",
                    "Search one network of the largest fitness: weights of coverage, number and visibility, such as "
                    "0.4,0.4,0.2",
                    &Question::fitness,
                    [](const std::string& text, const std::string& what) {
                      const auto weights = parse_numbers(text, what, 3, 3, not_negative);
                      return FitnessWeights{weights[0], weights[1], weights[2]};
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
          .include(target_settings(), &Question::target)
          .take();
  return table;
}

const SettingTable<PlanConfig>& plan_settings() {
  using Config = PlanConfig;
  static const SettingTable<Config> table =
      SettingRows<Config>()
          .group("Search")
          .count("population", "M",
                 "Networks per iteration; with one objective 10, or 20 if the number is searched; else 100",
                 &Config::population, 2, 100'000)
          .count("iterations", "K", "Iterations of M networks each; depends on the site, or 100 for problems by name",
                 &Config::iterations, 1, 100'000'000)
          .count("batch", "B", "Networks that the steady state asks for at once; depends on the engine by default",
                 &Config::batch, 1, 100'000)
          .count("redraws", "N", "Attempts to redraw stations in holes or clashes; 8 otherwise", &Config::redraws, 0,
                 10'000)
          .count("stagnation", "K", "Stop when nothing has improved for K iterations", &Config::stagnation_iterations,
                 1, 100'000'000)
          .number("sigma", "S", "First step, as a share of the search area", &Config::sigma0,
                  {.low = 0, .high = 10, .low_included = false})
          .custom("scheme", "SCHEME", "Scheme of MO-CMA-ES: steady-state or generational",
                  [](Config& c, const std::string& text, const std::string& what) {
                    if (text != "steady-state" && text != "generational")
                      throw Error(Errc::invalid_argument,
                                  what + ": '" + text + "' is neither steady-state nor generational");
                    c.scheme = text == "generational" ? MoCmaEsConfig::Scheme::generational
                                                      : MoCmaEsConfig::Scheme::steady_state;
                  })
          .custom("max-time", "T", "Time limit of the whole plan: 90, 90s, 15min or 2h",
                  [](Config& c, const std::string& text, const std::string& what) {
                    c.max_seconds = parse_duration(text, what);
                  })
          .optional("target-hypervolume", "V", "Stop when the front has this hypervolume, 0 to 1",
                    &Config::target_hypervolume,
                    [](const std::string& text, const std::string& what) { return parse_number(text, what, share); })
          .flag("exact", "Search with every ray instead of a sample of voxels", &Config::exact)
          .custom(
              "sample", "N|P%",
              "Number or share of voxels for the whole search; otherwise 20000 for coverage alone, 100000 with "
              "overlap, "
              "and for a front 5000, redrawn every 20 iterations",
              [](Config& c, const std::string& text, const std::string& what) {
                const SampleSize size = parse_sample(text, what);
                c.sample_voxels = size.voxels.value_or(0), c.sample_share = size.share;
              },
              [](const Config& c) { return c.sample_voxels > 0 || c.sample_share; })
          .excludes({"exact"})
          .optional("renew", "K",
                    "Redraw the voxels every K iterations, so that no network survives by luck, and choose the front "
                    "from the archive by every ray at the end",
                    &Config::renew_iterations,
                    [](const std::string& text, const std::string& what) {
                      return static_cast<std::size_t>(parse_count(text, what, 1, 100'000'000));
                    })
          .excludes({"exact"})
          .group("Results")
          .custom("save-every", "T", "Time between checkpoints, from which a run can be resumed; 1min otherwise",
                  [](Config& c, const std::string& text, const std::string& what) {
                    c.checkpoint_seconds = parse_duration(text, what);
                  })
          .flag("resume", "Continue from the folder's checkpoint", &Config::resume)
          .take();
  return table;
}

}  // namespace vantage
