// ctest labels: unit analytic
#include "media/water/mie.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/base/numerics.h"

namespace uw {
namespace {

struct Published {
    double size_parameter;
    std::complex<double> index;
    double extinction, scattering, mean_cosine;
};

// Wiscombe 1979 (NCAR/TN-140), MIEV0's test cases 7 to 19, and Bohren and Huffman 1983, appendix A;
// to the digits that they print.
TEST(MieScattering, HasThePublishedEfficiencies) {
    const std::vector<Published> cases{
        {10, {0.75, 0}, 2.232265, 2.232265, 0.896473},
        {1000, {0.75, 0}, 1.997908, 1.997908, 0.844944},
        {1, {1.33, 1e-5}, 0.093952, 0.093923, 0.184517},
        {100, {1.33, 1e-5}, 2.101321, 2.096594, 0.868959},
        {10000, {1.33, 1e-5}, 2.004089, 1.723857, 0.907840},
        {1, {1.5, 1}, 2.336321, 0.663454, 0.192136},
        {100, {1.5, 1}, 2.097502, 1.283697, 0.850252},
        {10000, {1.5, 1}, 2.004368, 1.236574, 0.846310},
        {1, {10, 10}, 2.532993, 2.049405, -0.110664},
        {100, {10, 10}, 2.071124, 1.836785, 0.556215},
        {10000, {10, 10}, 2.005914, 1.795393, 0.548194},
        {2 * std::numbers::pi * 0.525 / 0.6328, {1.55, 0}, 3.10543, 3.10543, 0.63314},
        {2 * std::numbers::pi * 0.525 / 0.6328, {1.55, 0.1}, 2.861652, 1.664249, 0.801290}};
    for (const Published& published : cases) {
        const MieScattering mie({published.size_parameter, published.index, {}});
        const double digits = published.mean_cosine == 0.63314 ? 5.1e-6 : 1.1e-6;
        EXPECT_NEAR(mie.extinction_efficiency(), published.extinction, digits)
            << published.size_parameter << published.index;
        EXPECT_NEAR(mie.scattering_efficiency(), published.scattering, digits);
        EXPECT_NEAR(mie.mean_cosine(), published.mean_cosine, digits);
    }
}

// MIEV0's test case 14, S1 and S2 at 0, 30, 90 and 180 degrees.
TEST(MieScattering, HasThePublishedAmplitudes) {
    const MieScattering mie({1, {1.5, 1}, {}});
    const auto expect = [&](double degrees, std::complex<double> s1, std::complex<double> s2) {
        // Its time factor is e^(i omega t), so that its amplitudes are the conjugates of ours.
        const auto [a, b] = mie.amplitudes(std::cos(degrees * std::numbers::pi / 180));
        EXPECT_LT(std::abs(std::conj(a) - s1), 2e-6) << degrees;
        EXPECT_LT(std::abs(std::conj(b) - s2), 2e-6) << degrees;
    };
    expect(0, {0.584080, 0.190515}, {0.584080, 0.190515});
    expect(30, {0.565702, 0.187200}, {0.500161, 0.145611});
    expect(90, {0.456340, 0.167167}, {0.0362285, -0.0618265});
    expect(180, {0.348844, 0.146829}, {-0.348844, -0.146829});
}

// Bohren and Huffman 1983, appendix B: a small core in a thick coat that absorbs.
TEST(MieScattering, HasThePublishedCoatedSphere) {
    const double k = 2 * std::numbers::pi / 3;
    const MieScattering mie({k * 6.265, {1.409, 0.1747}, MieSphere::Core{k * 0.171, {1.59, 0.66}}});
    EXPECT_NEAR(mie.scattering_efficiency(), 1.14341, 5.1e-6);
    EXPECT_NEAR(mie.extinction_efficiency(), 2.32803, 5.1e-6);
    const double back = 4 * std::norm(mie.amplitudes(-1).first) / std::pow(k * 6.265, 2);
    EXPECT_NEAR(back, 0.0285099, 5.1e-8);
}

TEST(MieScattering, CoatedIsPlainWhereTheCoatVanishesOrIsAlike) {
    for (const double x : {0.1, 3.0, 200.0, 5000.0}) {
        const std::complex<double> inside{0.75, 0}, outside{1.2, 0.001};
        const MieScattering plain({x, inside, {}});
        const MieScattering thin({x, outside, MieSphere::Core{x * (1 - 1e-12), inside}});
        const MieScattering alike({x, inside, MieSphere::Core{x / 2, inside}});
        const MieScattering coat_alone({x, outside, {}});
        const MieScattering small_core({x, outside, MieSphere::Core{x * 1e-4, inside}});
        // Resonances of single orders magnify rounding at large sizes.
        EXPECT_NEAR(thin.scattering_efficiency() / plain.scattering_efficiency(), 1, 1e-6) << x;
        EXPECT_NEAR(alike.scattering_efficiency() / plain.scattering_efficiency(), 1, 1e-9) << x;
        // A core of a tenth of the wavelength at most.
        EXPECT_NEAR(small_core.extinction_efficiency() / coat_alone.extinction_efficiency(), 1,
                    1e-4)
            << x;
    }
}

TEST(MieScattering, IsRayleighsForSmallSpheresAndGeometricForLargeOnes) {
    const double x = 0.003;
    const std::complex<double> m{1.18, 0};
    const std::complex<double> polarisability = (m * m - 1.0) / (m * m + 2.0);
    const MieScattering small({x, m, {}});
    // The next term of the series is of the order x^2 (Bohren and Huffman 1983, eq. 5.8).
    EXPECT_NEAR(
        small.scattering_efficiency() / (8.0 / 3 * std::pow(x, 4) * std::norm(polarisability)), 1,
        2e-5);
    const MieScattering large({1e5, {1.2, 0.1}, {}});
    // Twice the geometric cross section (extinction paradox), with 1.99 x^(-2/3) of the edge
    // (Nussenzveig and Wiscombe 1980); their next term is of the order 1 / x.
    EXPECT_NEAR(large.extinction_efficiency(), 2 + 1.9924 * std::pow(1e5, -2.0 / 3), 3e-5);
}

// The optical theorem: what leaves the forward wave is scattered or absorbed. And the intensities'
// integral over all directions is the cross section.
TEST(MieScattering, ConservesEnergy) {
    for (const std::complex<double> m : {std::complex<double>{1.15, 0}, {0.746, 0}, {1.5, 0.02}})
        for (const double x : {0.5, 20.0, 300.0}) {
            const MieScattering mie({x, m, {}});
            const double forward = mie.amplitudes(1).first.real();
            EXPECT_NEAR(4 * forward / (x * x) / mie.extinction_efficiency(), 1, 1e-12);
            if (m.imag() == 0) {
                EXPECT_NEAR(mie.extinction_efficiency() / mie.scattering_efficiency(), 1, 1e-9);
            }
            // Gauss-Legendre on panels much narrower than the lobes, 180 / x degrees.
            std::vector<double> cosines, weights;
            const int panels = static_cast<int>(20 + 4 * x);
            for (int panel = 0; panel < panels; ++panel)
                for (const QuadratureNode& node : gauss_legendre(4)) {
                    const double width = std::numbers::pi / panels,
                                 psi = width * (panel + node.position);
                    cosines.push_back(std::cos(psi));
                    weights.push_back(2 * std::numbers::pi * node.weight * width * std::sin(psi));
                }
            std::vector<double> intensity(cosines.size(), 0.0);
            mie.add_intensity(1, cosines, intensity);
            double integral = 0;
            for (std::size_t i = 0; i < weights.size(); ++i) integral += weights[i] * intensity[i];
            EXPECT_NEAR(integral / (std::numbers::pi * x * x) / mie.scattering_efficiency(), 1,
                        1e-6)
                << x << m;
        }
}

}  // namespace
}  // namespace uw
