#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/forward/forward_images.h"
#include "core/forward/in_scatter_slabs.h"
#include "core/forward/visible_water.h"
#include "core/frame/pixel_renderer.h"

namespace uw {

/// One slab of water as images over a grid.
struct SlabImages {
    std::vector<std::vector<ImagePlane>> light;  // [group of lamps][band]: E_s
    std::vector<ImagePlane> weight;              // per band [m]: light at the camera per E_s
    PathImage from_lamps, to_camera;

    SlabImages() = default;
    SlabImages(int width, int height, std::size_t groups, std::size_t bands,
               std::size_t constituents);

    /// Calls `change` with each plane of `from` and its own.
    template <class Change>
    void fill_from(const SlabImages& from, const Change& change) {
        for (std::size_t g = 0; g < light.size(); ++g)
            for (std::size_t b = 0; b < weight.size(); ++b) change(from.light[g][b], light[g][b]);
        for (std::size_t b = 0; b < weight.size(); ++b) change(from.weight[b], weight[b]);
        from_lamps.fill_from(from.from_lamps, change);
        to_camera.fill_from(from.to_camera, change);
    }
};

/// The in-scatter of slabs of water at the nodes of a lattice over the image, at the centres of
/// equal parts of it: each has a ray through its centre or, if another pixel of its part sees
/// farther, through that pixel. What is hidden from a node's ray continues what its neighbours see.
class SlabLattice {
  public:
    /// Lamps of the same group are taken together. All references must outlive the lattice.
    SlabLattice(const PixelRenderer& renderer, const InScatterSlabs& slabs,
                const VisibleWater& water, std::vector<std::vector<std::size_t>> groups,
                const SensorModel& sensor, double spacing);

    int columns() const { return rays_.width(); }
    int rows() const { return rays_.height(); }
    SlabImages images() const;

    /// Integrates slabs `first` to first + slabs.size() - 1, which are images().
    void integrate(std::size_t first, std::vector<SlabImages>& slabs) const;
    /// Interpolates a plane of the lattice at the nodes of `grid`.
    void interpolate(const ImagePlane& plane, const SplineGrid& grid, ImagePlane& nodes) const;

  private:
    struct NodeRay {
        std::optional<Ray> ray;
        double end = 0;  // of the water along it [m]
        double factor = 1;
    };

    NodeRay find_ray(int i, int j) const;
    void store(const SlabLight& light, const NodeRay& ray, std::size_t node,
               SlabImages& slab) const;
    // Continues what is visible into what is not.
    static void fill_hidden(Grid2D<char>& visible, SlabImages& slab);

    const PixelRenderer& renderer_;
    const InScatterSlabs& slabs_;
    const VisibleWater& water_;
    std::vector<std::vector<std::size_t>> groups_;
    SensorModel sensor_;
    Grid2D<NodeRay> rays_;
};

}  // namespace uw
