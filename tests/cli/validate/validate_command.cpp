// ctest labels: analytic
#include "cli/validate/validate_command.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/support/temp_dir.h"

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

TransportWrapper faulty(double in_scatter, double direct) {
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

TransportWrapper faulty_in_forward_scatter(Fault fault) {
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

// The components of the checks in `table` that failed.
std::set<std::string> failed_components(const std::string& table) {
    std::set<std::string> failed;
    std::istringstream lines(table);
    for (std::string line; std::getline(lines, line);) {
        if (line.find("FAILED") == std::string::npos || line.find(" nm ") == std::string::npos)
            continue;
        for (const char* name : {"direct", "forward", "blurred backscatter", "  backscatter"})
            if (line.find(name + std::string("  ")) != std::string::npos) failed.insert(name);
    }
    return failed;
}

class Validate : public ::testing::Test {
  protected:
    Validate() {
        arguments_.quiet = true;
        arguments_.scene = std::string(UWVDB_SOURCE_DIR) + "/assets/scenes/uniform.yaml";
        arguments_.overrides = {"camera.resolution=[24,14]"};
    }
    void scatter_forward(const std::string& shape) {
        arguments_.overrides.push_back(
            "water.forward_scatter={K: 1, G: 0.02, B: 0.1, shape: " + shape + "}");
    }
    TempDir dir_;
    ValidateArguments arguments_;
    std::ostringstream out_;
};

TEST_F(Validate, PassesOnTheExampleOfUniformWater) {
    EXPECT_TRUE(run_validate(arguments_, false, out_)) << out_.str();
    EXPECT_EQ(out_.str(), "");  // quiet
}

TEST_F(Validate, FailsOnWrongBackscatterAndNamesItInRed) {
    // One lamp of two by half a percent: more than the tolerance of a tenth.
    EXPECT_FALSE(run_validate(arguments_, true, out_, faulty(1.005, 1)));
    const std::string text = out_.str();
    EXPECT_NE(text.find("validation FAILED"), std::string::npos);
    const std::size_t red = text.find("\033[31m");
    ASSERT_NE(red, std::string::npos);
    EXPECT_NE(text.substr(red, text.find('\n', red) - red).find("backscatter"), std::string::npos);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.find("direct") != std::string::npos) {
            EXPECT_EQ(line.find("FAILED"), std::string::npos) << line;
        }
    }
}

TEST_F(Validate, FailsOnWrongDirectLight) {
    EXPECT_FALSE(run_validate(arguments_, false, out_, faulty(1, 0.99)));
    std::istringstream lines(out_.str());
    bool named = false;
    for (std::string line; std::getline(lines, line);)
        named = named || (line.find("direct") != std::string::npos &&
                          line.find("FAILED") != std::string::npos);
    EXPECT_TRUE(named);
}

TEST_F(Validate, PassesWithForwardScatterOfBothShapes) {
    arguments_.quiet = false;
    for (const char* shape : {"gaussian", "exponential"}) {
        scatter_forward(shape);
        EXPECT_TRUE(run_validate(arguments_, false, out_)) << out_.str();
    }
    EXPECT_NE(out_.str().find("volume - direct sum"), std::string::npos);
    EXPECT_NE(out_.str().find("blurred backscatter"), std::string::npos);
}

TEST_F(Validate, FailsOnWrongLayersOfWaterThatOnlyForwardScatterSees) {
    scatter_forward("gaussian");
    EXPECT_FALSE(run_validate(arguments_, true, out_, faulty_in_forward_scatter(Fault::slabs)));
    EXPECT_EQ(failed_components(out_.str()), std::set<std::string>{"blurred backscatter"})
        << out_.str();
    EXPECT_NE(out_.str().find("\033[31m"), std::string::npos);
}

TEST_F(Validate, FailsOnWrongIrradianceThatOnlyForwardScatterSees) {
    scatter_forward("exponential");
    EXPECT_FALSE(
        run_validate(arguments_, false, out_, faulty_in_forward_scatter(Fault::irradiance)));
    EXPECT_EQ(failed_components(out_.str()), std::set<std::string>{"forward"}) << out_.str();
}

// How much the water scatters cannot measure the blur in a VDB then.
TEST_F(Validate, WorksWithForwardScatterInWaterThatDoesNotScatterInOneBand) {
    scatter_forward("gaussian");
    arguments_.overrides.emplace_back(
        "water.scattering={b: [0.2, 0, 0.25], phase: {type: hg, g: 0.9}}");
    EXPECT_TRUE(run_validate(arguments_, false, out_)) << out_.str();
}

TEST_F(Validate, WritesOnePageThatNeedsNothingElse) {
    arguments_.report = dir_ / "report.html";
    scatter_forward("gaussian");
    EXPECT_TRUE(run_validate(arguments_, false, out_));
    std::ifstream in(arguments_.report);
    const std::string html{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NE(html.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
    EXPECT_NE(html.find("<svg"), std::string::npos);
    EXPECT_NE(html.find("Pictures with forward scatter"), std::string::npos);
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_EQ(html.find("src=\"http"), std::string::npos);
    EXPECT_EQ(html.find("href="), std::string::npos);
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
