// SPDX-License-Identifier: Apache-2.0
#include "vantage/objective.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/closest_name.hpp"
#include "core/text.hpp"
#include "objective/built_in/built_in.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

struct BuiltIn {
  std::string name;
  Objective (*make)(const ObjectiveSettings&);
};

const auto& built_in_objectives() {
  static const std::array all{
#define VANTAGE_OBJECTIVE(name) BuiltIn{#name, built_in::name},
#include "built_in_objectives.inc"
#undef VANTAGE_OBJECTIVE
  };
  return all;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

[[noreturn]] void refuse_requirement(std::string_view text, const std::string& why) {
  throw Error(Errc::invalid_argument, "\"" + std::string(text) + "\" is no requirement: " + why);
}

[[noreturn]] void refuse_scale(const std::string& what, const std::string& order, double best, double worst) {
  throw Error(Errc::invalid_argument, what + ": the scale must have best " + order + " worst, both finite, not best " +
                                          number(best) + " and worst " + number(worst));
}

constexpr double kShareKnownTo = 0.0005;

}  // namespace

RequiredInputs required_inputs_of(std::span<const Objective> objectives) {
  RequiredInputs needs{.counts = false};
  for (const Objective& objective : objectives) needs = needs | objective.needs;
  return needs;
}

Scale minimise(double best, double worst) {
  if (!(best <= worst && std::isfinite(best) && std::isfinite(worst))) refuse_scale("minimise", "<=", best, worst);
  return {best, worst};
}

Scale maximise(double best, double worst) {
  if (!(best >= worst && std::isfinite(best) && std::isfinite(worst))) refuse_scale("maximise", ">=", best, worst);
  return {best, worst};
}

double Objective::unscaled(double f) const {
  const auto [best, worst] = scale;
  if (by_alpha)
    return static_cast<double>(
        station_count_from_alpha(f, static_cast<std::size_t>(best), static_cast<std::size_t>(worst)));
  return best - f * (best - worst);
}

double Requirement::missed_by(double measured) const { return missed_by(Estimate{measured, 0}); }

double Requirement::missed_by(const Estimate& measured) const {
  const auto [value, error] = measured;
  if (std::isnan(value)) return std::numeric_limits<double>::infinity();
  const double known_to = objective.needs.attainable ? std::max(kShareKnownTo, error) : 0;
  const double short_of = (bound == Bound::at_least ? limit - value : value - limit) - known_to;
  const double width = objective.scale.width();
  return short_of > 0 ? short_of / (width > 0 ? width : 1) : 0;
}

std::string to_string(const Requirement& requirement) {
  return requirement.objective.name + (requirement.bound == Requirement::Bound::at_least ? " >= " : " <= ") +
         number(requirement.limit);
}

std::string value_text(const Objective& objective, double value) {
  if (std::isnan(value)) return "not known";
  if (objective.percent) return percent(value);
  return fixed(value, 3) + (objective.unit.empty() ? "" : " " + objective.unit);
}

std::string value_text(const Requirement& requirement, double value) {
  const std::string text = value_text(requirement.objective, value);
  if (requirement.objective.percent && text == value_text(requirement.objective, requirement.limit))
    for (int digits = 2; digits < 7; ++digits)
      if (std::string finer = fixed(100 * value, digits); finer != fixed(100 * requirement.limit, digits))
        return finer + " %";
  return text;
}

std::string in_words(const Requirement& requirement) {
  const Objective& objective = requirement.objective;
  return (objective.noun.empty() ? objective.name : objective.noun) +
         (requirement.bound == Requirement::Bound::at_least ? " at least " : " at most ") +
         (objective.percent        ? number(std::round(1e8 * requirement.limit) / 1e6) + " %"
          : objective.unit.empty() ? number(requirement.limit)
                                   : number(requirement.limit) + " " + objective.unit);
}

std::string advice(const Requirement& requirement, double measured, bool ended_early) {
  const std::string what = "not met: " + in_words(requirement) + ", ";
  if (std::isnan(measured)) return what + "not measured before the time was over; allow more time";
  return what + "it has " + value_text(requirement, measured) + "; " +
         (ended_early ? "the time was over first: allow more time" : requirement.objective.advice) +
         ", or ask for less";
}

std::span<const std::string> objective_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const BuiltIn& one : built_in_objectives()) all.push_back(one.name);
    return all;
  }();
  return names;
}

Objective make_objective(std::string_view name, const ObjectiveSettings& settings) {
  if (constexpr std::string_view kOf = "capture("; name.starts_with(kOf) && name.ends_with(')'))
    return built_in::capture_of(name.substr(kOf.size(), name.size() - kOf.size() - 1));
  std::string known;
  for (const BuiltIn& one : built_in_objectives()) {
    if (one.name == name) return one.make(settings);
    known += (known.empty() ? "" : ", ") + one.name + (one.name == "capture" ? ", capture(MESHES)" : "");
  }
  throw Error(Errc::invalid_argument, "unknown objective \"" + std::string(name) + "\"; known: " + known +
                                          did_you_mean(name, objective_names()));
}

Requirement make_requirement(std::string_view text, const ObjectiveSettings& settings) {
  const std::size_t at = text.find_last_of("<>");  // names of meshes may hold others
  if (at == std::string_view::npos || at + 1 >= text.size() || text[at + 1] != '=')
    refuse_requirement(text, "write OBJECTIVE>=LIMIT or OBJECTIVE<=LIMIT, as coverage>=0.9");
  const std::string_view digits = trimmed(text.substr(at + 2));
  Requirement requirement{.objective = make_objective(trimmed(text.substr(0, at)), settings),
                          .bound = text[at] == '>' ? Requirement::Bound::at_least : Requirement::Bound::at_most};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), requirement.limit);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(requirement.limit))
    refuse_requirement(text, "\"" + std::string(digits) + "\" is not a number");
  return requirement;
}

std::size_t station_count_from_alpha(double alpha, std::size_t n_min, std::size_t n_max) {
  if (!(alpha > 0) || n_max <= n_min) return n_min;  // also for NaN
  if (alpha >= 1) return n_max;
  const double extra = alpha * static_cast<double>(n_max - n_min);
  const double whole = std::floor(extra);
  return n_min + static_cast<std::size_t>(whole) + (extra - whole >= 0.5 ? 1 : 0);
}

}  // namespace vantage
