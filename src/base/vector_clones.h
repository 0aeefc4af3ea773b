// RELOOK_VECTOR_CLONES before a function: one body, compiled for several instruction sets, of which one is chosen when
// the program starts. Lane-wise IEEE arithmetic without contraction gives the same bits on all of them. It is a macro
// because the attribute exists for some compilers and processors only; sanitizers instrument the choosing itself, too
// early in the program's life.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define RELOOK_VECTOR_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define RELOOK_VECTOR_CLONES
#endif
