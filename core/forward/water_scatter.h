#pragma once

#include <memory>
#include <vector>

#include "core/forward/slab_lattice.h"

namespace uw {

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
