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

std::string otherwise(const std::string& help, double usual) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.6g", usual);
  return help + "; " + buffer.data() + " otherwise";
}

constexpr Interval share{.low = 0, .high = 1};

std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> names;
  for (const auto part : split(text, ',')) names.emplace_back(part);
  return names;
}

template <class Options>
auto number_of(double Options::*member, Interval interval) {
  return [member, interval](Options& options, const std::string& text, const std::string& what) {
    options.*member = parse_number(text, what, interval);
  };
}

}  // namespace

const SettingTable<OnSiteOptions>& on_site_settings() {
  static const SettingTable<OnSiteOptions> table =
      SettingRows<OnSiteOptions>()
          .group("Problem")
          .custom("set-up", "MIN",
                  otherwise("Minutes at each station besides the scan itself", OnSiteOptions().set_up_min),
                  number_of(&OnSiteOptions::set_up_min, not_negative))
          .custom("walking", "M/S",
                  otherwise("How fast one walks with the scanner, in metres a second", OnSiteOptions().walking_m_per_s),
                  number_of(&OnSiteOptions::walking_m_per_s, positive))
          .take();
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
                otherwise("Error of a scan's surface, besides range noise, that is the same over a patch",
                          usual.model.rho_m),
                number([](Options& o) -> double& { return o.model.rho_m; }, {.low = 1e-6, .high = 1}))
        .custom("registration-patch", "M", otherwise("Side of such a patch", usual.model.patch_m),
                number([](Options& o) -> double& { return o.model.patch_m; }, {.low = 1e-3, .high = 100}))
        .custom("registration-position", "M",
                otherwise("Standard deviation of a head's position before registration", usual.position_m),
                number([](Options& o) -> double& { return o.position_m; }, {.low = 1e-6, .high = 1e4}))
        .custom("registration-heading", "DEG",
                otherwise("Standard deviation of a scan's heading before registration", usual.heading.in_degrees()),
                degrees(&Options::heading, {.low = 1e-6, .high = 180}))
        .custom("registration-tilt", "DEG",
                otherwise("Standard deviation of a scan's tilts, by its compensator; 0: exactly level, some degrees: "
                          "not levelled",
                          usual.tilt.in_degrees()),
                degrees(&Options::tilt, {.low = 0, .high = 180}))
        .custom("registration-surfaces", "surveyed|all",
                "What holds scans together: surveyed surfaces, or also those that nobody surveys; surveyed otherwise",
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
          .text("problem", "PROBLEM",
                "survey (otherwise; the fewest stations that capture and link enough), or " + list_of(problem_names()),
                &Question::problem)
          .number("capture", "SHARE",
                  otherwise("Share of what can be seen that the survey has to capture", default_capture),
                  &Question::capture, share)
          .number("link", "SHARE",
                  otherwise("Least scan overlap, along some spanning tree, that all stations are linked by: the share "
                            "of the smaller scan that the other sees too, over all surfaces",
                            default_link),
                  &Question::link, share)
          .number("apart", "M",
                  otherwise("Least distance between two stations, none with the problems by name", default_apart_m),
                  &Question::apart_m, not_negative)
          .optional("max-time-on-site", "T", "Longest time that the survey may take on site: 90min or 6h",
                    &Question::minutes_on_site,
                    [](const std::string& text, const std::string& what) { return parse_duration(text, what) / 60; })
          .include(on_site_settings(), &Question::on_site)
          .custom(
              "objectives", "LIST",
              "What to search for once the number is decided, or with a number of stations at once: any of " +
                  list_of(objective_names()),
              [](Question& q, const std::string& text, const std::string&) { q.objectives = names_in(text); },
              [](const Question& q) { return !q.objectives.empty(); })
          .texts(
              "require", "OBJECTIVE>=LIMIT",
              "What a network has to keep, as coverage>=0.9 or stations<=8; may be repeated",
              [](Question & q) -> auto& { return q.requirements; })
          .optional("stations", "N|A..B",
                    "How many stations, or from A to B (A,B) where the number is searched, up to " +
                        std::to_string(max_stations),
                    &Question::stations,
                    [](const std::string& text, const std::string& what) {
                      std::string range = text;
                      if (const auto comma = range.find(','); comma != std::string::npos) range.replace(comma, 1, "..");
                      const CountRange found = parse_count_range(range, what, 1, max_stations);
                      return std::array{found.low, found.high};
                    })
          .custom(
              "search-step", "LIST",
              "Choose each station's step among these: degrees, as 0.2,0.1,0.05, or settings of the scanner, as "
              "12mm,3mm",
              [](Question& q, const std::string& text, const std::string&) { q.search_steps = names_in(text); },
              [](const Question& q) { return !q.search_steps.empty(); })
          .numbers("heights", "LOW,HIGH", "Search each station's height between these, in metres", &Question::heights_m,
                   2, not_negative)
          .number("link-overlap", "W",
                  otherwise("Overlap from which on two stations count as linked, 0 to 1", default_link_overlap),
                  &Question::link_overlap, share)
          .number("min-overlap", "W",
                  "Want every station linked to the others by overlaps of at least W: a link-overlap of W, with "
                  "parts<=1 required",
                  &Question::min_overlap, share)
          .optional("fitness", "L1,L2,L3",
                    "One network by a fitness of coverage, number and visibility with these weights, as 0.4,0.4,0.2",
                    &Question::fitness,
                    [](const std::string& text, const std::string& what) {
                      const auto weights = parse_numbers(text, what, 3, 3, not_negative);
                      return FitnessWeights{weights[0], weights[1], weights[2]};
                    })
          .include(registration_settings(), &Question::registration)
          .take();
  return table;
}

const SettingTable<PlanConfig>& plan_settings() {
  using Config = PlanConfig;
  static const SettingTable<Config> table =
      SettingRows<Config>()
          .group("Search")
          .count("population", "M",
                 "Networks per iteration; with one objective 10, or 20 where it searches the number; else 100",
                 &Config::population, 2, 100'000)
          .count("iterations", "K", "Iterations of M networks each; by the site, or 100 for problems by name",
                 &Config::iterations, 1, 100'000'000)
          .count("batch", "B", "Networks asked for at once by the steady state; by the engine otherwise",
                 &Config::batch, 1, 100'000)
          .count("redraws", "N", "How often stations in holes or clashes are drawn again; 8 otherwise",
                 &Config::redraws, 0, 10'000)
          .count("stagnation", "K", "Stop when nothing has improved for K iterations", &Config::stagnation_iterations,
                 1, 100'000'000)
          .custom("sigma", "S", "First step, as a share of the search area; 0.2 otherwise",
                  number_of(&Config::sigma0, {.low = 0, .high = 10, .low_included = false}))
          .custom("scheme", "SCHEME", "steady-state or generational",
                  [](Config& c, const std::string& text, const std::string& what) {
                    if (text != "steady-state" && text != "generational")
                      throw Error(Errc::invalid_argument,
                                  what + ": '" + text + "' is neither steady-state nor generational");
                    c.scheme = text == "generational" ? MoCmaEsConfig::Scheme::generational
                                                      : MoCmaEsConfig::Scheme::steady_state;
                  })
          .custom("max-time", "T", "Be done after so long, with all that a plan takes: 90, 90s, 15min or 2h",
                  [](Config& c, const std::string& text, const std::string& what) {
                    c.max_seconds = parse_duration(text, what);
                  })
          .optional("target-hypervolume", "V", "Stop when the front has this hypervolume, 0 to 1",
                    &Config::target_hypervolume,
                    [](const std::string& text, const std::string& what) { return parse_number(text, what, share); })
          .flag("exact", "Search with every ray instead of a sample of voxels", &Config::exact)
          .custom(
              "sample", "N|P%",
              "Search with so many voxels all along; otherwise 20000 for coverage alone, 100000 with overlap, and for "
              "a front 5000, others every 20 iterations",
              [](Config& c, const std::string& text, const std::string& what) {
                const SampleSize size = parse_sample(text, what);
                c.sample_voxels = size.voxels.value_or(0), c.sample_share = size.share;
              },
              [](const Config& c) { return c.sample_voxels > 0 || c.sample_share; })
          .excludes({"exact"})
          .optional("renew", "K",
                    "Draw other voxels every K iterations, so that nothing is kept for its luck, and choose the front "
                    "by every ray from all that is kept at the end",
                    &Config::renew_iterations,
                    [](const std::string& text, const std::string& what) {
                      return static_cast<std::size_t>(parse_count(text, what, 1, 100'000'000));
                    })
          .excludes({"exact"})
          .group("Results")
          .custom("save-every", "T", "Time between checkpoints, which a resumed run goes on from; 1min otherwise",
                  [](Config& c, const std::string& text, const std::string& what) {
                    c.checkpoint_seconds = parse_duration(text, what);
                  })
          .flag("resume", "Go on from the folder's checkpoint", &Config::resume)
          .take();
  return table;
}

}  // namespace vantage
