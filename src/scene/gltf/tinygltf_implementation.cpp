// SPDX-License-Identifier: Apache-2.0
// The only place that compiles tinygltf's code.
#define TINYGLTF_IMPLEMENTATION
#include "scene/gltf/file.hpp"
