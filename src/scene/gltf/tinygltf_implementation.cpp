// SPDX-License-Identifier: Apache-2.0
// The one place where tinygltf's code is compiled.
#define TINYGLTF_IMPLEMENTATION
#include "scene/gltf/file.hpp"
