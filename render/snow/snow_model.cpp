#include "render/snow/snow_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/snow/snow_medium.h"

namespace uw {

namespace {

// Particles are drawn where they cover so much of a pixel, as long as they are not too many.
constexpr double k_least_cover = 1e-3;
// Above this, single particles are missed by the eye.
constexpr double k_visible_cover = 0.02;
// Light from beyond this optical depth, in the clearest band, is a thousandth of what it was.
constexpr double k_reach_depth = 6.9;
constexpr double k_farthest = 200;  // m
// Neighbouring covers that are tried.
constexpr double k_cover_step = 1.05;

/// The solid angle in water of the whole image [sr].
double view_angle(const Camera& camera) {
    constexpr int k_steps = 32;
    const auto ray = [&](int i, int j) {
        return camera.refracted_ray(static_cast<double>(i) / k_steps * camera.width(),
                                    static_cast<double>(j) / k_steps * camera.height());
    };
    double sum = 0;
    for (int j = 0; j < k_steps; ++j)
        for (int i = 0; i < k_steps; ++i) {
            const auto a = ray(i, j), b = ray(i + 1, j), c = ray(i, j + 1);
            if (a && b && c)
                sum += glm::length(
                    glm::cross(b->direction - a->direction, c->direction - a->direction));
        }
    return sum;
}

}  // namespace

double SnowModel::drawn_depth(double distance) const {
    double depth = 0;
    for (std::size_t k = 0; k < ranges.size(); ++k)
        depth += field.classes()[k].attenuation() * std::min(distance, ranges[k]);
    return depth;
}

std::vector<BeyondSnow::Part> SnowModel::parts() const {
    double all = 0;
    for (const SnowClass& kind : field.classes()) all += kind.attenuation();
    std::vector<BeyondSnow::Part> parts;
    for (std::size_t k = 0; k < ranges.size(); ++k)
        parts.push_back({ranges[k], field.classes()[k].attenuation() / all});
    return parts;
}

std::shared_ptr<const SnowModel> make_snow_model(const SnowDesc& desc, const Camera& camera,
                                                 const Medium& medium) {
    auto model = std::make_shared<SnowModel>(SnowModel{.field = SnowField(desc),
                                                       .water = without_snow(desc, medium),
                                                       .alone = snow_alone(desc, medium)});
    const std::vector<SnowClass>& classes = model->field.classes();
    const double least_c = medium.uniform.attenuation().least(medium.wavelengths_nm.size());
    const double reach = std::min(k_farthest, k_reach_depth / std::max(least_c, 1e-6));
    const double view = view_angle(camera);
    const double pixel = view / camera.width() / camera.height();
    model->ranges.assign(classes.size(), reach);
    double wanted = 0;  // of particles in view
    for (double cover = k_least_cover; view > 0; cover *= k_cover_step) {
        double count = 0;
        for (std::size_t k = 0; k < classes.size(); ++k) {
            double& range = model->ranges[k];
            range = std::min(reach, std::sqrt(classes[k].mean_area / (cover * pixel)));
            count += classes[k].number * view * range * range * range / 3;
        }
        model->expected_count = count;
        if (wanted == 0) wanted = count;
        if (count > desc.most) continue;
        if (cover > k_visible_cover)
            model->warning = fmt::format(
                "{}: of about {:.3g} particles in view {:.3g} are drawn, those that cover {:.2g} % "
                "of a pixel or more, and the others are their mean; give a greater least diameter "
                "or a smaller number, or most",
                desc.where, wanted, count, 100 * cover);
        break;
    }
    return model;
}

}  // namespace uw
