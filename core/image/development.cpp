#include "core/image/development.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/camera_sensor.h"
#include "core/image/colour.h"

namespace uw {

namespace {

SampledCurve read_curve_table(const ResponseCurveDesc& desc) {
    const SampledCurve curve = read_csv_file(desc.file, desc.where).curve("input", "output");
    const auto is_within = [](double value) { return value >= 0 && value <= 1; };
    if (curve.first() != 0 || curve.last() != 1 || !std::ranges::all_of(curve.y, is_within) ||
        !std::ranges::is_sorted(curve.y))
        throw InputError(
            fmt::format("{}: '{}' must have inputs from 0 to 1, and outputs from 0 to "
                        "1 that never fall; divide both by their greatest",
                        desc.where, desc.file.filename().string()));
    return curve;
}

}  // namespace

ResponseCurve::ResponseCurve(const ResponseCurveDesc& desc) : desc_(desc) {
    if (desc.type == ResponseCurveDesc::Type::file) table_ = read_curve_table(desc);
}

double ResponseCurve::operator()(double value) const {
    value = value > 0 ? std::min(value, 1.0) : 0.0;
    switch (desc_.type) {
        case ResponseCurveDesc::Type::linear:
            break;
        case ResponseCurveDesc::Type::srgb:
            return srgb_encode(value);
        case ResponseCurveDesc::Type::gamma:
            return std::pow(value, 1 / desc_.gamma);
        case ResponseCurveDesc::Type::file:
            return table_->value(value);
    }
    return value;
}

/// The layer `sensor` of a film.
class Development::Numbers {
  public:
    Numbers(const Film& film, const SensorDesc& desc)
        : film_(film), mosaic_(desc.mosaic), count_(value_count(desc.mosaic)) {
        const auto& names = film.channel_names();
        const auto found = std::ranges::find_if(
            names, [](std::string_view name) { return name.starts_with("sensor."); });
        first_ = static_cast<std::size_t>(found - names.begin());
    }

    std::size_t count() const { return count_; }
    std::size_t colour_of(int x, int y, std::size_t i) const {
        return count_ == 1 ? colour_at(mosaic_, x, y) : i;
    }
    std::span<const float> at(int x, int y) const {
        return film_.pixel(x, y).subspan(first_, count_);
    }
    bool holds(int x, int y) const {
        const PixelWindow& window = film_.window();
        return x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
    }

    /// `colour` at a pixel of a mosaic: its own number, or the mean of those nearest to it.
    double demosaiced(int x, int y, std::size_t colour) const {
        if (colour_at(mosaic_, x, y) == colour) return static_cast<double>(at(x, y)[0]);
        constexpr std::array<std::array<int, 2>, 8> k_around{
            {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};
        double sum = 0;
        int found = 0;
        for (std::size_t i = 0; i < k_around.size(); ++i) {
            if (i == 4 && found > 0) break;  // those beside it come first
            const int u = x + k_around[i][0], v = y + k_around[i][1];
            if (!holds(u, v) || colour_at(mosaic_, u, v) != colour) continue;
            sum += static_cast<double>(at(u, v)[0]);
            ++found;
        }
        return sum / found;  // any two rows and columns hold every colour
    }

  private:
    const Film& film_;
    SensorMosaic mosaic_;
    std::size_t count_, first_;
};

Development::Development(const SensorDesc& desc)
    : desc_(desc),
      curve_(desc.image.response),
      demosaics_(!desc.image.is_raw && desc.image.demosaic && is_bayer(desc.mosaic)) {}

DigitalImage Development::raw(const Numbers& numbers, const PixelWindow& window) const {
    DigitalImage image{window.width(),
                       window.height(),
                       static_cast<int>(numbers.count()),
                       desc_.bit_depth > 8 ? 16 : 8,
                       false,
                       {}};
    const int shift = image.bits - desc_.bit_depth;
    image.values.reserve(image.row_values() * static_cast<std::size_t>(window.height()));
    for (int y = window.y0; y < window.y1; ++y) {
        throw_if_stopped();
        for (int x = window.x0; x < window.x1; ++x)
            for (const float number : numbers.at(x, y))
                image.values.push_back(
                    static_cast<std::uint16_t>(static_cast<unsigned>(number) << shift));
    }
    return image;
}

std::array<double, 3> Development::gains(const Numbers& numbers, const PixelWindow& window) const {
    if (const auto* gains = std::get_if<DevelopmentDesc::Gains>(&desc_.image.white_balance))
        return *gains;
    // What is saturated has lost its colour.
    std::array<double, 3> sums{}, counts{};
    for (int y = window.y0; y < window.y1; ++y) {
        throw_if_stopped();
        for (int x = window.x0; x < window.x1; ++x)
            for (std::size_t i = 0; i < numbers.count(); ++i) {
                const double number = static_cast<double>(numbers.at(x, y)[i]);
                if (number >= desc_.white_level()) continue;
                sums[numbers.colour_of(x, y, i)] += number - desc_.black_level;
                counts[numbers.colour_of(x, y, i)] += 1;
            }
    }
    std::array<double, 3> result{1, 1, 1};
    for (std::size_t c = 0; c < 3; ++c)
        if (sums[c] > 0 && sums[1] > 0) result[c] = (sums[1] / counts[1]) / (sums[c] / counts[c]);
    return result;
}

DigitalImage Development::operator()(const Film& film, const PixelWindow& window) const {
    const Numbers numbers(film, desc_);
    if (desc_.image.is_raw) return raw(numbers, window);
    const std::array<double, 3> gain = gains(numbers, window);
    const std::size_t channels = demosaics_ ? 3 : numbers.count();
    DigitalImage image{window.width(),
                       window.height(),
                       static_cast<int>(channels),
                       desc_.image.bits,
                       desc_.image.response.type == ResponseCurveDesc::Type::srgb,
                       {}};
    const double greatest = static_cast<double>((1 << desc_.image.bits) - 1);
    const double scale = 1 / (desc_.white_level() - desc_.black_level);
    image.values.resize(image.row_values() * static_cast<std::size_t>(window.height()));
    parallel_for(static_cast<std::size_t>(window.height()), [&](std::size_t line) {
        const int y = window.y0 + static_cast<int>(line);
        std::uint16_t* out = &image.values[line * image.row_values()];
        for (int x = window.x0; x < window.x1; ++x)
            for (std::size_t c = 0; c < channels; ++c) {
                const std::size_t colour = demosaics_ ? c : numbers.colour_of(x, y, c);
                const double number = demosaics_ ? numbers.demosaiced(x, y, c)
                                                 : static_cast<double>(numbers.at(x, y)[c]);
                const double light = gain[colour] * scale * (number - desc_.black_level);
                *out++ = static_cast<std::uint16_t>(std::lround(greatest * curve_(light)));
            }
    });
    return image;
}

}  // namespace uw
