#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/passes/forward_images.h"
#include "core/passes/pixel_renderer.h"

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

/// Forward scatter of light that the water scatters to the camera, slab by slab:
///
///     (17)  E_s = E_s' + E_s' * g(R_lamps)
///     (18)  L_b = sum_i L_i + L_i * g(R_i)
///
/// A slab's light is known at the nodes of a lattice; there it is blurred, on a grid as fine as the
/// kernels need it where surfaces cut into the slab, and as fine as the lattice elsewhere. Only how
/// much of a slab each pixel sees is taken pixel by pixel.
class WaterScatter {
  public:
    /// `lattice`: of `slabs`, with `spacing`. All references must outlive this object; desc.K > 0.
    WaterScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane, const Medium& medium,
                 const InScatterSlabs& slabs, const VisibleWater& water, const SlabLattice& lattice,
                 double spacing);
    ~WaterScatter();
    WaterScatter(const WaterScatter&) = delete;
    WaterScatter& operator=(const WaterScatter&) = delete;

    /// Scatters slab `index`, of which `images` is the lattice's; slabs come in ascending order.
    /// What they add goes into `sums`, one plane for each band of each group, by the time of
    /// `finish`.
    void add(std::size_t index, const SlabImages& images, std::vector<ImagePlane>& sums);
    void finish();

  private:
    struct Level;

    double spacing_for(std::size_t index, const SlabImages& images) const;
    void prepare(std::size_t index, const SlabImages& images, std::vector<ImagePlane>& sums);
    // How much of the slab is seen about each node.
    void cover(std::size_t index);
    void scatter(std::size_t group, std::size_t band);
    // What (17) adds in pixels whose water ends in the slab, and in those that see beyond it.
    void gather_ends(std::size_t index) const;
    void gather_beyond(const ImagePlane& before, ImagePlane& sum) const;

    ForwardScatterDesc desc_;
    ScatterPlane plane_;
    const Medium& medium_;
    const InScatterSlabs& slabs_;
    const VisibleWater& water_;
    const SlabLattice& lattice_;
    double spacing_;
    VisibleWater::Extent extent_;
    std::unique_ptr<Level> level_;  // of the slab added last
    std::vector<ImagePlane>* sums_ = nullptr;
    std::size_t next_ = 0;  // slab
    bool cut_ = false;      // whether some pixel does not see all of the current slab
    ImagePlane pixels_;
};

}  // namespace uw
