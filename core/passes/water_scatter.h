#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/passes/forward_images.h"
#include "core/passes/pixel_renderer.h"

namespace uw {

/// The light of one slab of water, and its paths, as images over a grid.
struct SlabImages {
    std::vector<std::vector<ImagePlane>> light;  // [group of lamps][band]: E_s
    std::vector<ImagePlane> weight;              // per band [m]: radiance at the camera per E_s
    PathImage from_lamps, to_camera;

    SlabImages() = default;
    SlabImages(int width, int height, std::size_t groups, std::size_t bands,
               std::size_t constituents);

    /// Calls `change` with each plane of `from` and the corresponding one of this slab.
    template <class Change>
    void fill_from(const SlabImages& from, const Change& change) {
        for (std::size_t g = 0; g < light.size(); ++g)
            for (std::size_t b = 0; b < weight.size(); ++b) change(from.light[g][b], light[g][b]);
        for (std::size_t b = 0; b < weight.size(); ++b) change(from.weight[b], weight[b]);
        from_lamps.fill_from(from.from_lamps, change);
        to_camera.fill_from(from.to_camera, change);
    }
};

/// Integrates in-scattering by slabs of water at the nodes of a lattice over the image, which lie
/// at the centres of equal parts of it. A node's ray passes through its centre or, if another pixel
/// of its part sees farther, through that pixel. Slabs that are hidden from a node's ray take the
/// values of its neighbours.
class SlabLattice {
  public:
    /// The light of the lamps of a group is summed. All references must outlive the lattice.
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
        double end = 0;  // distance to the end of the water along it [m]
        double factor = 1;
    };

    NodeRay find_ray(int i, int j) const;
    void store(const SlabLight& light, const NodeRay& ray, std::size_t node,
               SlabImages& slab) const;
    // Extrapolates from the nodes that see the slab to those that do not.
    static void fill_hidden(Grid2D<char>& visible, SlabImages& slab);

    const PixelRenderer& renderer_;
    const InScatterSlabs& slabs_;
    const VisibleWater& water_;
    std::vector<std::vector<std::size_t>> groups_;
    SensorModel sensor_;
    Grid2D<NodeRay> rays_;
};

/// Applies forward scatter to in-scattered light, slab by slab:
///
///     (17)  E_s = E_s' + E_s' * g(R_lamps)
///     (18)  L_b = sum_i L_i + L_i * g(R_i)
///
/// A slab's light is known at the nodes of a lattice. It is blurred on a grid as fine as the
/// lattice or, where surfaces cut into the slab, as fine as the kernels need. Only the part of a
/// slab that each pixel sees is evaluated pixel by pixel.
class WaterScatter {
  public:
    /// `lattice` is that of `slabs`, with the same `spacing`. All references must outlive this
    /// object. Precondition: desc.K > 0.
    WaterScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane, const Medium& medium,
                 const InScatterSlabs& slabs, const VisibleWater& water, const SlabLattice& lattice,
                 double spacing);
    ~WaterScatter();
    WaterScatter(const WaterScatter&) = delete;
    WaterScatter& operator=(const WaterScatter&) = delete;

    /// Scatters slab `index`, whose light at the lattice is `images`. Slabs must be added in
    /// ascending order. Their light has been added to `sums`, one plane for each band of each
    /// group, when `finish` returns.
    void add(std::size_t index, const SlabImages& images, std::vector<ImagePlane>& sums);
    void finish();

  private:
    struct Level;

    double spacing_for(std::size_t index, const SlabImages& images) const;
    void prepare(std::size_t index, const SlabImages& images, std::vector<ImagePlane>& sums);
    // Computes how much of the slab is visible around each node.
    void find_visible_fractions(std::size_t index);
    void scatter(std::size_t group, std::size_t band);
    // Add the light of (17) to pixels whose water ends in the slab, and to those that see beyond
    // it.
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
    std::unique_ptr<Level> level_;  // of the slab that was added last
    std::vector<ImagePlane>* sums_ = nullptr;
    std::size_t next_ = 0;  // index of the next slab
    bool cut_ = false;      // whether some pixel does not see all of the current slab
    ImagePlane pixels_;
};

}  // namespace uw
