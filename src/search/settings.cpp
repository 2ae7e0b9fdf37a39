// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/options_json.hpp"
#include "core/setting_list.hpp"
#include "core/setting_table.hpp"
#include "core/text.hpp"
#include "vantage/problem.hpp"

namespace vantage {
namespace {

nlohmann::ordered_json to_json(const Objective& objective) {
  return {{"name", objective.name},
          {"label", objective.label},
          {"unit", objective.unit},
          {"best", objective.scale.best},
          {"worst", objective.scale.worst},
          {"by_alpha", objective.by_alpha},
          {"parameters", objective.parameters}};
}

nlohmann::ordered_json to_json(const std::vector<Target>& targets) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Target& target : targets)
    json.push_back({{"name", target.name},
                    {"centre", {target.centre.x, target.centre.y, target.centre.z}},
                    {"sigma_m", target.control_m}});
  return json;
}

}  // namespace

Settings settings(const SurveyProblem& problem) {
  nlohmann::ordered_json objectives = nlohmann::ordered_json::array(), requirements = objectives;
  std::string names;
  for (const Objective& objective : problem.objectives) {
    objectives.push_back(to_json(objective));
    names += (names.empty() ? "" : ",") + objective.name;
  }
  for (const Requirement& requirement : problem.requirements) requirements.push_back(to_string(requirement));
  const bool named = std::ranges::count(problem_names(), problem.name) > 0;
  const std::string low = std::to_string(problem.stations_min), high = std::to_string(problem.stations_max);
  Settings list = SettingList()
                      .add("problem", problem.name, {.option = named ? "problem" : "", .decides = false})
                      .add("stations", low == high ? low : low + ".." + high, {"stations"})
                      .add("existing", problem.existing, {"keep"})
                      .add("heights_m", problem.heights_m, {"heights"})
                      .add("objective_names", names, {.option = named ? "" : "objectives"})
                      .add("objectives", objectives)
                      .add("requirements", requirements, {"require"})
                      .add("link_overlap", problem.link_overlap, {"link-overlap"})
                      .add("fewest", problem.fewest)
                      .add("attainable", problem.attainable)
                      .take();
  for (Setting& setting : settings(problem.on_site)) list.push_back(std::move(setting));
  // Setups of the existing stations, if any differs from the usual one.
  SettingList setups;
  if (!problem.existing_setups.empty()) setups.add("existing_setups", problem.existing_setups);
  if (!problem.scanners.empty()) {
    nlohmann::ordered_json scanners = nlohmann::ordered_json::array();
    for (const Scanner& scanner : problem.scanners) scanners.push_back(settings_json(settings(scanner)));
    setups.add("scanners", scanners);
  }
  if (problem.every_echo) setups.add("every_echo", true);
  if (problem.pays_m2) setups.add("pays_m2", *problem.pays_m2, {"pays"});
  if (problem.pays_share > 0) setups.add("pays_share", problem.pays_share);
  // Targets are proposed for the answer of a search, and decide nothing in it.
  if (problem.targets) setups.add("targets", *problem.targets, {"targets", false});
  if (!problem.existing_targets.empty())
    setups.add("existing_targets", to_json(problem.existing_targets), {.decides = false});
  for (Setting& setting : setups.take()) list.push_back(std::move(setting));
  const Settings usual_target = settings(TargetOptions{});
  Settings target = settings(problem.target);
  for (std::size_t k = 0; k < target.size(); ++k) {
    target[k].decides = false;
    if (target[k].json != usual_target[k].json) list.push_back(std::move(target[k]));
  }
  const Settings usual = settings(RegistrationOptions{});
  for (std::size_t k = 0; k < usual.size(); ++k) {
    Setting setting = settings(problem.registration)[k];
    setting.name = "registration_" + setting.name;
    if (setting.json == usual[k].json) setting.option.clear();
    list.push_back(std::move(setting));
  }
  return list;
}

Settings settings(const PlanConfig& config) {
  const auto unless = [](bool open, const char* option) { return std::string(open ? "" : option); };
  const bool generational = config.scheme == MoScheme::generational;
  return SettingList()
      .add("population", config.population, {unless(config.population == 0, "population")})
      .add("iterations", config.iterations, {unless(config.iterations == 0, "iterations"), false})
      .add("sigma0", config.sigma0, {"sigma"})
      .add("scheme", generational ? "generational" : "steady-state", {"scheme"})
      .add("batch", config.batch, {unless(config.batch == 0, "batch")})
      .add("sample_voxels", config.sample_voxels, {unless(config.sample_voxels == 0, "sample")})
      .add("renew_iterations", config.renew_iterations.value_or(0),
           {unless(config.renew_iterations.value_or(0) == 0, "renew")})
      .add("start", config.start, {"start"})
      .add("redraws", config.redraws, {"redraws"})
      .add("max_seconds", config.max_seconds, {unless(config.max_seconds == 0, "max-time"), false})
      .add("target_hypervolume", config.target_hypervolume, {"target-hypervolume", false})
      .add("stagnation_iterations", config.stagnation_iterations,
           {unless(config.stagnation_iterations == 0, "stagnation"), false})
      .add("seed", config.seed.value_or(1), {"seed"})
      .take();
}

const SettingTable<PlanConfig>& plan_settings() {
  using Config = PlanConfig;
  static const SettingTable<Config> table =
      SettingRows<Config>()
          .group("Search")
          .count("population", "M",
                 "Networks per iteration; with one objective 10, or 20 if the number is searched; else 100",
                 &Config::population, 2, 100'000)
          .advanced()
          .count("iterations", "K", "Iterations of M networks each; depends on the site, or 100 for problems by name",
                 &Config::iterations, 1, 100'000'000)
          .advanced()
          .count("batch", "B", "Networks that the steady state asks for at once; depends on the engine by default",
                 &Config::batch, 1, 100'000)
          .advanced()
          .count("redraws", "N", "Attempts to redraw stations in holes or clashes; 8 otherwise", &Config::redraws, 0,
                 10'000)
          .advanced()
          .count("stagnation", "K", "Stop when nothing has improved for K iterations", &Config::stagnation_iterations,
                 1, 100'000'000)
          .advanced()
          .number("sigma", "S", "First step, as a share of the search area", &Config::sigma0,
                  {.low = 0, .high = 10, .low_included = false})
          .advanced()
          .custom("scheme", "SCHEME", "Scheme of MO-CMA-ES: steady-state or generational",
                  [](Config& c, const std::string& text, const std::string& what) {
                    if (text != "steady-state" && text != "generational")
                      throw Error(Errc::invalid_argument,
                                  what + ": '" + text + "' is neither steady-state nor generational");
                    c.scheme = text == "generational" ? MoScheme::generational : MoScheme::steady_state;
                  })
          .advanced()
          .custom("max-time", "T", "Time limit of the whole plan: 90, 90s, 15min or 2h",
                  [](Config& c, const std::string& text, const std::string& what) {
                    c.max_seconds = parse_duration(text, what);
                  })
          .checked([](const Config& c, const std::string& what) { check_number(c.max_seconds, what, kAnySeconds); })
          .optional(
              "target-hypervolume", "V", "Stop when the front has this hypervolume, 0 to 1",
              &Config::target_hypervolume,
              [](const std::string& text, const std::string& what) { return parse_number(text, what, kAnyShare); })
          .advanced()
          .checked([](const Config& c, const std::string& what) {
            if (c.target_hypervolume) check_number(*c.target_hypervolume, what, kAnyShare);
          })
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
          .advanced()
          .checked([](const Config& c, const std::string& what) {
            if (c.sample_share) check_number(*c.sample_share, what, {.low = 0, .high = 1, .low_included = false});
          })
          .excludes({"exact"})
          .optional("renew", "K",
                    "Redraw the voxels every K iterations, so that no network survives by luck, and choose the front "
                    "from the archive by every ray at the end",
                    &Config::renew_iterations,
                    [](const std::string& text, const std::string& what) {
                      return static_cast<std::size_t>(parse_count(text, what, 1, 100'000'000));
                    })
          .advanced()
          .excludes({"exact"})
          .group("Results")
          .custom("save-every", "T", "Time between checkpoints, from which a run can be resumed; 1min otherwise",
                  [](Config& c, const std::string& text, const std::string& what) {
                    c.checkpoint_seconds = parse_duration(text, what);
                  })
          .advanced()
          .checked(
              [](const Config& c, const std::string& what) { check_number(c.checkpoint_seconds, what, kAnySeconds); })
          .flag("resume", "Continue from the folder's checkpoint", &Config::resume)
          .take();
  return table;
}

}  // namespace vantage
