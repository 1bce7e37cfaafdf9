// ctest labels: analytic slow
// Faults of the volume integrator are found, and only where they are.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "render/scene_loading.h"
#include "render/validation/scene_trial.h"

namespace uw::test {
namespace {

/// An integrator whose in-scatter is off by a factor.
class FaultyIntegrator final : public Integrator {
  public:
    FaultyIntegrator(std::unique_ptr<const Integrator> honest, double factor)
        : honest_(std::move(honest)), factor_(factor) {}

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override {
        honest_->in_scatter(ray, distances, result);
        for (std::size_t i = 0; i < distances.size(); ++i) result.at(i, 0) *= factor_;
    }

  private:
    std::unique_ptr<const Integrator> honest_;
    double factor_;
};

/// Lighting whose light on surfaces is off by a factor.
class FaultyLighting final : public SurfaceLighting {
  public:
    FaultyLighting(std::unique_ptr<const SurfaceLighting> honest, double factor)
        : honest_(std::move(honest)), factor_(factor) {}

    void evaluate(std::span<const SurfaceSample* const> samples,
                  SurfaceLight& light) const override {
        honest_->evaluate(samples, light);
        for (std::size_t i = 0; i < samples.size(); ++i)
            for (std::size_t j = 0; j < light.emitter_count(); ++j)
                for (double& value : light.from_emitter(i, j)) value *= factor_;
    }

  private:
    std::unique_ptr<const SurfaceLighting> honest_;
    double factor_;
};

TransportChange faulty(double in_scatter, double direct) {
    return [=](LightTransport honest) {
        return LightTransport{
            std::make_unique<FaultyIntegrator>(std::move(honest.integrator), in_scatter),
            std::make_unique<FaultyLighting>(std::move(honest.surfaces), direct)};
    };
}

/// Honest before forward scatter, which alone asks for the light from a distance on: each slab's
/// light is then its neighbour's.
class IntegratorOfFaultySlabs final : public Integrator {
  public:
    explicit IntegratorOfFaultySlabs(std::unique_ptr<const Integrator> honest)
        : honest_(std::move(honest)) {}

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override {
        honest_->in_scatter(ray, distances, result);
    }
    void in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                         InScatter& result) const override {
        honest_->in_scatter_from(ray, begin, distances, result);
        for (std::size_t lamp = 0; lamp < result.lamp_count(); ++lamp)
            for (std::size_t i = 0; i + 1 < distances.size(); ++i)
                result.at(i, lamp) = result.at(i + 1, lamp);
    }

  private:
    std::unique_ptr<const Integrator> honest_;
};

/// Honest before forward scatter, which alone asks what falls on surfaces apart from what they send
/// back: where more falls on a surface, as much less of it comes to the camera.
class LightingOfFaultyIrradiance final : public SurfaceLighting {
  public:
    explicit LightingOfFaultyIrradiance(std::unique_ptr<const SurfaceLighting> honest)
        : honest_(std::move(honest)) {}

    void evaluate(std::span<const SurfaceSample* const> samples,
                  SurfaceLight& light) const override {
        honest_->evaluate(samples, light);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double more = 1 + 0.3 * std::sin(3 * samples[i]->hit.position.x);
            for (double& value : light.to_camera(i)) value /= more;
            for (std::size_t j = 0; j < light.emitter_count(); ++j)
                for (double& value : light.from_emitter(i, j)) value *= more;
        }
    }

  private:
    std::unique_ptr<const SurfaceLighting> honest_;
};

enum class Fault { slabs, irradiance };

TransportChange faulty_in_forward_scatter(Fault fault) {
    return [=](LightTransport transport) {
        if (fault == Fault::slabs)
            transport.integrator =
                std::make_unique<IntegratorOfFaultySlabs>(std::move(transport.integrator));
        else
            transport.surfaces =
                std::make_unique<LightingOfFaultyIrradiance>(std::move(transport.surfaces));
        return transport;
    };
}

/// The example with two spots, whose light is splatted four times as fast as that of its wide lamp.
SceneDesc uniform_water(const std::string& forward_scatter = "") {
    std::vector<std::string> overrides{"camera.resolution=[12,7]",
                                       "lamps.right.profile={type: spot, beam: 60, edge: 5}"};
    if (!forward_scatter.empty())
        overrides.push_back(
            "water.forward_scatter={K: 1, G: 0.02, B: 0.1, shape: " + forward_scatter + "}");
    return load_scene(std::string(UWVDB_SOURCE_DIR) + "/assets/scenes/uniform.yaml", overrides);
}

/// The components of which a check fails.
std::set<std::string> failed_components(SceneDesc scene, const TransportChange& fault) {
    const SceneValidation result = validate_scene(std::move(scene), "test", {}, fault);
    EXPECT_FALSE(result.passed());
    std::set<std::string> failed;
    for (const Check& check : result.checks)
        if (!check.passed()) failed.insert(check.component.name);
    return failed;
}

TEST(WrongMethods, AreFoundByTheirBackscatter) {
    // One lamp of two by half a percent: more than the tolerance of a tenth.
    EXPECT_EQ(failed_components(uniform_water(), faulty(1.005, 1)),
              std::set<std::string>{"backscatter"});
}

TEST(WrongMethods, AreFoundByTheirDirectLight) {
    EXPECT_EQ(failed_components(uniform_water(), faulty(1, 0.99)), std::set<std::string>{"direct"});
}

TEST(WrongMethods, AreFoundByLayersOfWaterThatOnlyForwardScatterSees) {
    EXPECT_EQ(failed_components(uniform_water("gaussian"), faulty_in_forward_scatter(Fault::slabs)),
              std::set<std::string>{"blurred backscatter"});
}

TEST(WrongMethods, AreFoundByIrradianceThatOnlyForwardScatterSees) {
    EXPECT_EQ(failed_components(uniform_water("exponential"),
                                faulty_in_forward_scatter(Fault::irradiance)),
              std::set<std::string>{"forward"});
}

TEST(Validation, PlanesConvergeAsTheSquareOfTheirThickness) {
    SceneDesc desc;
    desc.file = "test";
    desc.camera.width = 12;
    desc.camera.height = 9;
    desc.camera.intrinsics = {10, 10, 6, 4.5};
    desc.water.absorption = PerBand{0.35, 0.08, 0.05};
    desc.water.scattering = ScatteringDesc{{0.20, 0.22, 0.25}, {}};
    desc.water.scattering->phase.function = HenyeyGreensteinDesc{0.9};
    GeometryDesc wall;
    wall.type = GeometryDesc::Type::plane;
    wall.point = {0, 0, 4};
    wall.normal = {0, 0, -1};
    desc.geometry = {wall};
    LampDesc lamp;
    lamp.name = "lamp";
    lamp.position = {1, -0.5, 0};
    lamp.intensity = PerBand{50, 50, 50};
    desc.lamps = {lamp};
    const SceneValidation result = validate_scene(std::move(desc), "test", {});
    EXPECT_TRUE(result.passed());
    ASSERT_EQ(result.planes.back().count, 512);
    for (const PlanesStep& step : result.planes) {
        if (step.count >= 64) {
            EXPECT_NEAR(step.order, 2, 0.05) << step.count;
        }
    }
    EXPECT_LT(result.planes.back().error, 1e-3);
}

}  // namespace
}  // namespace uw::test
