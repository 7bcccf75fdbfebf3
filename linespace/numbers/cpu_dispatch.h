// Functions compiled for several kinds of processor, chosen when the program starts.

#pragma once

/// Before a function whose plain loops over arrays gain by wider vectors.  Results are
/// the same bit by bit: contraction is off and the order of operations is as written.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    defined(__linux__)
#define SIGHTLINE_WIDE_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define SIGHTLINE_WIDE_VECTORS
#endif
