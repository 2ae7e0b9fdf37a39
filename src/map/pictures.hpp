// SPDX-License-Identifier: Apache-2.0
// Pictures before they are files: drawn once, saved as PNG and as SVG.
#pragma once

#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "map/canvas.hpp"
#include "map/plan_map.hpp"
#include "vantage/evaluation.hpp"
#include "vantage/placement.hpp"
#include "vantage/planner.hpp"
#include "vantage/scene.hpp"

namespace vantage {

std::unique_ptr<Canvas> front_picture(const PlanResult& result);
std::unique_ptr<Canvas> hypervolume_picture(const PlanResult& result);
std::unique_ptr<Canvas> history_picture(const PlanResult& result);

// A page of a plan view: all floors, and for several floors one more for each.
struct PlanPage {
  std::string suffix;  // of the file's name: "" or "-level-2"
  std::unique_ptr<Canvas> canvas;
};
// Pages after the first that are not begun when `late` is requested have no canvas. Throws Error invalid_argument if
// there is nothing to show, or the matrix does not belong to the stations.
std::vector<PlanPage> plan_view_pictures(const PlanView& view, const std::stop_token& late = {});

}  // namespace vantage
