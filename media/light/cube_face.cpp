#include "media/light/cube_face.h"

#include <algorithm>

namespace uw {

void split_by_face(const Ray& ray, const Point3& center, const Interval& stretch,
                   std::vector<FaceSegment>& segments) {
    segments.clear();
    const Vector3 o = ray.origin - center;
    const Vector3& d = ray.direction;
    std::array<double, 8> cuts{stretch.begin, stretch.end};  // ascending
    std::size_t count = 2;
    // The face changes where two components are equal in size.
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3;
        for (const double sign : {1.0, -1.0}) {
            const double s = -(o[a] + sign * o[b]) / (d[a] + sign * d[b]);
            if (!(s > stretch.begin && s < stretch.end)) continue;
            const auto used = cuts.begin() + static_cast<std::ptrdiff_t>(count++);
            *used = s;
            std::rotate(std::upper_bound(cuts.begin(), used, s), used, used + 1);
        }
    }
    for (std::size_t i = 0; i + 1 < count; ++i) {
        if (cuts[i + 1] <= cuts[i]) continue;
        const int face = cube_face_of(ray.at(0.5 * (cuts[i] + cuts[i + 1])) - center);
        if (!segments.empty() && segments.back().face == face)
            segments.back().stretch.end = cuts[i + 1];
        else
            segments.push_back({face, {cuts[i], cuts[i + 1]}});
    }
}

}  // namespace uw
