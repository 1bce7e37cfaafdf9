// ctest labels: unit
#include "render/snow/snow_model.h"

#include <gtest/gtest.h>

#include <functional>

namespace uw::test {
namespace {

/// One lamp's light as a function of the distance.
class Known final : public Integrator {
  public:
    explicit Known(std::function<double(double)> light) : light_(std::move(light)) {}
    void in_scatter(const Ray& /*ray*/, std::span<const double> distances,
                    InScatter& result) const override {
        result.reset(distances.size(), 1);
        for (std::size_t i = 0; i < distances.size(); ++i)
            result.at(i, 0)[0] = light_(distances[i]);
    }

  private:
    std::function<double(double)> light_;
};

double beyond(const std::function<double(double)>& light) {
    const BeyondSnow all(std::make_unique<Known>([](double) { return 1.0; }),
                         std::make_unique<Known>(light), {{2, 0.25}, {3, 0.75}});
    InScatter result;
    all.in_scatter({{0, 0, 0}, {0, 0, 1}}, std::vector<double>{1, 4}, result);
    EXPECT_EQ(result.at(0, 0)[0], 1) << "nothing is beyond";
    return result.at(1, 0)[0] - 1;
}

TEST(BeyondSnow, AddsEachPartFromWhereItIsNotDrawn) {
    EXPECT_DOUBLE_EQ(beyond([](double s) { return 8 * s; }), 0.25 * 16 + 0.75 * 8);
}

// As of a single slab, which is weighted in its middle.
TEST(BeyondSnow, TakesNothingAway) {
    EXPECT_EQ(beyond([](double s) { return 1 / s; }), 0);
}

}  // namespace
}  // namespace uw::test
