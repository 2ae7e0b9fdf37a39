// SPDX-License-Identifier: Apache-2.0
// What points must be to count, as engines compare it: all that takes a square root or an angle is done here, in
// double.
#pragma once

#include <optional>

#include "scene/scene_data.hpp"
#include "trace/tracer.hpp"
#include "vantage/scanner.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// The largest angle between ray and normal at which a point counts; empty where points have no limits.
std::optional<Angle> incidence_limit(const SceneData& scene, const SimulatorConfig& config);

// Not enabled where points have no limits. Throws Error invalid_argument: an incidence not in (0°, 90°], a detail where
// the scanner's beam is not known, an accuracy where its noise is not.
LimitModel make_limit_model(const SceneData& scene, const Scanner& scanner, const SimulatorConfig& config);

}  // namespace vantage
