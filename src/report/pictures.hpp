// SPDX-License-Identifier: Apache-2.0
// The pictures before they are files: drawn once, saved as PNG and as SVG.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "report/canvas.hpp"
#include "vantage/placement.hpp"
#include "vantage/planner.hpp"
#include "vantage/scene.hpp"

namespace vantage {

std::unique_ptr<Canvas> front_picture(const PlanResult& result);
std::unique_ptr<Canvas> hypervolume_picture(const PlanResult& result);
std::unique_ptr<Canvas> history_picture(const PlanResult& result);
std::unique_ptr<Canvas> plan_view_picture(const Scene& scene, const SearchArea& area,
                                          std::span<const PlacedStation> stations, const OverlapMatrix& overlap,
                                          double link_overlap, const std::string& title);

}  // namespace vantage
