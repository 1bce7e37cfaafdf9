#include "core/light/image_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/geometry/texture.h"
#include "core/image/image_file.h"

namespace uw {
namespace {

double interpolate(const Grid2D<float>& pattern, double x, double y) {
    const double u = std::clamp(x - 0.5, 0.0, pattern.width() - 1.0);
    const double v = std::clamp(y - 0.5, 0.0, pattern.height() - 1.0);
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const int next_i = std::min(i + 1, pattern.width() - 1);
    const int next_j = std::min(j + 1, pattern.height() - 1);
    const auto value = [&](int column, int row) { return double{pattern(column, row)}; };
    return std::lerp(std::lerp(value(i, j), value(next_i, j), u - i),
                     std::lerp(value(i, next_j), value(next_i, next_j), u - i), v - j);
}

std::shared_ptr<const Grid2D<float>> read_pattern(const ImageProfileDesc& desc,
                                                  std::vector<std::string>& warnings) {
    const PixelImage image = read_image(desc.file);
    auto pattern = std::make_shared<Grid2D<float>>(image.width, image.height, 0.0F);
    const auto channels = static_cast<std::size_t>(image.channels);
    bool is_coloured = false;
    float greatest = 0;
    for (std::size_t n = 0; n < pattern->size(); ++n) {
        const auto value = [&](std::size_t channel) {
            const double stored = double{image.pixels[n * channels + channel]};
            return image.is_linear ? stored : linear_from_srgb(stored);
        };
        double light = value(0);
        if (channels >= 3) {
            is_coloured = is_coloured || value(1) != light || value(2) != light;
            light = 0.2126 * light + 0.7152 * value(1) + 0.0722 * value(2);  // of sRGB
        }
        if (!(light >= 0) || !std::isfinite(light))
            throw InputError(desc.where +
                             ".file: has negative or infinite values; light "
                             "is 0 or more");
        (*pattern)[n] = static_cast<float>(light);
        greatest = std::max(greatest, (*pattern)[n]);
    }
    if (!(greatest > 0)) throw InputError(desc.where + ".file: is black, so that the lamp is dark");
    if (is_coloured)
        warnings.push_back(desc.where +
                           ".file: has colours, of which only the luminance counts; give the "
                           "lamp's colour by its spectrum or intensity");
    for (float& light : pattern->values()) light /= greatest;
    return pattern;
}

}  // namespace

ImageProfile::ImageProfile(const ImageProfileDesc& desc, const LampPlacement& placement,
                           std::shared_ptr<const Grid2D<float>> pattern)
    : pattern_(std::move(pattern)),
      axis_(placement.axis()),
      right_(placement.across_in_world(desc.rotate)),
      down_(glm::cross(axis_, right_)),
      focal_length_(0.5 * pattern_->width() / std::tan(glm::radians(0.5 * desc.fov))) {}

double ImageProfile::at(double x, double y) const {
    if (!(x >= 0 && x <= pattern_->width() && y >= 0 && y <= pattern_->height())) return 0;
    return interpolate(*pattern_, x, y);
}

double ImageProfile::relative_intensity(const Vector3& v) const {
    const double ahead = glm::dot(v, axis_);
    if (!(ahead > 0)) return 0;
    const double scale = focal_length_ / ahead;
    return at(0.5 * pattern_->width() + scale * glm::dot(v, right_),
              0.5 * pattern_->height() + scale * glm::dot(v, down_));
}

// By the midpoint rule between the lines through the pixels' centres, where the pattern is bilinear
// and the solid angle of an area of the image, f / (f^2 + x^2 + y^2)^(3/2), nearly constant.
double ImageProfile::solid_angle() const {
    const auto steps_for = [](int pixels) {
        constexpr int k_min_steps = 512;
        const int halves = 2 * pixels;
        return halves * std::max(1, (k_min_steps + halves - 1) / halves);
    };
    const double width = pattern_->width(), height = pattern_->height();
    const int columns = steps_for(pattern_->width()), rows = steps_for(pattern_->height());
    double sum = 0;
    for (int j = 0; j < rows; ++j) {
        const double y = (j + 0.5) / rows * height, off_y = y - 0.5 * height;
        double row = 0;
        for (int i = 0; i < columns; ++i) {
            const double x = (i + 0.5) / columns * width, off_x = x - 0.5 * width;
            const double squares = focal_length_ * focal_length_ + off_x * off_x + off_y * off_y;
            row += at(x, y) / (squares * std::sqrt(squares));
        }
        sum += row;
    }
    return sum * focal_length_ * (width / columns) * (height / rows);
}

DirectionCone ImageProfile::cone() const {
    const double x = 0.5 * pattern_->width(), y = 0.5 * pattern_->height();
    return {axis_, focal_length_ / std::sqrt(focal_length_ * focal_length_ + x * x + y * y)};
}

void ImageProfile::append_breaks(const Ray& ray, const Interval& interval, const Point3& apex,
                                 std::vector<double>& s) const {
    // In homogeneous coordinates of the image the ray is a line: from + t * by.
    const auto in_image = [&](const Vector3& v) {
        const double ahead = glm::dot(v, axis_);
        return Vector3(0.5 * pattern_->width() * ahead + focal_length_ * glm::dot(v, right_),
                       0.5 * pattern_->height() * ahead + focal_length_ * glm::dot(v, down_),
                       ahead);
    };
    const Vector3 from = in_image(ray.origin - apex), by = in_image(ray.direction);
    Interval within = interval;
    // The part of it where a + t b >= 0.
    const auto clip = [&](double a, double b) {
        if (b > 0)
            within.begin = std::max(within.begin, -a / b);
        else if (b < 0)
            within.end = std::min(within.end, -a / b);
        else if (a < 0)
            within.end = within.begin;
    };
    const std::array<int, 2> size{pattern_->width(), pattern_->height()};
    clip(from.z, by.z);
    for (int axis = 0; axis < 2; ++axis) {
        clip(from[axis], by[axis]);
        clip(size[static_cast<std::size_t>(axis)] * from.z - from[axis],
             size[static_cast<std::size_t>(axis)] * by.z - by[axis]);
    }
    if (!(within.length() > 0) || !std::isfinite(within.end)) return;
    const auto place = [&](double t) {
        const Vector3 x = from + t * by;
        return x.z > 0 ? Vector3(x.x / x.z, x.y / x.z, 0) : Vector3(0);
    };
    s.push_back(within.begin);
    s.push_back(within.end);
    // Where it crosses the lines through the pixels' centres, between which the pattern is
    // bilinear.
    std::vector<double> knots{within.begin, within.end};
    const double inside = 1e-9 * within.length();
    const Vector3 begin = place(within.begin + inside), end = place(within.end - inside);
    for (int axis = 0; axis < 2; ++axis) {
        const auto [low, high] = std::minmax(begin[axis], end[axis]);
        for (double line = std::ceil(low - 0.5) + 0.5; line < high; ++line) {
            const double t = (line * from.z - from[axis]) / (by[axis] - line * by.z);
            if (t > within.begin && t < within.end) knots.push_back(t);
        }
    }
    std::sort(knots.begin(), knots.end());
    // Between these the light is a parabola, which may rise from zero and fall to it.
    for (std::size_t i = knots.size() - 1; i > 0; --i)
        knots.push_back(0.5 * (knots[i - 1] + knots[i]));
    std::sort(knots.begin(), knots.end());
    constexpr double k_tolerance = 0.02;
    // The slope from the last break on; along the image's line light is linear as long as that
    // holds.
    struct Knot {
        double t, path, value;
    };
    const auto knot_at = [&](double t) {
        const Vector3 at_t = place(t);
        return Knot{
            t, glm::length(at_t - begin),
            at(std::clamp(at_t.x, 0.0, double(size[0])), std::clamp(at_t.y, 0.0, double(size[1])))};
    };
    Knot last = knot_at(knots[0]), before = last;
    double slope = 0;
    bool has_slope = false;
    for (std::size_t i = 1; i < knots.size(); ++i) {
        const Knot knot = knot_at(knots[i]);
        if (has_slope &&
            std::abs(knot.value - last.value - slope * (knot.path - last.path)) > k_tolerance) {
            s.push_back(before.t);
            last = before;
            has_slope = false;
        }
        if (!has_slope && knot.path > last.path) {
            slope = (knot.value - last.value) / (knot.path - last.path);
            has_slope = true;
        }
        before = knot;
    }
}

bool operator==(const ImageProfile& a, const ImageProfile& b) {
    return a.axis_ == b.axis_ && a.right_ == b.right_ && a.focal_length_ == b.focal_length_ &&
           std::ranges::equal(a.pattern_->values(), b.pattern_->values()) &&
           a.pattern_->width() == b.pattern_->width();
}

ImageProfile make_profile(const ImageProfileDesc& desc, const LampPlacement& placement,
                          std::vector<std::string>& warnings) {
    return {desc, placement, read_pattern(desc, warnings)};
}

}  // namespace uw
