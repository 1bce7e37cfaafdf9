// ctest labels: unit slow
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/colour.h"
#include "render/light_splatter.h"
#include "render/scene_rendering.h"
#include "tests/support/test_scene.h"

namespace uw {
namespace {

/// Surfaces that ask for a stop once so many rays have been traced through them, and count what is
/// traced from then on: how much work is done before a stop is noticed, whatever the machine.
class StoppingSurfaces final : public Surfaces {
  public:
    StoppingSurfaces(std::shared_ptr<const Surfaces> traced, std::size_t until)
        : traced_(std::move(traced)), until_(until) {}

    const std::atomic<bool>& stop() const { return stop_; }
    std::size_t rays() const { return rays_; }
    std::size_t rays_too_many() const { return rays_ - std::min<std::size_t>(rays_, until_); }

    bool closest_hit(const Ray& ray, double s_end, SurfaceHit& hit) const override {
        count(1);
        return traced_->closest_hit(ray, s_end, hit);
    }
    double hit_distance(const Ray& ray) const override {
        count(1);
        return traced_->hit_distance(ray);
    }
    bool occluded(const Point3& from, const Point3& to) const override {
        count(1);
        return traced_->occluded(from, to);
    }
    void closest_hits(std::span<const Ray> rays, double s_end, std::span<SurfaceHit> hits,
                      std::span<char> found) const override {
        count(rays.size());
        traced_->closest_hits(rays, s_end, hits, found);
    }
    void hit_distances(const Point3& origin, std::span<const Vector3> directions,
                       std::span<double> distances) const override {
        count(directions.size());
        traced_->hit_distances(origin, directions, distances);
    }
    void occluded_many(const Point3& from, std::span<const Point3> to,
                       std::span<char> blocked) const override {
        count(to.size());
        traced_->occluded_many(from, to, blocked);
    }
    void occluded_many(std::span<const Point3> from, std::span<const Point3> to,
                       std::span<char> blocked) const override {
        count(to.size());
        traced_->occluded_many(from, to, blocked);
    }
    SurfaceMaterial material(const SurfaceHit& hit) const override {
        return traced_->material(hit);
    }
    const SurfaceNames& names() const override { return traced_->names(); }
    Bounds bounds() const override { return traced_->bounds(); }
    std::uint64_t triangle_count() const override { return traced_->triangle_count(); }
    bool empty() const override { return traced_->empty(); }

  private:
    void count(std::size_t rays) const {
        rays_ += rays;
        if (rays_ >= until_) stop_ = true;
    }

    std::shared_ptr<const Surfaces> traced_;
    std::size_t until_;
    mutable std::atomic<std::size_t> rays_{0};
    mutable std::atomic<bool> stop_{false};
};

struct StoppedCase {
    const char* name;
    RenderDesc::Integrator integrator;
    RenderDesc::Scattering scattering;
    int samples;
    double forward_scatter;
};

/// Images that would take hours, of lamps over a wall.
class Stopping : public testing::TestWithParam<StoppedCase> {
  protected:
    static SceneDesc scene() {
        SceneDesc desc = test::pinhole_scene(320, 200);
        desc.geometry = {test::plane_at_z(4)};
        desc.lamps = {test::isotropic_lamp({-0.5, 0, 0}, 10),
                      test::isotropic_lamp({0.5, 0, 0}, 10)};
        desc.lamps[1].name = "other";
        desc.render.integrator = GetParam().integrator;
        desc.render.scattering = GetParam().scattering;
        desc.render.samples = GetParam().samples;
        desc.water.forward_scatter.K = GetParam().forward_scatter;
        return desc;
    }

    /// How many rays are traced after the first `until` of them.
    static std::size_t rays_after_stop(std::size_t until) {
        const SceneDesc desc = scene();
        SceneCache cache;
        AssembledScene assembled = assemble_scene(SceneDesc(desc), cache, [](Stage) {});
        const auto surfaces = std::make_shared<StoppingSurfaces>(assembled.surfaces, until);
        assembled.surfaces = surfaces;
        const LayerPlan plan = layer_plan(assembled.image, "default");
        const BandColour colour = make_band_colour(desc.render.colour, desc.water.bands_nm);
        Film film(desc.camera.width, desc.camera.height,
                  {0, 0, desc.camera.width, desc.camera.height}, plan.channel_names());
        const auto render = [&] {
            PassList passes = make_passes(assembled.image);
            const PassNeeds needs = passes.needs(plan);
            if (needs.slabs) assembled.slabs = place_slabs(assembled);
            const DeepShadows light = LightSplatter().splat(
                assembled, deep_shadow_options(desc.render.quality, assembled.water.medium));
            const LightTransport transport = make_light_transport(assembled, light, needs.paths);
            const StageProgressCallback progress = [](Stage, double) {};
            ImageProgress reached;
            Rendering rendering = make_rendering(assembled, *assembled.camera, transport, light,
                                                 {plan, colour, film, progress, reached});
            passes.run(Pass::Of::light, rendering);
        };
        const ThreadLimit alone(1);
        const StopScope scope(surfaces->stop());
        EXPECT_THROW(render(), Interrupted);
        return surfaces->rays_too_many();
    }
};

// They take a few milliseconds; a whole row of pixels would be 65 000 rays and more.
TEST_P(Stopping, TakesNoMoreThanSomeRays) {
    constexpr std::size_t k_most = 4096;
    for (const std::size_t until : {1U, 1000U, 200'000U, 5'000'000U, 8'000'000U})
        EXPECT_LE(rays_after_stop(until), k_most) << until;
}

INSTANTIATE_TEST_SUITE_P(Integrators, Stopping,
                         testing::Values(StoppedCase{"volume", RenderDesc::Integrator::volume,
                                                     RenderDesc::Scattering::single, 4096, 0},
                                         StoppedCase{"forward", RenderDesc::Integrator::volume,
                                                     RenderDesc::Scattering::single, 4096, 0.5},
                                         StoppedCase{"planes", RenderDesc::Integrator::planes,
                                                     RenderDesc::Scattering::single, 4096, 0},
                                         StoppedCase{"reference", RenderDesc::Integrator::reference,
                                                     RenderDesc::Scattering::single, 4096, 0},
                                         StoppedCase{"path", RenderDesc::Integrator::path,
                                                     RenderDesc::Scattering::multiple, 4096, 0},
                                         StoppedCase{"multiple", RenderDesc::Integrator::volume,
                                                     RenderDesc::Scattering::multiple, 4096, 0}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace uw
