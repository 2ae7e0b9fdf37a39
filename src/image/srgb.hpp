// SPDX-License-Identifier: Apache-2.0
// sRGB codes and linear light (IEC 61966-2-1).
#pragma once

#include <cstdint>

#include "core/glm.hpp"

namespace vantage {

using LinearColour = glm::vec4;  // red, green, blue, alpha; linear

float linear_from_srgb8(std::uint8_t code);
// The nearest of the 256 codes, exactly; clamps to [0, 1], NaN gives 0.
std::uint8_t srgb8_from_linear(float linear);

// 0xAABBGGRR; alpha is linear.
std::uint32_t pack_srgb(const LinearColour& colour);

}  // namespace vantage
