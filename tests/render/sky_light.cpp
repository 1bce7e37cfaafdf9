// ctest labels: analytic statistical
// The light of a sky in the water, scattered once and of all orders, against quadratures over the
// whole sky: a source that is sampled, of which no part shows as a lamp of its own.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/numerics.h"
#include "core/light/sky.h"
#include "core/paths/path_tracer.h"
#include "core/scene/scene_desc.h"
#include "render/scene_assembly.h"
#include "tests/support/adaptive_quadrature.h"
#include "tests/support/film_rendering.h"
#include "tests/support/fresnel_by_angles.h"
#include "tests/support/scene_folder.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

constexpr double k_depth_below_sky = 2, k_index_below_sky = 1.34;
const double k_window_cosine = std::sqrt(1 - 1 / (k_index_below_sky * k_index_below_sky));

/// The radiance of a sky in the water, by the direction towards it; up is y.
class RefractedSky {
  public:
    explicit RefractedSky(const Sky& sky)
        : sky_(sky), sky_from_world_(glm::transpose(sky.world_from_sky())) {}

    Spectrum radiance(const Vector3& towards) const {
        const double x = k_index_below_sky * towards.x, z = k_index_below_sky * towards.z;
        const double square = x * x + z * z;
        if (!(towards.y > 0) || square >= 1) return {};
        const double up = std::sqrt(1 - square), angle = std::acos(up);
        const double transmittance =
            angle > 1e-6 ? fresnel_by_angles(angle, 1, k_index_below_sky).mean()
                         : 1 - std::pow((k_index_below_sky - 1) / (k_index_below_sky + 1), 2);
        return k_index_below_sky * k_index_below_sky * transmittance *
               sky_.radiance(sky_from_world_ * Vector3(x, up, z));
    }

  private:
    const Sky& sky_;
    Matrix3 sky_from_world_;
};

/// int L(w) f(psi, w) dw over the sky in one band, in polar coordinates about `axis`, psi and phi,
/// to a relative error of about 2e-4.
template <class Function>
double over_sky(const RefractedSky& sky, std::size_t band, const Vector3& axis,
                const Function& function) {
    const Vector3 up(0, 1, 0);
    const Vector3 across = glm::length(glm::cross(up, axis)) > 1e-9
                               ? glm::normalize(glm::cross(up, axis))
                               : Vector3(1, 0, 0);
    const Vector3 upwards = glm::cross(axis, across);  // phi = 0
    const double sine_of_axis = glm::dot(upwards, up);
    const auto ring = [&](double psi) {
        // The sky stands at up . w >= the window's cosine.
        const double limit = (k_window_cosine - std::cos(psi) * axis.y) /
                             std::max(1e-12, std::sin(psi) * sine_of_axis);
        if (limit >= 1) return 0.0;
        const double end = limit <= -1 ? std::numbers::pi : std::acos(limit);
        const auto at = [&](double phi) {
            const Vector3 towards =
                glm::normalize(std::cos(psi) * axis +
                               std::sin(psi) * (std::cos(phi) * upwards + std::sin(phi) * across));
            return sky.radiance(towards)[band] * function(psi, towards);
        };
        // Fine near the end, where the transmittance rises like a square root.
        const auto from_end = [&](double t) {
            const double phi = end * (1 - t * t);
            return (at(phi) + at(-phi)) * 2 * t * end;
        };
        double sum = 0;
        constexpr int k_panels = 12;
        for (int i = 0; i < k_panels; ++i)
            for (const QuadratureNode& node : gauss_legendre(4))
                sum += node.weight / k_panels * from_end((i + node.position) / k_panels);
        return sum * std::sin(psi);
    };
    // By the logarithm of tan(psi / 2), which resolves forward peaks.
    const auto by_octave = [&](double octave) {
        const double h = std::exp2(octave);
        return ring(2 * std::atan(h)) * 2 * h / (1 + h * h) * std::numbers::ln2;
    };
    double sum = 0;
    constexpr double k_min_octave = -24, k_max_octave = 8;
    constexpr int k_panels_of_octaves = 32 * 6;
    for (int i = 0; i < k_panels_of_octaves; ++i)
        for (const QuadratureNode& node : gauss_legendre(3))
            sum += node.weight * (k_max_octave - k_min_octave) / k_panels_of_octaves *
                   by_octave(k_min_octave + (i + node.position) * (k_max_octave - k_min_octave) /
                                                k_panels_of_octaves);
    return sum;
}

struct SkyCase {
    std::string name, sky, phase;
    double tolerance, at_edge;  // more near the edge, by as much as its light is blurred
};

std::ostream& operator<<(std::ostream& out, const SkyCase& value) {
    return out << value.name;
}

class SkyLight : public testing::TestWithParam<SkyCase> {
  protected:
    struct View {
        Vector3 position, look_at, up;
    };
    SceneDesc scene(const View& view, int width, int height, const std::string& more = "") const {
        const auto list = [](const Vector3& v) {
            return fmt::format("[{}, {}, {}]", v.x, v.y, v.z);
        };
        return read_scene(
            folder_.write(
                "scene.yaml",
                fmt::format(
                    "uwvdb: 1\n"
                    "camera: {{resolution: [{}, {}], intrinsics: {{fov_x: 50}}, pose: {{position: "
                    "{}, look_at: {}, up: {}}}}}\n"
                    "water: {{surface: {{height: 2, n: 1.34}}, bands: [620, 540, 450], absorption: "
                    "[0.3, 0.1, 0.05], scattering: {{b: [0.2, 0.3, 0.2], phase: {}}}}}\n"
                    "sky: {}\n"
                    "render: {{samples: 1}}\n{}",
                    width, height, list(view.position), list(view.look_at), list(view.up),
                    GetParam().phase, GetParam().sky, more)),
            {});
    }
    /// A camera 2 m below the surface that looks up by `tilt` degrees, over no floor.
    SceneDesc scene(double tilt, int width, int height) const {
        const double angle = tilt * k_degree;
        return scene({{0, 0, 0},
                      {0, std::sin(angle), -std::cos(angle)},
                      {0, std::cos(angle), std::sin(angle)}},
                     width, height);
    }
    /// What the water scatters once along `ray`.
    static double scattered_once(const AssembledScene& scene, const Ray& ray, std::size_t band) {
        const Medium& medium = scene.water.medium;
        const double c = medium.uniform.attenuation(band);
        const RefractedSky sky(*scene.sky);
        double sum = 0;
        for (std::size_t m = 0; m < medium.phase_functions.size(); ++m)
            sum += over_sky(sky, band, ray.direction, [&](double psi, const Vector3& towards) {
                const double rate = c * (1 - ray.direction.y / towards.y);
                const double length =
                    ray.direction.y > 0 ? k_depth_below_sky / ray.direction.y : 1e4;
                const double depth = rate * length;
                const double lit = std::abs(depth) < 1e-9 ? length : -std::expm1(-depth) / rate;
                return medium.uniform.scattering[m][band] * medium.phase_functions[m]->eval(psi) *
                       std::exp(-c * k_depth_below_sky / towards.y) * lit;
            });
        return sum;
    }

    SceneFolder folder_;
};

TEST_P(SkyLight, IsScatteredOnceAsByTheWholeSky) {
    for (const double tilt : {-75.0, -20.0, 25.0, 65.0}) {
        const TestScene built(scene(tilt, 8, 6));
        for (int y = 0; y < 6; ++y)
            for (int x = y % 2; x < 8; x += 4) {
                // Without what the surface mirrors.
                const Ray ray = *built.assembled().camera->refracted_ray(x + 0.5, y + 0.5);
                const double end = std::min(k_far, built.assembled().surfaces->hit_distance(ray));
                InScatter found;
                built.integrator().in_scatter(ray, std::span(&end, 1), found);
                const double truth = scattered_once(built.assembled(), ray, 1);
                // The blur of the phase functions, 1.4 degrees, counts where the sky ends.
                const double to_edge =
                    std::abs(std::acos(ray.direction.y) - std::acos(k_window_cosine));
                const double tolerance =
                    to_edge < 5 * k_degree ? GetParam().at_edge : GetParam().tolerance;
                EXPECT_NEAR(found.at(0, 0)[1] / truth, 1, tolerance)
                    << "tilt " << tilt << " elevation " << std::asin(ray.direction.y) / k_degree;
            }
    }
}

/// The sum of what paths contribute, in one band.
class BandSum final : public ContributionSink {
  public:
    explicit BandSum(std::size_t band) : band_(band) {}
    void add(const PathContribution& contribution) override { sum += contribution.radiance[band_]; }

    double sum = 0;

  private:
    std::size_t band_;
};

// Paths know nothing of the cells and blurs of the other integrators.
TEST_P(SkyLight, OfPathsIsThatOfTheWholeSky) {
    const TestScene built(scene(0, 1, 1));
    const LightTransport transport =
        make_path_transport(built.assembled(), built.assembled().scattering);
    constexpr int k_batches = 16, k_paths = 8192;
    for (const double elevation : {-80.0, -10.0, 20.0, 38.0, 45.0, 70.0}) {
        const Ray ray{{0, 0, 0},
                      {0.6 * std::cos(elevation * k_degree), std::sin(elevation * k_degree),
                       -0.8 * std::cos(elevation * k_degree)}};
        SurfaceHit hit;
        const bool has_hit = built.assembled().surfaces->closest_hit(ray, k_far, hit);
        CameraSegment segment;
        transport.paths->begin(ray, has_hit ? &hit : nullptr, {}, segment);
        double mean = 0, squares = 0;
        for (int batch = 0; batch < k_batches; ++batch) {
            BandSum sum(1);
            for (int i = 0; i < k_paths; ++i) {
                PathRandom random(PathRandom::seed_of(static_cast<std::uint64_t>(batch)),
                                  static_cast<std::uint32_t>(i));
                transport.paths->trace_single(segment, random, sum);
            }
            mean += sum.sum / k_paths / k_batches;
            squares += std::pow(sum.sum / k_paths, 2) / k_batches;
        }
        const double error =
            std::sqrt(std::max(0.0, squares - mean * mean) / (k_batches - 1)) / mean;
        const double truth = scattered_once(built.assembled(), ray, 1);
        EXPECT_LT(error, 0.01) << elevation;
        // Four standard errors, and those of the truth and of the sky's lattice.
        EXPECT_NEAR(mean / truth, 1, 4 * error + 2e-3) << elevation << " " << error;
    }
}

// Walls of any slope, and overhangs that only a part of the sky's light reaches.
TEST_P(SkyLight, FallsOnSurfacesOfAnySlope) {
    for (const double slope : {0.0, 40.0, 75.0, 100.0}) {
        const Vector3 normal{0, std::cos(slope * k_degree), std::sin(slope * k_degree)};
        const SceneDesc desc = scene(
            {{0, normal.y, normal.z - 1}, {0, 0, -1}, {1, 0, 0}}, 1, 1,
            fmt::format("geometry: [{{type: plane, point: [0, 0, -1], normal: [0, {}, {}]}}]\n",
                        normal.y, normal.z));
        const RenderedFilm film(desc);
        const TestScene built(desc);
        for (const std::size_t band : {0U, 1U, 2U}) {
            const double c = built.assembled().water.medium.uniform.attenuation(band);
            const double truth = over_sky(RefractedSky(*built.assembled().sky), band,
                                          Vector3(0, 1, 0), [&](double, const Vector3& towards) {
                                              return std::max(0.0, glm::dot(normal, towards)) *
                                                     std::exp(-c * k_depth_below_sky / towards.y);
                                          });
            // Attenuation, by an optical depth of 1 in the first band, is that of the directions
            // that represent parts.
            EXPECT_NEAR(film.value(Layer::irradiance, 0, 0, static_cast<int>(band)) / truth, 1,
                        0.025)
                << slope << " " << band;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Skies, SkyLight,
    testing::Values(SkyCase{"uniform_g0.9", "{model: uniform, irradiance: [1, 2, 3]}",
                            "{type: hg, g: 0.9}", 0.02, 0.025},
                    SkyCase{"overcast_g0.5", "{model: overcast, irradiance: [1, 2, 3]}",
                            "{type: hg, g: 0.5}", 0.01, 0.01},
                    SkyCase{"clear_g0.9", "{model: clear, sun: {azimuth: 60, elevation: 40}}",
                            "{type: hg, g: 0.9}", 0.03, 0.04},
                    SkyCase{"uniform_ff", "{model: uniform, irradiance: [1, 2, 3]}",
                            "{type: fournier-forand}", 0.02, 0.2}),
    [](const auto& each) {
        std::string name = each.param.name;
        for (char& c : name)
            if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
        return name;
    });

}  // namespace
}  // namespace uw::test
