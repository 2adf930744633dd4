// Kernels compiled for more than one kind of processor.
#pragma once

/// Before a function: it is compiled twice, once for processors with AVX2 and a population count, and the right one is
/// taken when the program starts. Only for work on whole numbers, whose results are the same either way. What it calls
/// must be inlined into it. The sanitizers and clang get the plain one.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define LODESTONE_CLONED __attribute__((target_clones("avx2", "default")))
#else
#define LODESTONE_CLONED
#endif
