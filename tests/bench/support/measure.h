#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/bench/support/floor.h"

namespace uw::bench {

/// Times `work` on `threads` threads as the benchmark's own time, each time between two rounds of
/// the floor on as many threads, so that other load on the machine disturbs both. Sets the counters
/// `cpu_s` (all threads), `floor_s` and `x_floor`, the ratio of the two.
void measure(benchmark::State& state, const Floor& floor, int threads,
             const std::function<void()>& work);

/// One benchmark: `prepare` makes what all its repetitions share and returns a function that
/// measures one.
struct Benchmark {
    std::string name;
    std::function<std::function<void(benchmark::State&)>()> prepare;
};

/// The main function of a benchmark program; returns its exit code. Benchmarks are prepared one at
/// a time, just before they run. One iteration per repetition, timed by the CPU time of the process
/// and by the wall clock.
int run_benchmarks(int argc, char** argv, const std::vector<Benchmark>& benchmarks);

}  // namespace uw::bench
