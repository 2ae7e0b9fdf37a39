// SPDX-License-Identifier: Apache-2.0
// The loader of Vulkan functions, compiled into the library since its package ships it as source.
#include <volk.c>
