#include "core/passes/forward_scatter.h"

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <cmath>

namespace uw {
namespace {

using Shape = ForwardScatterDesc::Shape;

// A sea floor that recedes from 1 m at the bottom to 12 m at the top, with a box at 2 m: three
// bands. The focal length is the image's width.
void sea_floor(benchmark::State& state, Shape shape, double blur) {
    const int width = static_cast<int>(state.range(0));
    const int height = width * 9 / 16;
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<float> light(pixels), range(pixels), added(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto x = static_cast<int>(i % static_cast<std::size_t>(width));
        const auto y = static_cast<int>(i / static_cast<std::size_t>(width));
        const bool box = std::abs(x - width / 2) < width / 10 && std::abs(y - height / 2) < 99;
        const double up = 1 - static_cast<double>(y) / height;
        range[i] = box ? 2.0F : static_cast<float>(1 / (1 - up * 11 / 12));
        light[i] = std::exp(-range[i]);
    }
    const ForwardScatterDesc desc{.K = 1, .G = 0.05, .B = blur, .shape = shape};
    for (auto _ : state) {
        ForwardScatter scatter(desc, {width, height, 1.0 * width, 1.0 * width});
        for (const double c : {0.5, 0.3, 0.2}) {
            scatter.add({light, range, {}, c});
            scatter.finish(added);
            benchmark::DoNotOptimize(added.data());
        }
    }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1024;
}

void exponential(benchmark::State& state, double blur) {
    sea_floor(state, Shape::exponential, blur);
}
void gaussian(benchmark::State& state, double blur) {
    sea_floor(state, Shape::gaussian, blur);
}

// Widths s of 0.3 to 3.7 and 6 to 73 pixels at 3840 x 2160.
BENCHMARK_CAPTURE(exponential, narrow, 0.0005)
    ->Arg(960)
    ->Arg(3840)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(exponential, wide, 0.01)->Arg(3840)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(gaussian, narrow, 0.0005)
    ->Arg(3840)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(gaussian, wide, 0.01)->Arg(3840)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace uw
