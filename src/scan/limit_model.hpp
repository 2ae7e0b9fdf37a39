// SPDX-License-Identifier: Apache-2.0
// Limits of points in the form that engines compare. All square roots and angles are computed here, in double.
#pragma once

#include <optional>

#include "scene/scene_data.hpp"
#include "trace/tracer.hpp"
#include "vantage/scanner.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// Returns true if a ray of the scanner may hit something within range without an echo.
bool loses_echoes(const Scanner& scanner);

// Returns the largest angle between ray and normal at which a point counts; empty if points have no limits.
std::optional<Angle> incidence_limit(const SceneData& scene, const SimulatorConfig& config);

// Returns limits that are not enabled if points have none. `always`: enabled even then, since another scanner of the
// simulator limits its own points. Throws Error invalid_argument: an incidence not in (0°, 90°], a detail without the
// scanner's beam, an accuracy without its noise.
LimitModel make_limit_model(const SceneData& scene, const Scanner& scanner, const SimulatorConfig& config,
                            bool always = false);

}  // namespace vantage
