// ctest labels: statistical slow
// The net irradiance Ed - Eu does not depend on depth in water that absorbs nothing, over a floor
// that does: a law of energy that holds for every phase function, however steep its forward peak.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene_desc.h"
#include "render/meters/light_meter.h"
#include "render/renderer.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

struct Scattering {
    const char* name;
    std::string keys;
    /// How closely the net irradiance is to be known, relative to the light from above. A fifth of
    /// the light is scattered in the mean, of which three errors of 2.5e-3 are 4 %; where a steep
    /// peak was lost, 60 % of it were missing. Broad functions have no peak to lose, and more
    /// noise.
    double max_error;
};

/// Water 2 m deep below a sun at 45 degrees that scatters so; light of the surface is that of
/// Fresnel.
class NetIrradiance : public testing::TestWithParam<Scattering> {
  protected:
    const AssembledScene& assembled() {
        const SceneDesc desc = read_scene(
            folder_.write(
                "scene.yaml",
                "uwvdb: 1\n"
                "camera: {resolution: [8, 6], intrinsics: {fov_x: 60}, pose: {position: [0, 1, 0], "
                "look_at: [0, 1, 1]}}\n"
                "lamps: [{name: sun, type: sun, direction: [1, -1, 0], irradiance: [1], angle: "
                "0}]\n"
                "geometry: [{type: plane, point: [0, 0, 0], normal: [0, 1, 0], reflectance: 0}]\n"
                "water: {surface: {height: 2, n: 1.34}, bands: [550], absorption: [0], " +
                    GetParam().keys + "}\n"),
            {});
        renderer_.set_scene(SceneDesc(desc));
        return renderer_.assemble();
    }

    SceneFolder folder_;
    Renderer renderer_;
};

TEST_P(NetIrradiance, IsTheSameAtAllDepths) {
    const LightMeter meter(assembled());
    constexpr int k_rays = 1 << 18;
    struct Net {
        double mean, error;
    };
    std::array<Net, 2> nets{};
    constexpr std::array k_heights{1.9, 0.1};
    double down = 0;
    for (std::size_t i = 0; i < nets.size(); ++i) {
        const MeterReading reading = meter.read({0, k_heights[i], 0}, {0, 1, 0}, k_rays);
        nets[i] = {reading.down.mean[0] - reading.up.mean[0],
                   std::hypot(reading.down.error[0], reading.up.error[0])};
        down = reading.down.mean[0];
    }
    const double error = std::hypot(nets[0].error, nets[1].error);
    EXPECT_NEAR(nets[1].mean, nets[0].mean, 3 * error) << nets[0].mean << " " << nets[1].mean;
    EXPECT_LT(error, GetParam().max_error * down);
}

std::string phase(const std::string& function) {
    return "scattering: {b: [0.2], phase: " + function + "}";
}

INSTANTIATE_TEST_SUITE_P(
    Phases, NetIrradiance,
    testing::Values(Scattering{"Isotropic", phase("{type: hg, g: 0}"), 6e-3},
                    Scattering{"HenyeyGreenstein", phase("{type: hg, g: 0.924}"), 2.5e-3},
                    Scattering{"SteepHenyeyGreenstein", phase("{type: hg, g: 0.999}"), 2.5e-3},
                    Scattering{"FournierForand",
                               phase("{type: fournier-forand, n: 1.1, mu: 3.5835}"), 2.5e-3},
                    Scattering{"SteepFournierForand",
                               phase("{type: fournier-forand, n: 1.05, mu: 3.1}"), 2.5e-3},
                    Scattering{"Petzold", phase("{type: petzold}"), 2.5e-3},
                    Scattering{"Mixture", "particles: {small: 0.05, large: 1}", 6e-3}),
    [](const auto& suite) { return std::string(suite.param.name); });

}  // namespace
}  // namespace uw::test
