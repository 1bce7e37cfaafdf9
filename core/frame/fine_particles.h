#pragma once

#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray_source.h"
#include "core/image/film.h"
#include "core/integrators/lit_scene.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// Clouds of particles that are small in an image: rays that are some pixels apart may pass beside
/// them. Probes are finer: rays k_spacing pixels apart, or twice that in an even haze, of which
/// only the particles are known.
class FineParticles {
  public:
    static constexpr int k_spacing = 2;  // [pixels]

    /// Both must outlive this object.
    FineParticles(const RaySource& rays, const LitScene& scene);

    /// The probes of a tile are traced up to `reach` [m], once they are asked for. `edge`: of its
    /// squares, which are whole beyond the image's edge [pixels].
    void begin(const PixelWindow& tile, int edge, double reach);

    /// Whether the square of `size` pixels at (i, j) of the tile holds particles that rays at
    /// multiples of `spacing` in it do not tell of, by interpolation between them. All of them are
    /// multiples of k_spacing.
    bool has_any(int i, int j, int size, int spacing);

  private:
    /// Pixels of the tile.
    struct Square {
        int x, y, width, height;
    };

    double taken(int i, int j);
    Interval range(const Square& square, int step);
    // Whether a probe is farther than `allowed` from interpolation between rays `spacing` apart.
    bool differs(const Square& square, int step, int spacing, double allowed);

    const RaySource& rays_;
    const ConcentrationField* field_;
    AttenuationTable attenuation_;
    double reach_ = 0;
    PixelWindow tile_;
    // Shares of light that particles take away, at probes, mean over the bands; < 0: not yet known.
    Grid2D<double> taken_;
    std::vector<double> column_;
};

}  // namespace uw
