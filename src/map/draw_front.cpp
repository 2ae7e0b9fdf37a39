// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "core/text.hpp"
#include "map/front_view.hpp"
#include "map/pictures.hpp"
#include "vantage/pictures.hpp"

namespace vantage {
namespace {

constexpr double kWidth = 780, kHeight = 600;

// An aborted search may not know a value.
bool known(const FrontDot& dot) { return std::isfinite(dot.x) && std::isfinite(dot.y); }

Rect frame(bool bar) { return {86, 72, kWidth - 86 - (bar ? 110 : 30), kHeight - 72 - 106}; }

}  // namespace

std::unique_ptr<Canvas> front_picture(const PlanResult& result) {
  const FrontView view(result);
  const bool sampled = result.config.sample_voxels > 0;
  std::vector<FrontDot> dots;
  bool any_confirmed = false;
  for (const PlanEntry& entry : result.front) {
    if (sampled || !entry.exact) dots.push_back(view.searched(entry));
    if (entry.exact) dots.push_back(view.confirmed(entry)), any_confirmed = true;
  }
  auto page = std::make_unique<Canvas>(kWidth, kHeight);
  Canvas& canvas = *page;
  const Rect area = frame(view.third() != nullptr);
  std::string subtitle = problem_line(result.problem);
  const double value = std::isnan(result.exact_hypervolume) ? result.hypervolume : result.exact_hypervolume;
  subtitle += ", hypervolume " + fixed(value, 3);
  subtitle += " after " + grouped(result.evaluations) + " evaluations";
  const Chart chart(canvas, area, view.x_axis(dots), view.y_axis(dots),
                    view.single() ? "Best network found" : "Pareto front", subtitle);
  if (view.third()) draw_colour_bar(canvas, area, view);

  std::vector<Rect> taken;
  const auto occupy = [&](Point p, double r) { taken.push_back({p.x - r, p.y - r, 2 * r, 2 * r}); };
  for (const PlanEntry& entry : result.front) {
    const FrontDot seen = view.searched(entry), exact = view.confirmed(entry);
    if (!known(seen)) continue;
    const Point a = chart.at(seen.x, seen.y), b = chart.at(exact.x, exact.y);
    if (!sampled && entry.exact) continue;
    if (entry.exact) canvas.line(a, b, {.colour = style::kPale, .width = 1});
    canvas.circle(a, 4, {.colour = view.third() ? view.colour(seen) : style::kBlue, .width = 1.1, .opacity = 0.75});
    occupy(a, 5);
  }
  bool any_dominated = false;
  for (const bool dominated : {true, false}) {  // the front itself on top
    for (const PlanEntry& entry : result.front) {
      if (!entry.exact || entry.dominated != dominated) continue;
      const FrontDot exact = view.confirmed(entry);
      const Point p = chart.at(exact.x, exact.y);
      canvas.disc(p, dominated ? 3.6 : 5.4, {1, 1, 1});
      canvas.disc(p, dominated ? 2.7 : 4.5, view.colour(exact), dominated ? 0.5 : 1);
      any_dominated |= dominated;
      occupy(p, 6);
    }
  }

  std::vector<LegendItem> legend;
  const Colour key = view.third() ? style::kFaint : style::kBlue;
  if (any_confirmed) legend.push_back({LegendItem::Mark::filled, key, "every ray"});
  if (any_dominated) legend.push_back({LegendItem::Mark::small, key, "dominated"});
  if (sampled)
    legend.push_back({LegendItem::Mark::hollow, key, "search, " + grouped(result.config.sample_voxels) + " voxels"});
  else if (!any_confirmed)
    legend.push_back({LegendItem::Mark::hollow, key, "as the search saw it"});
  const PlanEntry* best = result.front.empty() ? nullptr : &result.front[answer(result)];
  if (best && known(best->exact ? view.confirmed(*best) : view.searched(*best))) {
    const PlanEntry& chosen = *best;
    const FrontDot dot = chosen.exact ? view.confirmed(chosen) : view.searched(chosen);
    const Point p = chart.at(dot.x, dot.y);
    if (!view.single()) canvas.circle(p, 9, {.colour = style::kOrange, .width = 2.2});
    occupy(p, 11);
    const std::string words = view.words(chosen);
    const TextStyle text{.size = 12.5, .colour = style::kOrange, .across = Align::middle, .halo = 2};
    const Rect place = place_label(p, 13, canvas.text_width(words, text) + 6, 18,
                                   {area.x + 4, area.y + 4, area.width - 8, area.height - 8}, taken);
    canvas.text({place.x + place.width / 2, place.y + place.height / 2}, words, text);
    if (!view.single())
      legend.push_back({LegendItem::Mark::ring, style::kOrange,
                        result.problem.requirements.empty() ? "answer: nearest to the best of all"
                        : met(result)                       ? "answer: meets all requirements"
                                                            : "nearest to the requirements"});
  }
  draw_legend(canvas, {area.x, kHeight - 24}, legend);
  return page;
}

std::unique_ptr<Canvas> history_picture(const PlanResult& result) {
  const FrontView view(result);
  // Five moments, closer together at the start, when the front still moves.
  std::vector<const PlanIteration*> moments;
  if (!result.history.empty()) {
    const double last = static_cast<double>(result.history.size() - 1);
    for (const double share : {0.0, 0.04, 0.16, 0.45, 1.0}) {
      const PlanIteration* line = &result.history[static_cast<std::size_t>(share * last + 0.5)];
      if (moments.empty() || moments.back() != line) moments.push_back(line);
    }
  }
  std::vector<FrontDot> dots;
  for (const PlanIteration* line : moments)
    for (const auto& f : line->front)
      if (const auto dot = view.objectives(f)) dots.push_back(*dot);
  auto page = std::make_unique<Canvas>(kWidth, kHeight);
  Canvas& canvas = *page;
  const Rect area = frame(false);
  const Chart chart(canvas, area, view.x_axis(dots), view.y_axis(dots), "Convergence of the front",
                    problem_line(result.problem) + ", as the search saw it");
  std::vector<LegendItem> legend;
  for (std::size_t k = 0; k < moments.size(); ++k) {
    const double t = moments.size() == 1 ? 1 : static_cast<double>(k) / static_cast<double>(moments.size() - 1);
    const Colour colour = ramp(std::array<Colour, 3>{{{0.96, 0.72, 0.42}, {0.80, 0.36, 0.42}, style::kBlue}}, t);
    for (const auto& f : moments[k]->front) {
      if (const auto dot = view.objectives(f)) canvas.disc(chart.at(dot->x, dot->y), 3.6, colour, 0.85);
    }
    legend.push_back({LegendItem::Mark::filled, colour, "iteration " + std::to_string(moments[k]->iteration)});
  }
  draw_legend(canvas, {area.x - 40, kHeight - 24}, legend);
  return page;
}

void draw_front(const std::filesystem::path& file, const PlanResult& result) { front_picture(result)->save(file); }

void draw_history_fronts(const std::filesystem::path& file, const PlanResult& result) {
  history_picture(result)->save(file);
}

}  // namespace vantage
