#pragma once

#include <array>
#include <optional>

#include "core/base/csv_table.h"
#include "core/image/film.h"
#include "core/image/pixel_image.h"
#include "core/scene/sensor_desc.h"

namespace uw {

/// How a camera encodes values, 0 to 1, before it stores them.
class ResponseCurve {
  public:
    /// Throws InputError for a table whose values are not between 0 and 1 or do not ascend; IoError
    /// if it cannot be read.
    explicit ResponseCurve(const ResponseCurveDesc& desc);

    /// Maps any value; those outside 0..1 become 0 or 1 first, NaN becomes 0.
    double operator()(double value) const;

  private:
    ResponseCurveDesc desc_;
    std::optional<SampledCurve> table_;
};

/// Turns the numbers of a sensor into the image that a camera stores (docs/camera-image.md).
///
/// Raw: the numbers themselves, times 2^(16 - bit depth) in 16 bits if they have more than 8.
/// Else: less the black level, relative to white; times the gains of the white balance; the two
/// colours that a pixel of a mosaic does not see as the mean of the nearest pixels that do (beside
/// it, or else diagonally: bilinear); encoded by the response curve; rounded to 8 or 16 bits.
class Development {
  public:
    /// Throws as ResponseCurve.
    explicit Development(const SensorDesc& desc);

    /// How many pixels around a window its pixels depend on.
    int margin() const { return demosaics_ ? 1 : 0; }

    /// The image of the pixels of `window`, from the layer `sensor` of a film that holds them and,
    /// as far as there are any, those within `margin` around them.
    DigitalImage operator()(const Film& film, const PixelWindow& window) const;

  private:
    class Numbers;

    DigitalImage raw(const Numbers& numbers, const PixelWindow& window) const;
    std::array<double, 3> gains(const Numbers& numbers, const PixelWindow& window) const;

    SensorDesc desc_;
    ResponseCurve curve_;
    bool demosaics_;
};

}  // namespace uw
