#pragma once

/// Put before the definition of a function whose loops are worth wider registers than every
/// processor has: the compiler then makes one for each of these and the loader takes the widest
/// that the machine knows. Results are the same bits: nothing is contracted or reordered.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define UWVDB_VECTOR_CLONES [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
#else
#define UWVDB_VECTOR_CLONES
#endif
