#include "render/measures/irradiance_vdb.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/version.h"
#include "core/light/medium.h"
#include "media/volumes/vdb_writer.h"

namespace uw {

namespace {

constexpr int k_longest_side = 256;
// The maximum number of values in all grids together: 1 GiB here, and as much again in OpenVDB.
constexpr double k_max_values = 1 << 28;

struct Lattice {
    std::array<int, 3> size{};
    double voxel = 0;
    Point3 origin;

    std::size_t count() const {
        return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
               static_cast<std::size_t>(size[2]);
    }
    std::size_t index(int i, int j, int k) const {
        return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size[1]) +
                static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(size[0]) +
               static_cast<std::size_t>(i);
    }
    Point3 at(int i, int j, int k) const { return origin + voxel * Vector3(i, j, k); }
};

Lattice lattice_over(const AssembledScene& scene) {
    Bounds bounds = scene.field->grids().bounds();
    double voxel = scene.field->finest_voxel();
    if (bounds.empty()) {
        bounds = scene.surfaces->bounds();
        for (const Lamp& lamp : scene.emitters)
            if (!lamp.sunlight()) bounds.extend(lamp.position());
        voxel = 0;
    }
    if (bounds.empty() || bounds.diagonal() == 0)
        throw InputError(
            "--irradiance-vdb: the scene has no volume, finite geometry or second lamp "
            "that would determine where to sample; add one");
    const Vector3 extent = bounds.max - bounds.min;
    const double longest = std::max({extent.x, extent.y, extent.z});
    Lattice lattice;
    lattice.voxel = std::max(voxel, longest / k_longest_side);
    lattice.origin = bounds.min;
    const auto grids = static_cast<double>(scene.lamps.size()) * scene.water.medium.band_count();
    for (;; lattice.voxel *= 1.1) {
        for (int axis = 0; axis < 3; ++axis)
            lattice.size[static_cast<std::size_t>(axis)] =
                static_cast<int>(extent[axis] / lattice.voxel) + 1;
        if (static_cast<double>(lattice.count()) * grids <= k_max_values) return lattice;
    }
}

// The irradiance at every lattice point, [band][point].
using Irradiance = std::vector<std::vector<float>>;

// Adds the irradiance of one emitter.
void add_emitter(const AssembledScene& scene, std::size_t emitter_index, const DeepShadow& light,
                 const Lattice& lattice, const ProgressCallback& progress, Irradiance& result) {
    const Lamp& lamp = scene.emitters[emitter_index];
    const AttenuationTable attenuation(scene.water.medium);
    const auto bands = static_cast<std::size_t>(attenuation.band_count);
    result.resize(bands, std::vector<float>(lattice.count()));
    const auto slices = static_cast<std::size_t>(lattice.size[2]);
    std::atomic<std::size_t> done = emitter_index * slices;
    parallel_for(slices, [&](std::size_t slice) {
        const int k = static_cast<int>(slice);
        std::vector<double> column(static_cast<std::size_t>(scene.field->constituent_count()));
        for (int j = 0; j < lattice.size[1]; ++j) {
            for (int i = 0; i < lattice.size[0]; ++i) {
                const Point3 x = lattice.at(i, j, k);
                const Point3 origin = lamp.origin(x);
                const Vector3 v = x - origin;
                const double radius = glm::length(v);
                if (radius == 0 || scene.surfaces->occluded(origin, x)) continue;
                // The irradiance diverges in a voxel that contains the lamp: use that at its edge.
                const double r = std::max(radius, 0.5 * lattice.voxel);
                light.columns(std::span<const Point3>(&x, 1), column);
                const Spectrum t = attenuation.transmittance(radius, column);
                const double relative = lamp.relative_intensity(v) * lamp.focus(x) / lamp.spread(r);
                for (std::size_t b = 0; b < bands; ++b)
                    result[b][lattice.index(i, j, k)] +=
                        static_cast<float>(lamp.axis_intensity()[b] * relative * t[b]);
            }
        }
        progress(static_cast<double>(++done) / static_cast<double>(slices * scene.emitters.size()));
    });
}

}  // namespace

void check_irradiance_vdb(const AssembledScene& scene) {
    lattice_over(scene);
}

void write_irradiance_vdb(OutputFile& out, const AssembledScene& scene,
                          const std::vector<std::shared_ptr<const DeepShadow>>& deep_shadows,
                          const ProgressCallback& progress) {
    const Lattice lattice = lattice_over(scene);
    std::vector<Irradiance> values(scene.lamps.size());
    for (std::size_t j = 0; j < scene.emitters.size(); ++j)
        add_emitter(scene, j, *deep_shadows[j], lattice, progress,
                    values[scene.emitters[j].index()]);
    std::vector<VdbOutputGrid> grids;
    for (std::size_t j = 0; j < scene.lamps.size(); ++j) {
        for (std::size_t b = 0; b < values[j].size(); ++b) {
            VdbOutputGrid grid;
            grid.name = fmt::format("irradiance.{}.{:g}nm", scene.lamps[j].name(),
                                    scene.water.medium.wavelengths_nm[b]);
            grid.size = lattice.size;
            grid.voxel_size = lattice.voxel;
            grid.origin = lattice.origin;
            grid.value = [&data = values[j][b], &lattice](int x, int y, int z) {
                return data[lattice.index(x, y, z)];
            };
            grid.metadata = {{"unit", "W m^-2"}, {"lamp", scene.lamps[j].name()}};
            grids.push_back(std::move(grid));
        }
    }
    write_vdb(out, grids, {{"creator", "uwvdb " + program_version()}});
}

}  // namespace uw
