#pragma once

#include <openvdb/openvdb.h>

#include <vector>

#include "core/base/vector_math.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// The velocities of a file's grids in the file's own axes [m/s], zero outside the grids.
class VelocityField {
  public:
    /// Reads the grids that `motion` names: one vector grid, staggered or not, or three scalar
    /// grids. Without a scale, the unit is 2.5 voxels per second for Blender's fluid caches, else
    /// m/s. Throws InputError starting with `motion.where`.
    VelocityField(const MotionDesc& motion, Centering centering);

    /// Samples the field; one per thread, since it contains caches.
    class Sampler {
      public:
        explicit Sampler(const VelocityField& field);
        openvdb::Vec3d operator()(const openvdb::Vec3d& x) const;
        /// The derivatives of the velocity, column a along axis a [1/s]: between the neighbouring
        /// voxels of its grid, on one side only at the ends of the grid's active box, and 0 outside
        /// of it.
        Matrix3 gradient(const openvdb::Vec3d& x) const;

      private:
        const VelocityField& field_;
        std::vector<openvdb::Vec3SGrid::ConstAccessor> vectors_;
        std::vector<openvdb::FloatGrid::ConstAccessor> numbers_;
    };

    /// The largest |component| of linear * v over all v [linear's unit per second].
    openvdb::Vec3d largest(const Matrix3& linear) const;

  private:
    const openvdb::GridBase& first_grid() const;

    double shift_ = 0;  // from a value's index to its position
    double scale_ = 1;
    bool staggered_ = false;
    openvdb::CoordBBox box_;                        // of all active voxels
    openvdb::Vec3SGrid::Ptr vectors_;               // either this
    std::vector<openvdb::FloatGrid::Ptr> numbers_;  // or these three
};

}  // namespace uw
