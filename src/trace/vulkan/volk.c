// SPDX-License-Identifier: Apache-2.0
// The loader of Vulkan functions, compiled into the library: its package ships it as a source.
#include <volk.c>
