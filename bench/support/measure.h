#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

#include "bench/support/floor.h"

namespace uw::bench {

/// Times `work` on `threads` threads as the benchmark's own time, each time between two rounds of
/// the floor on as many, so that what else the machine does disturbs both. Sets the counters
/// `cpu_s` (all threads), `floor_s` and `x_floor`, the ratio of the two.
void measure(benchmark::State& state, const Floor& floor, int threads,
             const std::function<void()>& work);

/// Registers `run` so that the library repeats it and tells medians: one iteration each, timed by
/// the CPU time of the process and by the wall.
void add_benchmark(const std::string& name, const std::function<void(benchmark::State&)>& run);

}  // namespace uw::bench
