#include "tests/bench/support/measure.h"

#include "core/base/parallel.h"
#include "tests/bench/support/process.h"

namespace uw::bench {

void measure(benchmark::State& state, const Floor& floor, int threads,
             const std::function<void()>& work) {
    const ThreadLimit limit(threads);
    double floor_s = 0, cpu_s = 0;
    for (auto _ : state) {
        state.PauseTiming();
        floor_s += 0.5 * floor.cpu_seconds();
        state.ResumeTiming();
        const double begin = process_cpu_seconds();
        work();
        cpu_s += process_cpu_seconds() - begin;
        state.PauseTiming();
        floor_s += 0.5 * floor.cpu_seconds();
        state.ResumeTiming();
    }
    const auto count = static_cast<double>(state.iterations());
    state.counters["cpu_s"] = cpu_s / count;
    state.counters["floor_s"] = floor_s / count;
    state.counters["x_floor"] = cpu_s / floor_s;
}

int run_benchmarks(int argc, char** argv, const std::vector<Benchmark>& benchmarks) {
    std::function<void(benchmark::State&)> current;
    const Benchmark* current_benchmark = nullptr;
    for (const Benchmark& entry : benchmarks) {
        const auto run = [&current, &current_benchmark, &entry](benchmark::State& state) {
            if (current_benchmark != &entry) {
                current = nullptr;
                current = entry.prepare();
                current_benchmark = &entry;
            }
            current(state);
        };
        benchmark::RegisterBenchmark(entry.name.c_str(), run)
            ->Iterations(1)
            ->MeasureProcessCPUTime()
            ->UseRealTime()
            ->Unit(benchmark::kSecond);
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

}  // namespace uw::bench
