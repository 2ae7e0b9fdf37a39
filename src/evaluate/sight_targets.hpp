// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "vantage/placement.hpp"
#include "vantage/registration.hpp"
#include "vantage/simulator.hpp"
#include "vantage/targets.hpp"

namespace vantage {

// Throws Error invalid_argument unless the target's place is within reach of the scene's origin and its sigma is a
// length, survey frame and metres.
void check(const Target& target, const Vec3& origin);

// Fills `Target::stations`, and returns the targets as `registration_error()` takes them. A station measures a target
// if the line between them is free, it lies within the scanner's field and range, and enough points fall on it: the
// target's disc over range² · Δazimuth · Δzenith · sin zenith. The variance of a centre is sigma² + 3 σ²/N for N
// points of range noise σ, and what the scanner's angles leave across the line, its ranges along it. Throws Error
// invalid_argument.
std::vector<RegistrationTarget> sight_targets(const Simulator& simulator, const ClashChecker& clash,
                                              std::span<const PlacedStation> stations, std::vector<Target>& targets,
                                              const TargetOptions& options = {});

}  // namespace vantage
