#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tests/support/paths/mean_fluence.h"
#include "tests/support/paths/plain_paths.h"
#include "tests/support/paths/s1_scene.h"
#include "tests/support/paths/term_sums.h"

/// The mean of S1's image over random rays, by core/paths and by PlainPaths.
namespace uw::test {

inline constexpr double k_s1_width = 320, k_s1_height = 240;

/// What a term of light may be, as far as both tell: scatterings and reflections, the last of each
/// for all beyond, and whether it was last scattered by the water.
struct LightKind {
    int scatterings = 0, reflections = 0;
    bool from_water = false;

    bool matches(int s, int r, bool water) const {
        return std::min(s, PlainPaths::k_scatterings - 1) == scatterings &&
               std::min(r, PlainPaths::k_reflections - 1) == reflections && water == from_water;
    }
    /// Whether it is single scattering: the image without light paths.
    bool is_once() const { return scatterings + reflections == 1; }

    static std::vector<LightKind> all() {
        std::vector<LightKind> kinds;
        for (int s = 0; s < PlainPaths::k_scatterings; ++s)
            for (int r = 0; r < PlainPaths::k_reflections; ++r)
                for (const bool water : {false, true}) kinds.push_back({s, r, water});
        return kinds;
    }
};

/// A batch of rays with a path of each kind.
struct S1Batch {
    TermSums sums{3};
    std::array<double, 3> largest{};  // radiance of one path, without single scattering

    double once(std::size_t band) const {
        return sums.sum(band, [](int s, int r, bool) { return s + r == 1; });
    }
    double total(std::size_t band) const { return sums.total(band); }
};

inline S1Batch trace_s1(const PathScene& scene, const PathTracer& tracer, std::uint64_t seed,
                        int rays) {
    // Passes terms on and adds those of one path up.
    struct Largest final : ContributionSink {
        explicit Largest(TermSums& to) : sums(to) {}
        void add(const PathContribution& term) override {
            sums.add(term);
            for (std::size_t b = 0; b < 3; ++b) path[b] += term.radiance[b];
        }
        TermSums& sums;
        std::array<double, 3> path{};
    };
    S1Batch batch;
    batch.sums.set_weight(1.0 / rays);
    thread_local CameraSegment segment;
    for (int i = 0; i < rays; ++i) {
        const std::uint64_t ray_seed = PathRandom::seed_of(seed, static_cast<std::uint64_t>(i));
        PathRandom position(ray_seed, 0);
        const double x = k_s1_width * position.next(), y = k_s1_height * position.next();
        const Ray ray = s1_ray(x, y);
        SurfaceHit hit;
        if (!scene.surfaces->closest_hit(ray, k_far, hit)) continue;
        TermSums direct(3);
        add_direct_light(scene.lit(), ray, hit, 1, direct);
        std::array<double, 3> surface_light{};
        for (std::size_t b = 0; b < 3; ++b) surface_light[b] = direct.total(b);
        tracer.begin(ray, &hit, surface_light, segment);
        add_direct_light(scene.lit(), ray, hit, 1.0 / rays, batch.sums);
        PathRandom single(PathRandom::seed_of(ray_seed, 1), 0),
            water(PathRandom::seed_of(ray_seed, 2), 0),
            surface(PathRandom::seed_of(ray_seed, 3), 0);
        tracer.trace_single(segment, single, batch.sums);
        Largest more(batch.sums);
        trace_scattered(tracer, segment, water, more);
        tracer.trace_surface(segment, surface, more);
        for (std::size_t b = 0; b < 3; ++b)
            batch.largest[b] = std::max(batch.largest[b], more.path[b]);
    }
    return batch;
}

/// S1 in one band.
inline PlainPaths::Scene plain_s1(std::size_t band) {
    const PathScene scene = s1_scene();
    return {scene.medium.uniform.absorption[band],
            scene.medium.uniform.scattering[0][band],
            0.9,
            {0.1, -0.2, 1.0},
            {0.4, 0.1, 1.3},
            4,
            0.5,
            scene.lamps.front().position(),
            50,
            k_lamp_radius};
}

inline PlainPaths::Kinds trace_plain_s1(std::size_t band, std::uint64_t seed, int rays) {
    PlainPaths paths(plain_s1(band), seed);
    PlainPaths::Kinds kinds{};
    for (int i = 0; i < rays; ++i) {
        const double x = k_s1_width * paths.uniform(), y = k_s1_height * paths.uniform();
        const Ray ray = s1_ray(x, y);
        paths.trace(ray.origin, ray.direction, kinds);
    }
    for (auto& row : kinds)
        for (auto& entry : row)
            for (double& value : entry) value /= rays;
    return kinds;
}

inline double plain_sum(const PlainPaths::Kinds& kinds, const LightKind& kind) {
    return kinds[static_cast<std::size_t>(kind.scatterings)]
                [static_cast<std::size_t>(kind.reflections)][kind.from_water ? 1 : 0];
}

}  // namespace uw::test
