// Points of the world to pixels, and pixels to rays, for every lens behind every port. Each
// iteration does one; the `items_per_second` are points or rays.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "camera/camera.h"

namespace uw {
namespace {

enum class Lens : std::uint8_t { pinhole, brown_conrady, fisheye };
enum class Glass : std::uint8_t { none, flat, dome };

CameraDesc camera(Lens lens, Glass glass) {
    CameraDesc desc;
    desc.width = 1920;
    desc.height = 1080;
    desc.intrinsics = {1100, 1100, 960, 540};
    if (lens == Lens::brown_conrady)
        desc.distortion = {{-0.12, 0.06, -0.01, 0, 0, 0}, {0.001, -0.0005}};
    if (lens == Lens::fisheye)
        desc.distortion = {
            {0.03, -0.005, 0.001, -0.0002, 0, 0}, {}, DistortionDesc::Model::fisheye};
    if (glass == Glass::flat) {
        FlatPortDesc port;
        port.normal = glm::normalize(Vector3(0.05, -0.03, 1));
        port.distance = 0.02;
        port.thickness = 0.04;
        desc.port = port;
    }
    if (glass == Glass::dome) {
        DomePortDesc port;
        port.center = {0.002, -0.001, -0.01};
        port.radius = 0.05;
        port.thickness = 0.007;
        desc.port = port;
    }
    return desc;
}

constexpr std::size_t k_points = 4096;  // these fit into the cache

struct Samples {
    std::vector<ImagePoint> pixels;
    std::vector<Point3> points;  // 0.1 m to 100 m away
};

Samples samples(const Camera& of) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> x(0, of.width()), y(0, of.height()),
        exponent(std::log(0.1), std::log(100.0));
    Samples result;
    while (result.points.size() < k_points) {
        const ImagePoint pixel{x(random), y(random)};
        const auto ray = of.refracted_ray(pixel.x, pixel.y);
        if (!ray) continue;
        result.pixels.push_back(pixel);
        result.points.push_back(ray->at(std::exp(exponent(random))));
    }
    return result;
}

void project(benchmark::State& state, Lens lens, Glass glass) {
    const Camera of(camera(lens, glass));
    const Samples with = samples(of);
    std::size_t i = 0;
    for (auto _ : state) benchmark::DoNotOptimize(of.project(with.points[i++ % k_points]));
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}

void refracted_ray(benchmark::State& state, Lens lens, Glass glass) {
    const Camera of(camera(lens, glass));
    const Samples with = samples(of);
    std::size_t i = 0;
    for (auto _ : state) {
        const ImagePoint& pixel = with.pixels[i++ % k_points];
        benchmark::DoNotOptimize(of.refracted_ray(pixel.x, pixel.y));
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}

BENCHMARK_CAPTURE(project, pinhole, Lens::pinhole, Glass::none);
BENCHMARK_CAPTURE(project, pinhole_flat, Lens::pinhole, Glass::flat);
BENCHMARK_CAPTURE(project, pinhole_dome, Lens::pinhole, Glass::dome);
BENCHMARK_CAPTURE(project, brown_conrady, Lens::brown_conrady, Glass::none);
BENCHMARK_CAPTURE(project, brown_conrady_flat, Lens::brown_conrady, Glass::flat);
BENCHMARK_CAPTURE(project, brown_conrady_dome, Lens::brown_conrady, Glass::dome);
BENCHMARK_CAPTURE(project, fisheye, Lens::fisheye, Glass::none);
BENCHMARK_CAPTURE(project, fisheye_flat, Lens::fisheye, Glass::flat);
BENCHMARK_CAPTURE(project, fisheye_dome, Lens::fisheye, Glass::dome);
BENCHMARK_CAPTURE(refracted_ray, pinhole, Lens::pinhole, Glass::none);
BENCHMARK_CAPTURE(refracted_ray, pinhole_flat, Lens::pinhole, Glass::flat);
BENCHMARK_CAPTURE(refracted_ray, pinhole_dome, Lens::pinhole, Glass::dome);
BENCHMARK_CAPTURE(refracted_ray, brown_conrady, Lens::brown_conrady, Glass::none);
BENCHMARK_CAPTURE(refracted_ray, fisheye, Lens::fisheye, Glass::none);
BENCHMARK_CAPTURE(refracted_ray, fisheye_dome, Lens::fisheye, Glass::dome);

}  // namespace
}  // namespace uw
