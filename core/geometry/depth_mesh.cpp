#include "core/geometry/depth_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>
#include <unordered_map>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace uw {

namespace {

/// A step of more than this many edges from one pixel to the next is none of a surface, even where
/// the next is as large: in the pixels of mixed depth that sensors place between near and far.
constexpr double k_steepest_step = 4;

/// How far vertices stand off the pixels' centres [pixels]: rays through the centres themselves, as
/// ground truth has, would all meet vertices, and now and then slip through between the triangles.
constexpr double k_off_x = 1.0 / 64, k_off_y = 1.0 / 128;

struct DepthPixel {
    int x = 0, y = 0;
};

/// The four neighbours: right, down, left, up.
constexpr std::array<DepthPixel, 4> k_neighbour_steps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

DepthPixel neighbour_of(const DepthPixel& p, int direction) {
    const DepthPixel& step = k_neighbour_steps[static_cast<std::size_t>(direction & 3)];
    return {p.x + step.x, p.y + step.y};
}

class MeshBuilder {
  public:
    MeshBuilder(const Grid2D<double>& inverse_depth,
                const std::function<std::optional<Vector3>(double x, double y)>& ray,
                const DepthMeshOptions& options)
        : depth_(inverse_depth), ray_(ray), options_(options) {}

    DepthMesh build() {
        constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();
        centres_.assign(depth_.width(), depth_.height(), k_none);
        rays_.assign(depth_.width(), depth_.height(), Vector3(0.0));
        parallel_for(static_cast<std::size_t>(depth_.height()), [&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < depth_.width(); ++x)
                if (depth_(x, y) > 0) rays_(x, y) = ray_(x + 0.5, y + 0.5).value();
        });
        find_normals();
        for (int y = 0; y < depth_.height(); ++y)
            for (int x = 0; x < depth_.width(); ++x)
                if (depth_(x, y) > 0) centres_(x, y) = add_centre({x, y});
        for (int y = -1; y < depth_.height(); ++y) {
            throw_if_stopped();
            for (int x = -1; x < depth_.width(); ++x) add_cell({x, y});
        }
        count_edges();
        return std::move(mesh_);
    }

  private:
    bool has_depth(const DepthPixel& p) const {
        return p.x >= 0 && p.y >= 0 && p.x < depth_.width() && p.y < depth_.height() &&
               depth_(p.x, p.y) > 0;
    }
    double at(const DepthPixel& p) const { return depth_(p.x, p.y); }

    static double jump(double a, double b) { return std::max(a, b) / std::min(a, b) - 1; }

    /// Whether the plane through `a` and the pixel before it, seen from `b`, leads to `b`.
    bool leads_on(const DepthPixel& a, const DepthPixel& b) const {
        const DepthPixel before{2 * a.x - b.x, 2 * a.y - b.y};
        if (!has_depth(before)) return false;
        const double expected = 2 * at(a) - at(before);
        return expected > 0 && jump(expected, at(b)) <= options_.edge;
    }

    /// Whether two neighbouring pixels show one surface.
    bool connected(const DepthPixel& a, const DepthPixel& b) const {
        if (!has_depth(a) || !has_depth(b)) return false;
        const double step = jump(at(a), at(b));
        if (step <= options_.edge) return true;
        return step <= k_steepest_step * options_.edge && (leads_on(a, b) || leads_on(b, a));
    }

    /// The change of 1/z per pixel from `p` on in a direction in which nothing follows.
    double slope(const DepthPixel& p, int direction) const {
        const DepthPixel before = neighbour_of(p, direction + 2);
        return connected(before, p) ? at(p) - at(before) : 0;
    }

    std::uint32_t add_vertex(const DepthPixel& owner, double x, double y, double inverse_depth) {
        // Where a lens ends within the pixel, only its centre has a ray.
        const Vector3 ray = ray_(x, y).value_or(rays_(owner.x, owner.y));
        const auto number = static_cast<std::uint32_t>(mesh_.positions.size() / 3);
        for (int axis = 0; axis < 3; ++axis)
            mesh_.positions.push_back(static_cast<float>(ray[axis] / inverse_depth));
        if (!normals_.empty()) {
            const Vector3& normal = normals_(owner.x, owner.y);
            for (int axis = 0; axis < 3; ++axis)
                mesh_.normals.push_back(static_cast<float>(normal[axis]));
        }
        mesh_.uvs.push_back(static_cast<float>(x / depth_.width()));
        mesh_.uvs.push_back(static_cast<float>(y / depth_.height()));
        return number;
    }

    /// 1/z of the surface beside the centre of a pixel, `off` pixels in a direction.
    double step_from(const DepthPixel& p, int direction, double off) const {
        const DepthPixel next = neighbour_of(p, direction);
        return off * (connected(p, next) ? at(next) - at(p) : slope(p, direction));
    }

    std::uint32_t add_centre(const DepthPixel& p) {
        return add_vertex(p, p.x + 0.5 + k_off_x, p.y + 0.5 + k_off_y,
                          at(p) + step_from(p, 0, k_off_x) + step_from(p, 1, k_off_y));
    }

    /// Where the square of a pixel ends in a direction in which its surface does, half a pixel from
    /// its centre; the cells on both sides share it.
    std::uint32_t border(const DepthPixel& p, int direction) {
        const std::uint64_t key = depth_.index(p.x, p.y) * 4 + static_cast<unsigned>(direction & 3);
        const auto [found, is_new] = borders_.try_emplace(key);
        if (is_new) {
            const DepthPixel& step = k_neighbour_steps[static_cast<std::size_t>(direction & 3)];
            found->second = add_vertex(p, p.x + 0.5 + 0.5 * step.x, p.y + 0.5 + 0.5 * step.y,
                                       kept_near(at(p) + 0.5 * slope(p, direction), at(p)));
        }
        return found->second;
    }

    static double kept_near(double value, double around) {
        return std::clamp(value, 0.5 * around, 2 * around);
    }

    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        // The corners come clockwise.
        mesh_.triangles.insert(mesh_.triangles.end(), {a, c, b});
    }
    void add_fan(std::span<const std::uint32_t> corners) {
        for (std::size_t i = 2; i < corners.size(); ++i)
            add_triangle(corners[0], corners[i - 1], corners[i]);
    }

    /// Adds what lies between the centres of four pixels, of which `first` is the top left one.
    void add_cell(const DepthPixel& first) {
        const std::array<DepthPixel, 4> pixels{
            {first, {first.x + 1, first.y}, {first.x + 1, first.y + 1}, {first.x, first.y + 1}}};
        std::array<bool, 4> joined;  // pixel i with pixel i + 1, around the cell
        int joints = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            joined[i] = connected(pixels[i], pixels[(i + 1) % 4]);
            joints += joined[i] ? 1 : 0;
        }
        if (joints >= 3) return add_whole(pixels);
        for (std::size_t i = 0; i < 4; ++i) {
            // The runs of joined pixels, each from its first on.
            if (!has_depth(pixels[i]) || joined[(i + 3) % 4]) continue;
            std::size_t last = i;
            while (joined[last % 4]) ++last;
            add_run(first, pixels, static_cast<int>(i), static_cast<int>(last));
        }
    }

    void add_whole(const std::array<DepthPixel, 4>& pixels) {
        std::array<std::uint32_t, 4> corners;
        for (std::size_t i = 0; i < 4; ++i) corners[i] = centres_(pixels[i].x, pixels[i].y);
        // Along the diagonal on which depths differ less.
        if (jump(at(pixels[0]), at(pixels[2])) > jump(at(pixels[1]), at(pixels[3])))
            std::rotate(corners.begin(), corners.begin() + 1, corners.end());
        add_fan(corners);
    }

    /// Adds the quarters of a cell that belong to the pixels `begin` to `end`, around it.
    void add_run(const DepthPixel& first, const std::array<DepthPixel, 4>& pixels, int begin,
                 int end) {
        const auto pixel = [&](int i) { return pixels[static_cast<std::size_t>(i & 3)]; };
        const auto centre = [&](int i) { return centres_(pixel(i).x, pixel(i).y); };
        // DepthPixel i is followed by i + 1 in direction i, and preceded by i - 1 in direction i
        // + 1.
        const std::uint32_t to_next = border(pixel(end), end);
        const std::uint32_t to_previous = border(pixel(begin), begin + 1);
        if (end == begin + 1) {
            add_fan(std::array{centre(begin), centre(end), to_next, to_previous});
            return;
        }
        const DepthPixel apex = pixel((begin + end) / 2);
        const double inverse_depth =
            begin == end ? at(apex) + 0.5 * (slope(apex, begin) + slope(apex, begin + 1))
                         : 0.5 * (at(pixel(begin)) + at(pixel(end)));
        const std::uint32_t corner =
            add_vertex(apex, first.x + 1.0, first.y + 1.0, kept_near(inverse_depth, at(apex)));
        if (begin == end)
            add_fan(std::array{centre(begin), to_next, corner, to_previous});
        else
            add_fan(std::array{centre(begin + 1), centre(end), to_next, corner, to_previous,
                               centre(begin)});
    }

    void find_normals() {
        const int radius = options_.normal_radius;
        if (radius == 0) return;
        normals_.assign(depth_.width(), depth_.height(), Vector3(0.0));
        parallel_for(static_cast<std::size_t>(depth_.height()), [&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < depth_.width(); ++x)
                if (depth_(x, y) > 0) normals_(x, y) = normal_at({x, y});
        });
    }

    /// The normal of the plane through the pixels around, by least squares. A plane is n.P = d, and
    /// P = ray z, so that 1/z = q.ray with q = n/d. With the axis o along the pixel's own ray and
    /// rays o + s, s perpendicular to it, this is q.o + q.s, linear in s.
    Vector3 normal_at(const DepthPixel& p) const {
        const int radius = options_.normal_radius;
        const Vector3 axis = glm::normalize(rays_(p.x, p.y));
        const Vector3 across = glm::normalize(
            glm::cross(axis, std::abs(axis.x) < 0.5 ? Vector3(1, 0, 0) : Vector3(0, 1, 0)));
        const Vector3 up = glm::cross(axis, across);
        double n = 0, s = 0, t = 0, w = 0, ss = 0, st = 0, tt = 0, sw = 0, tw = 0;
        for (int y = std::max(0, p.y - radius); y <= std::min(depth_.height() - 1, p.y + radius);
             ++y)
            for (int x = std::max(0, p.x - radius); x <= std::min(depth_.width() - 1, p.x + radius);
                 ++x) {
                if (!(depth_(x, y) > 0)) continue;
                const int steps = std::max({1, std::abs(x - p.x), std::abs(y - p.y)});
                if (jump(depth_(x, y), at(p)) > steps * options_.edge) continue;
                const double along = glm::dot(rays_(x, y), axis);
                const double s_here = glm::dot(rays_(x, y), across) / along;
                const double t_here = glm::dot(rays_(x, y), up) / along;
                const double w_here = depth_(x, y) / along;
                n += 1;
                s += s_here;
                t += t_here;
                w += w_here;
                ss += s_here * s_here;
                st += s_here * t_here;
                tt += t_here * t_here;
                sw += s_here * w_here;
                tw += t_here * w_here;
            }
        ss -= s * s / n;
        st -= s * t / n;
        tt -= t * t / n;
        sw -= s * w / n;
        tw -= t * w / n;
        const double determinant = ss * tt - st * st;
        // Pixels on one line, of which it is 0, have no plane.
        constexpr double k_on_a_line = 1e-6;
        if (determinant > k_on_a_line * (ss + tt) * (ss + tt)) {
            const double by_s = (tt * sw - st * tw) / determinant;
            const double by_t = (ss * tw - st * sw) / determinant;
            const double here = (w - by_s * s - by_t * t) / n;
            if (here > 0) return -glm::normalize(here * axis + by_s * across + by_t * up);
        }
        return -axis;
    }

    void count_edges() {
        for (int y = 0; y < depth_.height(); ++y)
            for (int x = 0; x < depth_.width(); ++x)
                for (int direction = 0; direction < 2; ++direction) {
                    const DepthPixel p{x, y}, next = neighbour_of(p, direction);
                    if (has_depth(p) && has_depth(next) && !connected(p, next)) ++mesh_.edges;
                }
    }

    const Grid2D<double>& depth_;
    const std::function<std::optional<Vector3>(double x, double y)>& ray_;
    const DepthMeshOptions& options_;
    DepthMesh mesh_;
    Grid2D<std::uint32_t> centres_;  // the vertex of each pixel
    Grid2D<Vector3> rays_, normals_;
    std::unordered_map<std::uint64_t, std::uint32_t> borders_;
};

}  // namespace

DepthMesh mesh_of_depth(const Grid2D<double>& inverse_depth,
                        const std::function<std::optional<Vector3>(double x, double y)>& ray,
                        const DepthMeshOptions& options) {
    return MeshBuilder(inverse_depth, ray, options).build();
}

}  // namespace uw
