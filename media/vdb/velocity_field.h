#pragma once

#include <openvdb/openvdb.h>

#include <vector>

#include "core/base/affine.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// The velocities of a file's grids in the file's own axes [m/s], zero outside of them.
class VelocityField {
  public:
    /// Reads the grids that `motion` names: one of vectors, staggered or not, or three of numbers.
    /// Without a scale, Blender's fluid caches have 2.5 voxels a second per unit, others m/s.
    /// Throws InputError starting with `motion.where`.
    VelocityField(const MotionDesc& motion, Centering centering);

    /// Reads from a thread of its own; holds caches.
    class Sampler {
      public:
        explicit Sampler(const VelocityField& field);
        openvdb::Vec3d operator()(const openvdb::Vec3d& x) const;

      private:
        const VelocityField& field_;
        std::vector<openvdb::Vec3SGrid::ConstAccessor> vectors_;
        std::vector<openvdb::FloatGrid::ConstAccessor> numbers_;
    };

    /// The largest |component| of linear * v over all v [of linear's unit a second].
    openvdb::Vec3d largest(const Matrix3& linear) const;

  private:
    double shift_ = 0;  // of a value's place from its index
    double scale_ = 1;
    bool staggered_ = false;
    openvdb::Vec3SGrid::Ptr vectors_;               // either this
    std::vector<openvdb::FloatGrid::Ptr> numbers_;  // or these three
};

}  // namespace uw
