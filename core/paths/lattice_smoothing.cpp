#include "core/paths/lattice_smoothing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/paths/lattice_fit.h"

namespace uw {

namespace {

constexpr std::array<int, 5> k_scale_radii{0, 1, 2, 4, 8};  // of the neighbourhoods
constexpr int k_max_radius = k_max_neighbourhood;
// From this radius on, a change counts as one of the widest neighbourhoods.
constexpr int k_wide_radius = 4;
// A bias is assumed as far as the median of the products is above this fraction of the variance.
// The noise of the median is about as great.
constexpr double k_noise_of_bias = 0.4;
// What counts is the error of what an eye takes in at a time, which is some nodes across: they
// share a bias of the widest neighbourhood, but not all of the noise that it takes away.
constexpr double k_shared_noise = 0.5;
// A node whose variance is this many times the median of those around it weighs less in their fits,
// in inverse proportion. Behind a lamp in view, where it is dark, a few bright paths reach some
// nodes, which would light up all around them and leave a dark ring beyond.
constexpr float k_usual_variances = 4;
static_assert(k_scale_radii.back() == k_max_radius &&
              k_smoothing_reach == k_max_radius + static_cast<int>(k_scale_radii.size()) - 1);

struct Step {
    int dx, dy;
};

// The offsets within the widest neighbourhood, the nearest first.
std::vector<Step> steps_by_distance() {
    const auto square = [](const Step& step) { return step.dx * step.dx + step.dy * step.dy; };
    std::vector<Step> steps;
    for (int dy = -k_max_radius; dy <= k_max_radius; ++dy)
        for (int dx = -k_max_radius; dx <= k_max_radius; ++dx)
            if (square({dx, dy}) < square({k_max_radius + 1, 0})) steps.push_back({dx, dy});
    std::ranges::stable_sort(steps, std::less(), square);
    return steps;
}

/// The fits of all nodes within one radius.
struct Scale {
    std::vector<char> is_known;
    std::array<std::vector<float>, 2> halves;
    std::vector<float> variance_of_mean, variances;

    Scale(std::size_t nodes, std::size_t values, std::size_t bands)
        : is_known(nodes, 0),
          halves{std::vector<float>(nodes * values), std::vector<float>(nodes * values)},
          variance_of_mean(nodes),
          variances(nodes * bands) {}
};

class Smoothing {
  public:
    Smoothing(const LatticeLight& of, const NodeWindow& window)
        : of_(of),
          window_(window),
          scales_(k_scale_radii.size(), {of.size(), of.values, of.bands}) {
        const std::size_t count = of.size() * of.bands;
        smoothed_ = {std::vector<char>(of.size(), 0),
                     {},
                     std::vector<float>(count),
                     {std::vector<float>(count), std::vector<float>(count)}};
        for (auto* numbers : {&variance_of_mean_, &products_, &noise_, &factors_})
            numbers->assign(of.size(), 0.0F);
        for (std::vector<float>& half : halves_) half.assign(of.size() * of.values, 0.0F);
        unit_.assign(of.size(), 1.0);
    }

    template <class TakesPart>
    void fit(const TakesPart& takes_part);
    template <class Belong>
    void widen(std::size_t scale, const Belong& belong);
    SmoothedLight result();

  private:
    // Calls visit(i, j, index) for the nodes of the window.
    template <class Visit>
    void for_each(const Visit& visit) const {
        const int columns = window_.i1 - window_.i0;
        parallel_for(window_.size(), [&](std::size_t at) {
            const int i = window_.i0 + static_cast<int>(at) % columns;
            const int j = window_.j0 + static_cast<int>(at) / columns;
            visit(i, j, index(i, j));
        });
    }
    std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(of_.width) +
               static_cast<std::size_t>(i);
    }
    void limit_weights_of_noise(std::vector<FitNode>& near) const;
    void add(const FitWeight& weight, std::size_t own, Scale& scale) const;
    void compare(const Scale& scale, std::size_t own);
    void move_towards(const Scale& scale, bool is_wide, std::size_t own);

    const LatticeLight& of_;
    NodeWindow window_;
    std::vector<Scale> scales_;
    std::vector<double> unit_;  // by node: what differences are relative to
    // The light so far, and the change to the next scale.
    SmoothedLight smoothed_;
    std::array<std::vector<float>, 2> halves_;
    std::vector<float> variance_of_mean_, products_, noise_, factors_;
};

template <class TakesPart>
void Smoothing::fit(const TakesPart& takes_part) {
    const std::vector<Step> steps = steps_by_distance();
    for_each([&](int i, int j, std::size_t own) {
        std::vector<FitNode> near;
        double weights = 0, brightness = 0;
        for (const bool strictly : {true, false}) {
            for (const auto& [dx, dy] : steps) {
                const int u = i + dx, v = j + dy;
                if (u < 0 || v < 0 || u >= of_.width || v >= of_.height) continue;
                const std::size_t other = index(u, v);
                if (!(of_.weights[other] > 0) || !takes_part(own, other, strictly)) continue;
                near.push_back({dx, dy, other, of_.weights[other]});
                weights += of_.weights[other];
                brightness += of_.brightness[other];
            }
            if (!near.empty()) break;
        }
        if (brightness > 0) unit_[own] = brightness / weights;
        limit_weights_of_noise(near);
        LatticeFit fit;
        for (std::size_t k = 0; k < k_scale_radii.size(); ++k) {
            if (!fit.fit(near, k_scale_radii[k])) continue;
            scales_[k].is_known[own] = 1;
            for (const FitWeight& weight : fit.weights()) add(weight, own, scales_[k]);
        }
    });
}

void Smoothing::limit_weights_of_noise(std::vector<FitNode>& near) const {
    if (near.empty()) return;
    std::vector<float> variances;
    for (const FitNode& node : near) variances.push_back(of_.variances[node.index]);
    const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
    std::ranges::nth_element(variances, middle);
    const float usual = k_usual_variances * *middle;
    if (!(usual > 0)) return;
    for (FitNode& node : near)
        if (const float variance = of_.variances[node.index]; variance > usual)
            node.weight *= static_cast<double>(usual / variance);
}

void Smoothing::add(const FitWeight& weight, std::size_t own, Scale& scale) const {
    const auto w = static_cast<float>(weight.weight);
    for (const std::size_t half : {0U, 1U}) {
        const float* from = &of_.halves[half][weight.index * of_.values];
        float* to = &scale.halves[half][own * of_.values];
        for (std::size_t v = 0; v < of_.values; ++v) to[v] += w * from[v];
    }
    scale.variance_of_mean[own] += w * w * of_.variances[weight.index];
    // The difference of the halves has four times the variance of their mean.
    for (std::size_t b = 0; b < of_.bands; ++b) {
        float difference = 0;
        for (std::size_t v = weight.index * of_.values + b; v < (weight.index + 1) * of_.values;
             v += of_.bands)
            difference += of_.halves[0][v] - of_.halves[1][v];
        scale.variances[own * of_.bands + b] += 0.25F * w * w * difference * difference;
    }
}

// Sets the product of the changes of both halves, and the variance that the change takes away.
void Smoothing::compare(const Scale& scale, std::size_t own) {
    products_[own] = noise_[own] = 0;
    if (!scale.is_known[own] || !smoothed_.is_known[own]) return;
    std::array<double, 2> change{};
    for (const std::size_t half : {0U, 1U})
        for (std::size_t v = 0; v < of_.values; ++v) {
            const std::size_t at = own * of_.values + v;
            change[half] += static_cast<double>(of_.band_weights[own * of_.bands + v % of_.bands] *
                                                (scale.halves[half][at] - halves_[half][at]));
        }
    const double unit = unit_[own] * static_cast<double>(of_.bands);
    products_[own] = static_cast<float>(change[0] * change[1] / (unit * unit));
    const float taken = variance_of_mean_[own] - scale.variance_of_mean[own];
    noise_[own] =
        static_cast<float>(std::max(0.0, static_cast<double>(taken)) / (unit_[own] * unit_[own]));
}

template <class Belong>
void Smoothing::widen(std::size_t k, const Belong& belong) {
    const Scale& scale = scales_[k];
    for_each([&](int, int, std::size_t own) { compare(scale, own); });
    for_each([&](int i, int j, std::size_t own) {
        factors_[own] = scale.is_known[own] ? 1.0F : 0.0F;
        if (!scale.is_known[own] || !smoothed_.is_known[own]) return;
        std::array<float, 8> products{};
        std::size_t count = 0;
        double noise = static_cast<double>(noise_[own]);
        for (int v = std::max(window_.j0, j - 1); v <= std::min(window_.j1 - 1, j + 1); ++v)
            for (int u = std::max(window_.i0, i - 1); u <= std::min(window_.i1 - 1, i + 1); ++u) {
                const std::size_t other = index(u, v);
                if (other == own || !scale.is_known[other] || !smoothed_.is_known[other] ||
                    !belong(own, other))
                    continue;
                products[count++] = products_[other];
                noise += static_cast<double>(noise_[other]);
            }
        noise /= static_cast<double>(count + 1);
        if (count == 0) products[count++] = products_[own];
        const auto middle = static_cast<std::ptrdiff_t>((count - 1) / 2);
        std::nth_element(products.begin(), products.begin() + middle,
                         products.begin() + static_cast<std::ptrdiff_t>(count));
        const double bias = static_cast<double>(products[static_cast<std::size_t>(middle)]) -
                            k_noise_of_bias * noise;
        if (k_scale_radii[k] == k_max_radius) noise *= k_shared_noise;
        if (bias > 0) factors_[own] = static_cast<float>(noise / (noise + bias));
    });
    for_each([&](int, int, std::size_t own) {
        move_towards(scale, k_scale_radii[k] >= k_wide_radius, own);
    });
}

// Variances add up as if the wider fit were the mean of the light so far and of others: what the
// two have in common has the variance of the wider fit.
void Smoothing::move_towards(const Scale& scale, bool is_wide, std::size_t own) {
    const float factor = factors_[own];
    if (!(factor > 0)) return;
    smoothed_.is_known[own] = 1;
    const float kept = (1 - factor) * (1 - factor);
    const auto mix = [&](float& narrow, float wide) { narrow = kept * narrow + (1 - kept) * wide; };
    mix(variance_of_mean_[own], scale.variance_of_mean[own]);
    for (std::size_t k = own * of_.bands; k < (own + 1) * of_.bands; ++k)
        mix(smoothed_.variances[k], scale.variances[k]);
    for (const std::size_t half : {0U, 1U})
        for (std::size_t v = 0; v < of_.values; ++v) {
            const std::size_t at = own * of_.values + v;
            const float change = factor * (scale.halves[half][at] - halves_[half][at]);
            halves_[half][at] += change;
            if (is_wide) smoothed_.shifts[half][own * of_.bands + v % of_.bands] += change;
        }
}

SmoothedLight Smoothing::result() {
    smoothed_.light = std::move(halves_[0]);
    for (std::size_t k = 0; k < smoothed_.light.size(); ++k)
        smoothed_.light[k] = 0.5F * (smoothed_.light[k] + halves_[1][k]);
    return std::move(smoothed_);
}

}  // namespace

LatticeLight::LatticeLight(int columns, int rows, std::size_t values_of_node,
                           std::size_t bands_of_node)
    : width(columns), height(rows), values(values_of_node), bands(bands_of_node) {
    const std::size_t nodes = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    weights.assign(nodes, 0.0);
    for (std::vector<float>& half : halves) half.assign(nodes * values, 0.0F);
    band_weights.assign(nodes * bands, 1.0F);
    variances.assign(nodes, 0.0F);
    brightness.assign(nodes, 0.0);
}

SmoothedLight smooth(
    const LatticeLight& light, const NodeWindow& window,
    const std::function<bool(std::size_t own, std::size_t other, bool strictly)>& takes_part,
    const std::function<bool(std::size_t own, std::size_t other)>& belong) {
    Smoothing smoothing(light, window);
    smoothing.fit(takes_part);
    for (std::size_t k = 0; k < k_scale_radii.size(); ++k) smoothing.widen(k, belong);
    return smoothing.result();
}

}  // namespace uw
