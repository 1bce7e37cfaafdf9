#include "render/validation/port_photographs.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "core/base/csv_table.h"
#include "core/paths/lattice_fit.h"
#include "core/scene/scene_desc.h"
#include "render/validation/published_tables.h"

namespace uw {

namespace {

struct PhotographSet {
    const char* table;
    const char* source;
    const char* name;
    const char* camera;
    double port, plain, plain_rounding, air;  // [px]
};

constexpr PhotographSet k_sets[] = {
    {"flat_port.csv", "14 photographs through a flat port", "flat port",
     "{resolution: [648, 486], intrinsics: {fx: 704.2503362080547, fy: 704.5253520972772, cx: "
     "311.07539864073345, cy: 231.63444961832204}, distortion: {model: brown-conrady, k: "
     "[-0.16466655995965362, 0.3639292712426501, 0], p: [-0.0035347701314374052, "
     "0.0017529132113182353]}, port: {type: flat, normal: [0.03187842988317765, "
     "0.007419777520423672, 0.999464212770888], distance: 0.0014159163813140608, thickness: 0.01, "
     "n_air: 1.0, n_glass: 1.49, n_water: 1.333}}",
     0.357, 2.63, 0.005, 0.389},
    {"dome_port.csv", "74 photographs through a dome", "dome",
     "{resolution: [1440, 1080], intrinsics: {fx: 2415.732657933524, fy: 2420.953074246, cx: "
     "752.7733815206981, cy: 571.8066981186872}, distortion: {model: brown-conrady, k: "
     "[-0.36315848398496675, 0.06811987606712908, 1.1730456449148083], p: "
     "[0.0009552456724762491, 0.0006011333369216497]}, port: {type: dome, center: "
     "[0.0010739276438524533, -0.0014321366132178607, -0.005296524028375461], radius: 0.043552, "
     "thickness: 0.0037499999999999964, n_air: 1.0, n_glass: 1.495, n_water: 1.333}}",
     0.228, 0.271, 0.0005, 0.244},
    {"tank.csv", "a photograph through a tank of 256 mm", "tank of water",
     "{resolution: [3456, 2304], intrinsics: {fx: 2855.7123372189926, fy: 2856.713502076052, cx: "
     "1783.0502357964347, cy: 1171.8751102388067}, port: {type: flat, normal: "
     "[-0.19836545283469129, -0.08802350151204377, 1], distance: 0.02, thickness: "
     "0.2556931817358324, n_air: 1.0, n_glass: 1.33, n_water: 1.0}}",
     0.465, 14.3, 0.05, 0},
};

/// One photograph: points in the camera's frame [m], and where they were found [px].
struct Corners {
    std::vector<Point3> points;
    std::vector<ImagePoint> found;
};

/// The differences between found and imaged positions, with the points moved by `motion`.
std::vector<ImagePoint> residuals_of(const Camera& camera, const Corners& corners,
                                     const Affine& motion) {
    std::vector<ImagePoint> residuals;
    residuals.reserve(corners.points.size());
    for (std::size_t i = 0; i < corners.points.size(); ++i) {
        const auto seen = camera.project(motion * corners.points[i]);
        if (!seen) throw std::logic_error("a corner that was photographed cannot be seen");
        residuals.push_back({corners.found[i].x - seen->x, corners.found[i].y - seen->y});
    }
    return residuals;
}

double squares_of(const std::vector<ImagePoint>& residuals) {
    double sum = 0;
    for (const ImagePoint& r : residuals) sum += r.x * r.x + r.y * r.y;
    return sum;
}

/// Turns [degrees] about the corners' centre, and shifts [m].
using Motion = std::array<double, 6>;

/// The least residuals that a rigid motion of the corners can leave.
std::vector<ImagePoint> refitted(const Camera& camera, const Corners& corners) {
    constexpr int k_max_steps = 100;
    constexpr double k_difference = 1e-6, k_converged = 1e-12;
    Vector3 middle{0};
    for (const Point3& point : corners.points) middle += from_origin(point);
    middle /= static_cast<double>(corners.points.size());
    const auto residuals_at = [&](const Motion& m) {
        const Affine turn = Affine::rotation_xyz_degrees({m[0], m[1], m[2]});
        return residuals_of(camera, corners,
                            Affine::translation(middle + Vector3{m[3], m[4], m[5]}) * turn *
                                Affine::translation(-middle));
    };
    Motion best{};
    std::vector<ImagePoint> residuals = residuals_at(best);
    double damping = 1e-3;
    CholeskyFactor factor;
    for (int step = 0; step < k_max_steps; ++step) {
        std::array<std::vector<ImagePoint>, 6> changes;
        for (std::size_t j = 0; j < changes.size(); ++j) {
            Motion beside = best;
            beside[j] += k_difference;
            changes[j] = residuals_at(beside);
            for (std::size_t i = 0; i < residuals.size(); ++i) {
                changes[j][i].x = (changes[j][i].x - residuals[i].x) / k_difference;
                changes[j][i].y = (changes[j][i].y - residuals[i].y) / k_difference;
            }
        }
        const auto product = [&](const std::vector<ImagePoint>& a,
                                 const std::vector<ImagePoint>& b) {
            double sum = 0;
            for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].x * b[i].x + a[i].y * b[i].y;
            return sum;
        };
        std::array<double, 36> normal{};
        Motion change{};
        for (std::size_t j = 0; j < 6; ++j) {
            for (std::size_t k = 0; k <= j; ++k)
                normal[6 * j + k] = product(changes[j], changes[k]);
            normal[7 * j] *= 1 + damping;
            change[j] = -product(changes[j], residuals);
        }
        if (!factor.factor(normal, 6, 1e-14)) break;
        factor.solve(change);
        Motion tried = best;
        for (std::size_t j = 0; j < 6; ++j) tried[j] += change[j];
        std::vector<ImagePoint> there = residuals_at(tried);
        const double before = squares_of(residuals), after = squares_of(there);
        damping = after < before ? damping / 5 : damping * 5;
        if (!(after < before)) continue;
        best = tried;
        residuals = std::move(there);
        if (before - after < k_converged * before) break;
    }
    return residuals;
}

}  // namespace

double rms_of(const std::vector<ImagePoint>& residuals) {
    return std::sqrt(squares_of(residuals) / static_cast<double>(residuals.size()));
}

std::vector<PortPhotographs> photographs_through_ports() {
    std::vector<PortPhotographs> all;
    for (const PhotographSet& set : k_sets) {
        SceneDesc scene =
            read_scene_text(fmt::format("uwvdb: 1\ncamera: {}\n", set.camera), "photographs.yaml");
        const Camera through_port(scene.camera);
        scene.camera.port.reset();
        const Camera plain(scene.camera);
        const CsvTable table = published_table(set.table);
        const std::vector<double> image = table.numbers("image"), x = table.numbers("x"),
                                  y = table.numbers("y"), z = table.numbers("z"),
                                  u = table.numbers("u"), v = table.numbers("v");
        std::map<double, Corners> photographs;
        for (std::size_t row = 0; row < table.row_count(); ++row) {
            Corners& corners = photographs[image[row]];
            corners.points.push_back({x[row], y[row], z[row]});
            corners.found.push_back({u[row], v[row]});
        }
        PortPhotographs& result = all.emplace_back();
        result.source = set.source;
        result.port_name = set.name;
        result.published_port = set.port;
        result.published_plain = set.plain;
        result.plain_rounding = set.plain_rounding;
        result.published_air = set.air;
        const auto append = [](std::vector<ImagePoint>& to, const std::vector<ImagePoint>& more) {
            to.insert(to.end(), more.begin(), more.end());
        };
        for (const auto& [number, corners] : photographs) {
            append(result.port, residuals_of(through_port, corners, {}));
            append(result.plain, refitted(plain, corners));
        }
    }
    return all;
}

}  // namespace uw
