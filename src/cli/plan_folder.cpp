// SPDX-License-Identifier: Apache-2.0
#include "cli/plan_folder.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <string>

#include "cli/options.hpp"
#include "core/options_json.hpp"
#include "core/read_json.hpp"
#include "formats/station_json.hpp"
#include "plan/limits.hpp"

namespace vantage::cli {
namespace {

// In the form of --keep.
std::string typed(const Vec3& head, const StationSetup& setup, std::span<const Scanner> scanners, std::string name) {
  const Scanner& scanner = scanners[setup.scanner];
  std::string text = fmt::format("x={},y={},z={},heading={},tilt={}", head.x, head.y, head.z,
                                 setup.heading.in_degrees(), setup.tilt.in_degrees());
  if (scanner.directions.empty()) text += fmt::format(",step={}", scanner.azimuth_step.in_degrees());
  text += ",scanner=" + scanner.name;
  nlohmann::json all;
  add_setup(all, setup, scanners);
  for (const char* key : {"zenith_step", "horizontal", "vertical", "zenith_start", "nearest", "farthest"})
    if (all.contains(key)) {
      std::string option = key;
      std::ranges::replace(option, '_', '-');
      text += fmt::format(",{}={}", option, all[key].get<double>());
    }
  std::ranges::replace(name, ',', ' '), std::ranges::replace(name, '=', ' ');  // they mean something here
  return name.empty() ? text : text + ",name=" + name;
}

// The default requirements of a survey have their own options, so that 0 can remove one.
void add_requirements(nlohmann::json& options, const SurveyProblem& problem) {
  nlohmann::json further = nlohmann::json::array();
  for (const char* own : {"capture", "link", "apart"}) options[own] = 0;
  if (problem.pays_m2) options.erase("capture");
  if (problem.pays_share > 0) options.erase("pays");  // the default, which goes by the average too
  for (const Requirement& requirement : problem.requirements) {
    const std::string& name = requirement.objective.name;
    if (options.contains(name) && requirement.bound == Requirement::Bound::at_least)
      options[name] = requirement.limit;
    else if (!requires_capture(requirement) || requirement.limit > 0)
      further.push_back(to_string(requirement));
  }
  options["require"] = std::move(further);
  options["problem"] = problem.name;
}

}  // namespace

nlohmann::json plan_options(const Site& site, const SurveyQuestion& question, const SurveyProblem& problem,
                            const PlanConfig& config) {
  const std::vector<std::string>& names = problem.existing_names;
  nlohmann::json options = options_json(settings(problem));
  const bool named = std::ranges::any_of(names, [](const std::string& name) { return !name.empty(); });
  if (!problem.existing_setups.empty() || named) {
    options["keep"] = nlohmann::json::array();
    for (std::size_t k = 0; k < problem.existing.size(); ++k) {
      const StationSetup setup = problem.existing_setups.empty() ? StationSetup() : problem.existing_setups[k];
      options["keep"].push_back(typed(problem.existing[k], setup, site.scanners(), k < names.size() ? names[k] : ""));
    }
  }
  if (!question.search_steps.empty()) options["search-step"] = fmt::format("{}", fmt::join(question.search_steps, ","));
  if (question.asks_for_fewest()) add_requirements(options, problem);
  options.update(options_json(settings(config)));
  if (config.exact) options["exact"] = true;
  if (question.fitness)
    options["fitness"] = {question.fitness->coverage, question.fitness->station_count, question.fitness->visibility};
  nlohmann::json all = options_json(site.settings());
  all["plan"] = std::move(options);
  return all;
}

EarlierResults earlier_results(const std::filesystem::path& folder, const nlohmann::json& options) {
  EarlierResults before;
  std::error_code ignored;
  const auto read = [](const std::filesystem::path& file) {
    try {
      return read_json(file.string());
    } catch (const Error&) {
      return nlohmann::json();  // damaged, or not a plan's: ignored
    }
  };
  if (std::filesystem::exists(folder / "config.json", ignored))
    before.another_run = read(folder / "config.json") != options;
  if (std::filesystem::exists(folder / "front.json", ignored)) {
    const nlohmann::json results = read(folder / "front.json");
    if (!results.is_object()) return before;
    before.evaluations = results.value("evaluations", std::uint64_t{0});
    for (const auto& entry : results.value("front", nlohmann::json::array()))
      if (entry.is_object() && entry.contains("exact") && !entry["exact"].is_null()) ++before.confirmed;
  }
  return before;
}

}  // namespace vantage::cli
