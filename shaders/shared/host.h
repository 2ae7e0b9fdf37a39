// SPDX-License-Identifier: Apache-2.0
// Lets C++ read the shaders' structs. Scalar layout: every member at its C++ offset, vec3 four-byte aligned.
#ifndef VANTAGE_SHARED_HOST_H
#define VANTAGE_SHARED_HOST_H

#ifdef __cplusplus
#include <cstdint>
namespace vantage {
// clang-format off
using uint = std::uint32_t;
using uint64_t = std::uint64_t;
struct vec3 { float x, y, z; };
struct uvec2 { uint x, y; };
// clang-format on
}  // namespace vantage
#define VANTAGE_SHARED_BEGIN namespace vantage {
#define VANTAGE_SHARED_END }
#define VANTAGE_CONST inline constexpr
#define VANTAGE_INLINE inline
#else
#define VANTAGE_SHARED_BEGIN
#define VANTAGE_SHARED_END
#define VANTAGE_CONST const
#define VANTAGE_INLINE
#endif

#endif
