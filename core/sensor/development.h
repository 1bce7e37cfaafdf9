#pragma once

#include <array>

#include "core/image/digital_image.h"
#include "core/image/film.h"
#include "core/scene/sensor_desc.h"
#include "core/sensor/response_curve.h"

namespace uw {

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
