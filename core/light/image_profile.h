#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/grid2d.h"
#include "core/light/profile_geometry.h"
#include "core/scene/lamp_desc.h"

namespace uw {

/// The profile of a projector (IsALampProfile): its radiant intensity is that of the pattern where
/// the direction meets the image of a pinhole camera at the lamp, its x axis along
/// LampPlacement::across turned by `rotate` and y down; interpolated between the pixels' centres,
/// 0 beyond the image's edges.
class ImageProfile {
  public:
    static constexpr std::string_view k_name = "image";

    /// `pattern`: of values 0..1, the greatest 1.
    ImageProfile(const ImageProfileDesc& desc, const LampPlacement& placement,
                 std::shared_ptr<const Grid2D<float>> pattern);

    double relative_intensity(const Vector3& v) const;
    double solid_angle() const;
    std::optional<double> peak_candelas() const { return std::nullopt; }
    bool has_even_core() const { return false; }
    DirectionCone cone() const;
    /// Where the light departs from a straight line through the last breaks by 2 % of the greatest.
    void append_breaks(const Ray& ray, const Interval& interval, const Point3& apex,
                       std::vector<double>& s) const;

    FineStructure fine_structure() const { return {true, std::nullopt}; }

    friend bool operator==(const ImageProfile& a, const ImageProfile& b);

  private:
    /// At a place in the image [pixels]: pixel (i, j) has its centre at (i + 1/2, j + 1/2).
    double at(double x, double y) const;

    std::shared_ptr<const Grid2D<float>> pattern_;
    Vector3 axis_, right_, down_;  // unit, perpendicular to each other
    double focal_length_;          // [pixels]
};

/// Reads the file: a picture's colours as sRGB has them, or linear values; of colours the
/// luminance. Throws InputError for a file that is no image or is black, IoError for one that
/// cannot be read.
ImageProfile make_profile(const ImageProfileDesc& desc, const LampPlacement& placement,
                          std::vector<std::string>& warnings);

}  // namespace uw
