#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/integrators/deep_shadow.h"
#include "core/integrators/lit_scene.h"
#include "core/integrators/surface_light.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// How columns of neighbouring surface samples are interpolated rather than integrated one by one.
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
    // Where the light of the path's emitter that reaches `x` comes from.
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

}  // namespace uw
