#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/geometry/surface_reflection.h"
#include "core/geometry/surfaces.h"
#include "core/light/integrator.h"
#include "core/light/lamp.h"
#include "core/light/medium.h"

namespace uw {

/// Shadow rays from a surface sample in a penumbra to each part of the lamp.
inline constexpr int k_half_shade_rays = 4;

/// Light of every emitter (LitScene::emitters) on surface points, and the transmittance of the
/// water from the emitters to the points and from there to the camera.
class SurfaceLight {
  public:
    /// Resets everything to dark. `emitters` must outlive this object.
    void reset(std::size_t samples, const std::vector<Lamp>& emitters, std::size_t bands) {
        emitters_ = &emitters;
        bands_ = bands;
        geometry_terms_.assign(samples * emitters.size(), 0.0);
        transmittances_.assign(samples * (1 + emitters.size()) * bands, 0.0);
        visibilities_.assign(samples * emitters.size(), 0.0);
    }

    const std::vector<Lamp>& emitters() const { return *emitters_; }
    std::size_t emitter_count() const { return emitters_->size(); }
    /// Whether the emitter shines on the sample.
    bool visible(std::size_t sample, std::size_t emitter) const {
        return geometry_term(sample, emitter) > 0;
    }
    /// The fraction of the emitter that is visible from the sample: 0 or 1, or between them for a
    /// part of a lamp (find_half_shades).
    double visibility(std::size_t sample, std::size_t emitter) const {
        return visibilities_[sample * emitter_count() + emitter];
    }
    /// Irradiance in the absence of water [W/m^2].
    double clean(std::size_t sample, std::size_t emitter, std::size_t band) const {
        return (*emitters_)[emitter].axis_intensity()[band] * geometry_term(sample, emitter);
    }
    /// Irradiance [W/m^2].
    double irradiance(std::size_t sample, std::size_t emitter, std::size_t band) const {
        return clean(sample, emitter, band) * from_emitter(sample, emitter)[band];
    }
    /// e^-tau per band from the sample to its ray's origin.
    std::span<const double> to_camera(std::size_t sample) const { return row(sample, 0); }

    // For SurfaceLighting, which fills in the values:

    /// Irradiance without water for 1 W/sr on the emitter's axis [1/m^2]: relative intensity times
    /// cosine over squared distance, times the visibility; 0 where it is occluded or behind the
    /// surface.
    double& geometry_term(std::size_t sample, std::size_t emitter) {
        return geometry_terms_[sample * emitter_count() + emitter];
    }
    double geometry_term(std::size_t sample, std::size_t emitter) const {
        return geometry_terms_[sample * emitter_count() + emitter];
    }
    std::span<double> to_camera(std::size_t sample) { return row(sample, 0); }
    /// e^-tau per band from the emitter to the sample; undefined where it is not visible.
    std::span<double> from_emitter(std::size_t sample, std::size_t emitter) {
        return row(sample, 1 + emitter);
    }
    std::span<const double> from_emitter(std::size_t sample, std::size_t emitter) const {
        return row(sample, 1 + emitter);
    }
    /// All visibilities: [sample * emitter_count() + emitter].
    std::span<double> visibilities() { return visibilities_; }
    double& visibility(std::size_t sample, std::size_t emitter) {
        return visibilities_[sample * emitter_count() + emitter];
    }
    /// All transmittances, for processing in bulk.
    std::span<double> transmittances() { return transmittances_; }

  private:
    std::size_t place(std::size_t sample, std::size_t path) const {
        return (sample * (1 + emitter_count()) + path) * bands_;
    }
    std::span<double> row(std::size_t sample, std::size_t path) {
        return std::span(transmittances_).subspan(place(sample, path), bands_);
    }
    std::span<const double> row(std::size_t sample, std::size_t path) const {
        return std::span(transmittances_).subspan(place(sample, path), bands_);
    }

    const std::vector<Lamp>* emitters_ = nullptr;
    std::size_t bands_ = 0;
    std::vector<double> geometry_terms_;  // [sample][emitter]
    std::vector<double> visibilities_;    // likewise
    std::vector<double> transmittances_;  // [sample][to the camera, then from each emitter][band]
};

/// The origin of the shadow ray from an emitter to a surface sample: the emitter's position or, if
/// it represents a part of a lamp, a point of that part, another one for each `number` and each
/// sample. The samples of a pixel stratify the part, so that penumbrae have no steps and little
/// noise.
Point3 shadow_origin(const Lamp& emitter, const SurfaceSample& sample, std::size_t number);

/// Finds the visibility of those emitters that represent parts of lamps from each sample, [sample *
/// emitters + emitter]; leaves that of the others as it is. One shadow ray decides, except in
/// pixels whose samples disagree about a lamp (a penumbra): there k_half_shade_rays are traced to
/// each part.
void find_half_shades(const LitScene& scene, std::span<const SurfaceSample* const> samples,
                      std::span<double> visibilities);

/// Evaluates the BRDF per band [1/sr] at `sample` for the light of an emitter. For emitters that
/// represent parts of a lamp it is widened by their patch, so that their highlights join to that of
/// the lamp.
void brdf_for(const Lamp& emitter, const SurfaceReflection& reflection, const SurfaceSample& sample,
              Spectrum& values);

/// How columns of neighbouring surface samples are interpolated instead of integrated one by one.
struct ColumnMixing {
    const std::vector<std::shared_ptr<const DeepShadow>>* deep_shadows = nullptr;  // by emitter
    /// Largest permitted error in a path's transmittance (0..1), measured between the interpolated
    /// and the exact column halfway between the surrounding samples; 0 integrates every column.
    double tolerance = 0;
};

/// Column concentrations between the surfaces of a tile and the camera or a lamp. They are exact at
/// every fourth sample across and down (a node). Between four nodes they are interpolated if the
/// sample at the centre confirms the interpolation; otherwise all are exact. Towards a lamp, the
/// error of its deep shadow map is interpolated, since the map already captures the shape; towards
/// the camera, the columns themselves, corrected to first order for differences in distance with
/// the concentration at the surface. Reused between tiles.
class SurfaceColumns {
  public:
    /// All arguments must stay valid until the next call. The samples' image positions lie in one
    /// tile.
    void begin(const LitScene& scene, const AttenuationTable& attenuation,
               const ColumnMixing& mixing, std::span<const SurfaceSample* const> samples);

    /// Selects the other end of the paths.
    void take_camera() { take(k_camera); }
    void take_emitter(std::size_t emitter) { take(static_cast<int>(emitter)); }

    /// Column concentrations of a sample's path, one per constituent [unit m].
    void column(std::size_t sample, std::span<double> column);

  private:
    static constexpr int k_camera = -1;
    static constexpr int k_spacing = 4;  // of nodes [pixels]
    static constexpr std::size_t k_none = static_cast<std::size_t>(-1);

    struct Node {
        std::size_t sample = k_none;
        bool known = false;  // for the current path
    };
    struct Cell {
        std::size_t middle = k_none;  // sample
        enum class State : char { unknown, confirmed, refused } state = State::unknown;
    };

    void place_nodes();
    void take(int path);
    // The origin of the light of the path's emitter that reaches `x`.
    Point3 origin_of(const Point3& x) const;
    void integrate(std::size_t sample, std::span<double> column) const;
    const double* node_column(std::size_t node);
    std::size_t cell_of(const SurfaceSample& sample) const;
    bool confirmed(std::size_t cell);
    // False if the surrounding nodes see something else.
    bool mix(std::size_t sample, std::size_t cell, std::span<double> column);

    const LitScene* scene_ = nullptr;
    const AttenuationTable* attenuation_ = nullptr;
    ColumnMixing mixing_;
    std::span<const SurfaceSample* const> samples_;
    std::size_t constituents_ = 0;
    double voxel_ = 0;
    int path_ = k_camera;

    bool mixed_ = false;
    int x0_ = 0, y0_ = 0, x1_ = 0, y1_ = 0;  // first and last pixels of the tile
    Grid2D<Node> nodes_;
    Grid2D<Cell> cells_;                // indexed by their first node
    std::vector<double> node_columns_;  // exact; for an emitter, minus those of its deep shadow map
    std::vector<double> field_columns_;  // from the deep shadow map, for all samples
    std::vector<Point3> positions_;
    std::vector<double> mixture_, exact_;
};

/// Computes the light of every lamp incident on surfaces and its attenuation by the water (physics
/// section 5, `direct`). Thread safe.
class SurfaceLighting {
  public:
    virtual ~SurfaceLighting() = default;

    /// Light on each of `samples`; faster for batches of neighbouring samples.
    virtual void evaluate(std::span<const SurfaceSample* const> samples,
                          SurfaceLight& light) const = 0;
    /// Light on a single sample.
    void evaluate_one(const SurfaceSample& sample, SurfaceLight& light) const {
        const SurfaceSample* const one = &sample;
        evaluate(std::span(&one, 1), light);
    }
};

/// Direct light at surfaces: traces one exact shadow ray to each emitter that a surface faces, more
/// in penumbrae (find_half_shades). Columns are exact, too, or interpolated between neighbours
/// (SurfaceColumns). The deep shadow maps' columns alone would not suffice: each surface point
/// depends on a single column, so that its interpolation error would be visible.
class DirectLighting final : public SurfaceLighting {
  public:
    /// With exact columns.
    explicit DirectLighting(const LitScene& scene) : DirectLighting(scene, {}, 0) {}
    /// With columns interpolated to within `column_tolerance` (ColumnMixing). `deep_shadows`: one
    /// per emitter unless the tolerance is 0.
    DirectLighting(const LitScene& scene,
                   std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                   double column_tolerance);

    void evaluate(std::span<const SurfaceSample* const> samples,
                  SurfaceLight& light) const override;

  private:
    LitScene scene_;
    AttenuationTable attenuation_;
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows_;
    double column_tolerance_;
};

}  // namespace uw
