// SPDX-License-Identifier: Apache-2.0
// VANTAGE_TARGET_CLONES before a function compiles it for the baseline and for AVX2 (with population count), chosen at
// program start. Both round alike, since contraction is off. Sanitizers start after that choice, so they get only the
// baseline.
#pragma once

#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__clang__)
#define VANTAGE_TARGET_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define VANTAGE_TARGET_CLONES
#endif
