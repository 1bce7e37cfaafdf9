#include "dataset/formats/clean_film.h"

#include <algorithm>

#include "core/base/spectrum.h"
#include "core/base/stop.h"
#include "core/colour/colour_response.h"

namespace uw {

Film clean_film(const Film& film, const LayerPlan& plan, const ColourDesc& colour,
                std::span<const double> bands_nm) {
    const BandColour rgb_of = make_band_colour(colour, bands_nm);
    const auto first = static_cast<std::size_t>(plan.first_channel(Layer::clean));
    Film clean(film.width(), film.height(), film.window(), {"R", "G", "B", "A"});
    Spectrum radiance{};
    for (int y = 0; y < film.height(); ++y) {
        throw_if_stopped();
        for (int x = 0; x < film.width(); ++x) {
            const std::span<const float> pixel = film.pixel(x, y);
            std::ranges::copy(pixel.subspan(first, bands_nm.size()), radiance.begin());
            const std::span<float> out = clean.pixel(x, y);
            std::ranges::transform(rgb_of(radiance), out.begin(),
                                   [](double v) { return static_cast<float>(v); });
            out[k_alpha] = pixel[k_alpha];
        }
    }
    return clean;
}

}  // namespace uw
