// SPDX-License-Identifier: Apache-2.0
// The checksum CRC-32C (Castagnoli's polynomial, RFC 3720 appendix B.4), eight bytes at a time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vantage {

std::uint32_t crc32c(const void* data, std::size_t bytes);

}  // namespace vantage
