// SPDX-License-Identifier: Apache-2.0
// What all kernels are told about scene, pattern, voxels and noise. A uniform block, because drivers keep those at
// hand: an array's address read from memory before every element would cost as much as the element.
#ifndef VANTAGE_LIB_PARAMETERS
#define VANTAGE_LIB_PARAMETERS
#include "lib/references.glsl"

layout(set = 0, binding = 0, scalar) uniform ParameterBlock { TraceParameters parameters; };

#endif
