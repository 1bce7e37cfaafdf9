#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

#include "bench/support/floor.h"

namespace uw::bench {

/// Times `work` on `threads` threads as the benchmark's own time, each time between two rounds of
/// the floor on as many, so that what else the machine does disturbs both. Sets the counters
/// `cpu_s` (all threads), `floor_s` and `x_floor`, the ratio of the two.
void measure(benchmark::State& state, const Floor& floor, int threads,
             const std::function<void()>& work);

/// One benchmark: `prepare` makes what all its repetitions share, a function that measures one.
struct Benchmark {
    std::string name;
    std::function<std::function<void(benchmark::State&)>()> prepare;
};

/// The whole of a benchmark program; returns its exit code. Benchmarks are prepared one at a time,
/// each when it is its turn. One iteration per repetition, timed by the CPU time of the process and
/// by the wall.
int run_benchmarks(int argc, char** argv, const std::vector<Benchmark>& benchmarks);

}  // namespace uw::bench
