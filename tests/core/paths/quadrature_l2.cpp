// ctest labels: analytic statistical slow
// Double scattering with a black box that casts a shadow, against a four-dimensional quadrature:
// along the camera ray, over the directions there, and along each of those in the angle of the
// first scattering.
#include <gtest/gtest.h>

#include "tests/support/geometry_descs.h"
#include "tests/support/paths/path_scene.h"
#include "tests/support/paths/term_sums.h"

namespace uw::test {
namespace {

using std::numbers::pi;
constexpr double k_asymmetry = 0.7;
constexpr double k_unit = 100;  // [m]; a lamp's sphere of 1 mm is a point in comparison
constexpr BandOptics k_water{0.3 / k_unit, 0.7 / k_unit};
constexpr double k_c = k_water.absorption + k_water.scattering;
constexpr Point3 k_lamp{1.0 * k_unit, -0.5 * k_unit, 0.3 * k_unit};
constexpr Point3 k_min{0.3 * k_unit, -0.5 * k_unit, 0.7 * k_unit};
constexpr Point3 k_max{0.8 * k_unit, 0.1 * k_unit, 1.2 * k_unit};
// The distances at which the camera ray is divided.
constexpr std::array k_cuts{0.0, 1.0 * k_unit, 2.0 * k_unit, 12.0 * k_unit};
constexpr std::size_t k_parts = k_cuts.size() - 1;

Ray camera_ray() {
    return {{0, 0, 0}, glm::normalize(Vector3(0.1, -0.05, 1))};
}

double phase(double cosine) {
    const double q = 1 + k_asymmetry * k_asymmetry - 2 * k_asymmetry * cosine;
    return (1 - k_asymmetry * k_asymmetry) / (4 * pi * q * std::sqrt(q));
}

/// Gauss-Legendre quadrature with four nodes on `panels` equal parts of [a, b].
template <class Function>
double integrate(double a, double b, int panels, const Function& f) {
    constexpr std::array<std::array<double, 2>, 4> k_nodes{
        {{0.069431844202973712, 0.17392742256872693},
         {0.33000947820757187, 0.32607257743127307},
         {0.66999052179242813, 0.32607257743127307},
         {0.93056815579702629, 0.17392742256872693}}};
    const double width = (b - a) / panels;
    double sum = 0;
    for (int i = 0; i < panels; ++i)
        for (const auto& [x, w] : k_nodes) sum += w * width * f(a + (i + x) * width);
    return sum;
}

/// The box's shadow volume together with the box: a convex body, bounded by the faces that are
/// visible from the lamp and by the planes through the lamp and the silhouette edges.
class Shadow {
  public:
    Shadow() {
        const Vector3 middle = 0.5 * (from_origin(k_min) + from_origin(k_max));
        const auto corner = [](int axis, int side) { return side > 0 ? k_max[axis] : k_min[axis]; };
        const auto is_lit = [&](int axis, int side) {
            return side * (k_lamp[axis] - corner(axis, side)) > 0;
        };
        for (int axis = 0; axis < 3; ++axis) {
            const int second = (axis + 1) % 3, third = (axis + 2) % 3;
            for (const int side : {-1, 1}) {
                if (is_lit(axis, side)) {
                    Vector3 normal(0);
                    normal[axis] = side;
                    planes_.push_back({normal, side * corner(axis, side)});
                }
                for (const int other : {-1, 1}) {
                    if (is_lit(axis, side) == is_lit(second, other)) continue;
                    Vector3 p, q;
                    p[axis] = q[axis] = corner(axis, side);
                    p[second] = q[second] = corner(second, other);
                    p[third] = k_min[third];
                    q[third] = k_max[third];
                    const Vector3 lamp = from_origin(k_lamp);
                    Vector3 normal = glm::normalize(glm::cross(p - lamp, q - lamp));
                    if (glm::dot(normal, middle - lamp) > 0) normal = -normal;
                    planes_.push_back({normal, glm::dot(normal, lamp)});
                }
            }
        }
    }

    /// The shadowed interval of a ray; empty where there is none.
    Interval on(const Ray& ray) const {
        Interval dark{0, 1e9};
        for (const Plane& plane : planes_) {
            const double away = glm::dot(plane.normal, ray.direction);
            const double s =
                (plane.offset - glm::dot(plane.normal, from_origin(ray.origin))) / away;
            if (away > 0)
                dark.end = std::min(dark.end, s);
            else
                dark.begin = std::max(dark.begin, s);
        }
        return dark.length() > 0 ? dark : Interval{0, 0};
    }

  private:
    struct Plane {
        Vector3 normal;
        double offset;  // within where normal . x < offset
    };
    std::vector<Plane> planes_;
};

/// The distance at which a ray enters the box.
double box_distance(const Ray& ray) {
    double enter = 0, leave = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (k_min[axis] - ray.origin[axis]) / ray.direction[axis];
        const double b = (k_max[axis] - ray.origin[axis]) / ray.direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter < leave ? enter : 1e9;
}

/// Single scattering of a lamp of 1 W/sr towards the origin of `ray` (docs/physics.md).
double once_scattered(const Ray& ray, const Shadow* shadow, int panels) {
    const Vector3 to_lamp = k_lamp - ray.origin;
    const double foot = glm::dot(to_lamp, ray.direction);
    const double d = glm::length(to_lamp - foot * ray.direction);
    const auto psi_at = [&](double s) { return std::atan2(d, foot - s); };
    const auto part = [&](double begin, double end) {
        if (!(end > begin)) return 0.0;
        return integrate(psi_at(begin), psi_at(end), panels, [&](double psi) {
            return phase(std::cos(psi)) * std::exp(-k_c * (foot + d * std::tan(0.5 * psi)));
        });
    };
    double sum = 0;
    if (shadow) {
        const double end = box_distance(ray);
        const Interval dark = shadow->on(ray);
        sum = dark.length() > 0
                  ? part(0, std::min(dark.begin, end)) + part(std::min(dark.end, end), end)
                  : part(0, end);
    } else {
        sum = part(0, 1e9);
    }
    return k_water.scattering / d * sum;
}

/// Double scattering, the second time between two of k_cuts. `fineness` multiplies the smallest
/// sufficient number of nodes in each dimension.
double twice_scattered(std::size_t part, const Shadow* shadow, int fineness) {
    const Ray ray = camera_ray();
    const double foot = glm::dot(k_lamp - ray.origin, ray.direction);
    const double d = distance(k_lamp, ray.at(foot));
    const auto from_all_directions = [&](const Point3& x) {
        const Vector3 axis = glm::normalize(k_lamp - x);
        const Vector3 u = glm::normalize(glm::cross(axis, ray.direction)), v = glm::cross(u, axis);
        return integrate(0, pi, 8 * fineness, [&](double theta) {
            // The integrand is periodic but for the box: equal steps.
            const int steps = 32 * fineness;
            double ring = 0;
            for (int i = 0; i < steps; ++i) {
                const double phi = 2 * pi * (i + 0.5) / steps;
                const Vector3 w = std::cos(theta) * axis +
                                  std::sin(theta) * (std::cos(phi) * u + std::sin(phi) * v);
                ring += phase(glm::dot(w, ray.direction)) *
                        once_scattered({x, w}, shadow, 2 * fineness);
            }
            return std::sin(theta) * ring * 2 * pi / steps;
        });
    };
    // Integrates along the ray in the angle at which it is seen from the lamp.
    return integrate(std::atan((k_cuts[part] - foot) / d), std::atan((k_cuts[part + 1] - foot) / d),
                     3 * fineness, [&](double angle) {
                         const double s = foot + d * std::tan(angle);
                         const double ds = d / (std::cos(angle) * std::cos(angle));
                         return ds * std::exp(-k_c * s) * k_water.scattering *
                                from_all_directions(ray.at(s));
                     });
}

/// Sums contributions scattered once and twice, by the part of the ray where they leave it.
class Parts final : public ContributionSink {
  public:
    void add(const PathContribution& term) override {
        if (term.scatterings > 2 || term.reflections > 0) return;
        std::size_t part = 0;
        while (part + 1 < k_parts && term.distance >= k_cuts[part + 1]) ++part;
        (term.scatterings == 1 ? once : twice)[part] += term.radiance[0];
    }
    std::array<double, k_parts> once{}, twice{};
};

/// Batches of paths, with or without the box.
std::vector<Parts> trace(bool with_box) {
    constexpr std::size_t k_batches = 64;
    constexpr std::uint32_t k_paths = 1 << 12;
    PathScene scene({k_water}, k_asymmetry);
    scene.add_lamp(k_lamp, 1);
    if (with_box) scene.set_surfaces({with_reflectance(box(k_min, k_max), 0, 1)});
    const PathTracer tracer(scene.lit());
    std::vector<Parts> batches(k_batches);
    parallel_for(k_batches, [&](std::size_t n) {
        CameraSegment segment;
        tracer.begin(camera_ray(), nullptr, {}, segment);
        for (std::uint32_t i = 0; i < k_paths; ++i) {
            PathRandom single(PathRandom::seed_of(n, 1), i), water(PathRandom::seed_of(n, 2), i);
            tracer.trace_single(segment, single, batches[n]);
            trace_scattered(tracer, segment, water, batches[n]);
        }
        for (Parts* parts : {&batches[n]})
            for (std::array<double, k_parts>* sums : {&parts->once, &parts->twice})
                for (double& sum : *sums) sum /= k_paths;
    });
    return batches;
}

/// The batches with the box, for two tests.
const std::vector<Parts>& traced_with_box() {
    static const std::vector<Parts> k_batches = trace(true);
    return k_batches;
}

TEST(TwiceScattered, LightAgreesWithAQuadratureInTheShadowOfABox) {
    const Shadow shadow;
    Deviations deviations;
    double all = 0, all_without_box = 0;
    const std::vector<Parts>& batches = traced_with_box();
    for (std::size_t part = 0; part < k_parts; ++part) {
        const double rough = twice_scattered(part, &shadow, 2);
        const double truth = twice_scattered(part, &shadow, 3);
        // With half as many nodes again in each dimension: kinks at the edges of the shadow make
        // the errors fall as 1/n^2, so that they are less than the difference.
        EXPECT_NEAR(rough, truth, 1.5e-3 * truth) << part;
        BatchMeans means;
        for (const Parts& batch : batches) means.add(batch.twice[part]);
        deviations.add("part " + std::to_string(part), means, truth, std::abs(truth - rough));
        all += truth;
        all_without_box += twice_scattered(part, nullptr, 1);
    }
    deviations.expect_within_errors();
    deviations.expect_errors_below(0.02);
    // The shadow removes much of the light, or else the test would prove nothing about it.
    EXPECT_LT(all, 0.9 * all_without_box);
}

TEST(TwiceScattered, LightAgreesWithAQuadratureWithoutSurfaces) {
    Deviations deviations;
    const std::vector<Parts> batches = trace(false);
    for (std::size_t part = 0; part < k_parts; ++part) {
        const double rough = twice_scattered(part, nullptr, 2);
        const double truth = twice_scattered(part, nullptr, 3);
        EXPECT_NEAR(rough, truth, 2e-4 * truth) << part;
        BatchMeans means;
        for (const Parts& batch : batches) means.add(batch.twice[part]);
        deviations.add("part " + std::to_string(part), means, truth, std::abs(truth - rough));
    }
    deviations.expect_within_errors();
    deviations.expect_errors_below(0.02);
}

TEST(OnceScattered, LightAgreesWithAQuadratureInTheShadowOfABox) {
    const Shadow shadow;
    BatchMeans means;
    for (const Parts& batch : traced_with_box())
        means.add(batch.once[0] + batch.once[1] + batch.once[2]);
    Deviations deviations;
    deviations.add("all", means, once_scattered(camera_ray(), &shadow, 50));
    deviations.expect_within_errors();
    deviations.expect_errors_below(0.02);
}

}  // namespace
}  // namespace uw::test
