// ctest labels: unit analytic threads
#include "core/passes/mirrored_blur.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <thread>
#include <vector>

namespace uw {
namespace {

std::vector<double> uneven_line(int length) {
    std::vector<double> line;
    for (int i = 0; i < length; ++i) line.push_back(std::sin(1.7 * i) + 0.1 * i);
    return line;
}

TEST(CosineTransform, IsTheSumOfItsDefinition) {
    for (const int n : {1, 2, 3, 8, 17, 30}) {
        const std::vector<double> x = uneven_line(n);
        std::vector<double> y = x;
        CosineTransform(n).forward(y.data());
        for (int k = 0; k < n; ++k) {
            double sum = 0;
            for (int j = 0; j < n; ++j)
                sum += 2 * x[static_cast<std::size_t>(j)] *
                       std::cos(std::numbers::pi * k * (j + 0.5) / n);
            EXPECT_NEAR(y[static_cast<std::size_t>(k)], sum, 1e-12) << n << " " << k;
        }
    }
}

TEST(CosineTransform, ThereAndBackIsTheLineTimesItsScale) {
    for (const int n : {1, 2, 5, 64, 101}) {
        const CosineTransform transform(n);
        EXPECT_EQ(transform.length(), n);
        EXPECT_EQ(transform.scale(), 2.0 * n);
        const std::vector<double> x = uneven_line(n);
        std::vector<double> y = x;
        transform.forward(y.data());
        transform.inverse(y.data());
        for (std::size_t i = 0; i < y.size(); ++i)
            EXPECT_NEAR(y[i], transform.scale() * x[i], 1e-11 * n);
    }
}

TEST(CosineTransform, GivesTheSameBitsAnywhere) {
    // Whatever the line's alignment, the thread, or the plan.
    const std::vector<double> x = uneven_line(33);
    std::vector<double> first = x;
    CosineTransform(33).forward(first.data());
    const CosineTransform again(33);
    for (std::size_t offset = 0; offset < 4; ++offset) {
        std::vector<double> storage(offset, 0.0);
        storage.insert(storage.end(), x.begin(), x.end());
        std::thread([&] { again.forward(storage.data() + offset); }).join();
        EXPECT_EQ(std::vector<double>(storage.begin() + static_cast<std::ptrdiff_t>(offset),
                                      storage.end()),
                  first);
    }
}

TEST(CosineTransform, NeedsAValue) {
    EXPECT_THROW(CosineTransform(0), std::invalid_argument);
    EXPECT_THROW(CosineTransform(-3), std::invalid_argument);
}

}  // namespace
}  // namespace uw
