#pragma once

/// Placed before the definition of a function whose loops benefit from wider vector registers than
/// all processors have: the compiler emits a version for each of these targets and the loader picks
/// the widest that the machine supports. Results are bit-identical: nothing is contracted or
/// reordered. Not under the thread sanitizer, whose code would run in the loader before it is
/// ready.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define UWVDB_VECTOR_CLONES [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
#else
#define UWVDB_VECTOR_CLONES
#endif
