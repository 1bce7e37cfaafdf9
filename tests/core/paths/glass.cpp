// ctest labels: analytic statistical
// Light paths through glass: where everything else shines as brightly as it reflects, glass changes
// nothing, whatever paths meet; and what a camera sees through glass adds up to as much.
#include <gtest/gtest.h>

#include "core/geometry/glass.h"
#include "core/passes/glass_view.h"
#include "tests/support/paths/closed_form_surfaces.h"
#include "tests/support/paths/ray_batches.h"

namespace uw::test {
namespace {

constexpr double k_water_index = 1.334;

/// A room whose walls emit what they do not reflect, in water that absorbs nothing, with a ball and
/// a thin box of glass, and a bubble of air.
PathScene furnace_with_glass() {
    PathScene scene({{0, 0.3}, {0, 1.0}}, 0.8);
    const auto emissive = [](double a, double b) {
        ClosedFormSurfaces::Material material{{a, b}, {}};
        material.more.emission = Spectrum{1 - a, 1 - b};
        return material;
    };
    auto room = std::make_unique<ClosedFormSurfaces>();
    room->add_box({-1, -1.5, -1}, {1, 1, 2}, emissive(0.5, 0.3));
    room->add_sphere({-0.4, 0.3, 1}, 0.3, emissive(0.8, 0.2));
    auto glass = std::make_unique<ClosedFormSurfaces>();
    glass->add_sphere({0.3, 0, 0.8}, 0.4, {});
    glass->add_sphere({-0.4, -0.5, 0.5}, 0.3, {});
    glass->add_box({-0.8, -1.2, -0.8}, {0.8, -1.0, 1.5}, {});
    scene.surfaces = std::make_unique<GlassSurfaces>(
        std::move(room), std::move(glass),
        GlassTable{{{.n = 1.52}, {.n = 1}, {.n = 1.5, .is_thin = true}}, {0, 1, 2, 3}, {}});
    scene.glass = std::make_shared<GlassOptics>(
        std::shared_ptr<const Surfaces>(scene.surfaces.get(), [](const Surfaces*) {}),
        k_water_index, scene.band_count(), std::nullopt);
    return scene;
}

TEST(GlassPaths, KeepAWhiteFurnaceWhite) {
    const PathScene scene = furnace_with_glass();
    const PathTracer tracer(scene.lit());
    Deviations deviations;
    std::uint64_t number = 0;
    // None of them meets glass itself, but what it meets is lit through all of it.
    for (const Vector3& direction : {Vector3(-0.9, 0.1, 0.1), Vector3(-0.4, 0.3, 1),
                                     Vector3(0.1, 0.6, -1), Vector3(0.8, 0.7, 0.1)}) {
        const Ray ray{{0, 0, 0}, glm::normalize(direction)};
        SurfaceHit hit;
        ASSERT_TRUE(scene.surfaces->closest_hit(ray, k_far, hit));
        ASSERT_EQ(hit.glass, 0U);
        const auto batches = ray_batches(scene, ray, ++number, 32, 1 << 9);
        for (std::size_t b = 0; b < scene.band_count(); ++b) {
            const double emitted = scene.surfaces->material(hit).emission[b] *
                                   std::exp(-scene.medium.uniform.attenuation(b) * hit.distance);
            deviations.add(
                "direction " + std::to_string(number) + " band " + std::to_string(b),
                means_of(batches, [&](const TermSums& sums) { return emitted + sums.total(b); }),
                1);
        }
    }
    deviations.expect_within_errors();
    deviations.expect_errors_below(0.03);
}

// What the water of a leg scatters into it is what it takes away, and its end is as bright.
TEST(GlassView, HasLegsThatAddUpToAllLight) {
    const PathScene scene = furnace_with_glass();
    const GlassView view(scene.lit());
    std::vector<GlassLeg> legs;
    int seen = 0;
    double worst = 0;
    for (int i = -8; i <= 8; ++i)
        for (int j = -8; j <= 8; ++j) {
            const Ray ray{{0, 0, 0}, glm::normalize(Vector3(0.12 * i, 0.12 * j, 0.9))};
            SurfaceHit hit;
            ASSERT_TRUE(scene.surfaces->closest_hit(ray, k_far, hit));
            if (hit.glass == 0) continue;
            ++seen;
            view.follow(ray, hit, legs);
            for (std::size_t b = 0; b < scene.band_count(); ++b) {
                double sum = 0;
                for (const GlassLeg& leg : legs) {
                    ASSERT_TRUE(leg.has_hit);
                    sum += leg.weight[b] * (is_specular(leg.hit) ? 1 - leg.left[b] : 1);
                }
                const double arriving =
                    std::exp(-scene.medium.uniform.attenuation(b) * hit.distance);
                worst = std::max(worst, std::abs(sum / arriving - 1));
                // Branches below GlassView::k_min_weight are left out, up to a dozen of them.
                EXPECT_NEAR(sum / arriving, 1, 1e-3) << i << " " << j;
            }
        }
    EXPECT_GT(seen, 60);
    std::cout << seen << " rays, largest deviation " << worst << "\n";
}

}  // namespace
}  // namespace uw::test
