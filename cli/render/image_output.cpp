#include "cli/render/image_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <vector>

#include "core/base/error.h"
#include "core/base/output_files.h"
#include "core/base/parallel.h"
#include "core/base/version.h"
#include "core/image/jpeg_file.h"
#include "core/image/pixel_image.h"
#include "core/image/png_file.h"
#include "core/light/medium.h"
#include "media/volumes/vdb_writer.h"
#include "render/image_header.h"

namespace uw {

namespace {

// The window with as many more pixels of the image around it.
PixelWindow grown(const PixelWindow& window, int margin, const CameraDesc& camera) {
    return {std::max(window.x0 - margin, 0), std::max(window.y0 - margin, 0),
            std::min(window.x1 + margin, camera.width),
            std::min(window.y1 + margin, camera.height)};
}

}  // namespace

void write_sensor_image(OutputFile& out, const SensorImage& sensor, const ImageMetadata& metadata) {
    if (sensor.desc.format == DevelopmentDesc::Format::jpeg)
        write_jpeg_file(out, sensor.image, sensor.desc.quality, metadata);
    else
        write_png_file(out, sensor.image, metadata);
}

SensorImager::SensorImager(const Frame& frame, const SceneDesc& scene, const RenderOptions& wanted)
    : window_(wanted.window.value()), rendered_(wanted) {
    if (frame.files.sensor.empty()) return;
    const SensorDesc& sensor = scene.camera.sensor.value();
    development_.emplace(sensor);
    desc_ = sensor.image;
    rendered_.layers = (wanted.layers.empty() ? "default" : wanted.layers) + ",sensor";
    rendered_.window = grown(window_, development_->margin(), scene.camera);
    rendered_.frame = frame.number.value_or(0);
}

std::optional<SensorImage> SensorImager::take(Film& film, const LayerPlan& plan) const {
    if (!development_) return std::nullopt;
    SensorImage image{(*development_)(film, window_), desc_};
    if (film.window() != window_ || film.channel_names() != plan.channel_names())
        film = with_channels(film, plan.channel_names(), window_);
    return image;
}

namespace {

std::size_t count_empty(const Film& film) {
    const PixelWindow& window = film.window();
    std::size_t empty = 0;
    for (int y = window.y0; y < window.y1; ++y) {
        throw_if_stopped();
        for (int x = window.x0; x < window.x1; ++x) empty += film.pixel(x, y)[k_alpha] == 0 ? 1 : 0;
    }
    return empty;
}

// A warning of one line if the image is black, or empty in part.
void warn_of_darkness(const PixelWindow& window, std::size_t empty, bool black,
                      const SayCallback& warn) {
    const std::size_t pixels =
        static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
    if (empty > 0)
        warn(
            fmt::format("{} of {} pixels are empty (alpha 0): their rays do not pass through the "
                        "port, or the lens's distortion leaves no ray for them",
                        empty, pixels));
    if (black && empty < pixels)
        warn(
            "the image is black: no lamp's light reaches the camera; check the "
            "lamps' positions, directions and intensities, the camera's pose, and how far "
            "light travels in this water");
}

void warn_of_half(const HalfLoss& loss, const SayCallback& warn) {
    if (loss.too_large > 0)
        warn(fmt::format(
            "--precision half: {} values are too large for half floats, and infinite in "
            "the file; use --precision float",
            loss.too_large));
    if (loss.too_dark)
        warn(
            "--precision half: the light is so weak that half floats round it visibly; use "
            "--precision float");
}

void write_preview(OutputFile& out, const Film& film, const ImageStorage& storage, double exposure,
                   const ImageMetadata& metadata) {
    if (storage.is_preview_16_bit)
        write_png_file(out, make_preview16(film, exposure), metadata);
    else
        write_png_file(out, make_preview(film, exposure), metadata);
}

}  // namespace

void write_images(const OutputFiles& files, const Film& film,
                  const std::optional<SensorImage>& sensor, const SurfaceNames& names,
                  ImageMetadata metadata, const ImageStorage& storage, OutputGroup& outputs,
                  const SayCallback& say, const SayCallback& warn) {
    const std::optional<double> automatic = automatic_exposure(film);
    const double exposure = storage.exposure.value_or(automatic.value_or(1.0));
    const bool with_exr = !files.image.empty();
    if (with_exr) {
        ImageMetadata with_names = metadata;
        if (!files.ids.empty()) add_id_names(names, with_names);
        write_exr(outputs.add(files.image), film, with_names, storage.exr);
        if (!files.ids.empty()) write_id_table(outputs.add(files.ids), names);
    }
    if (sensor) write_sensor_image(outputs.add(files.sensor), *sensor, metadata);
    metadata["exposure"] = exposure;
    if (!files.preview.empty())
        write_preview(outputs.add(files.preview), film, storage, exposure, metadata);
    const std::size_t empty = count_empty(film);
    std::optional<HalfLoss> loss;
    if (with_exr && storage.exr.precision == ExrOptions::Precision::half) loss = half_loss(film);
    {
        // Or the EXR might be of one run and its preview of another.
        const FolderLock lock(files.main().parent_path());
        outputs.commit();
    }
    if (!files.irradiance_vdb.empty()) say(fmt::format("wrote {}", files.irradiance_vdb.string()));
    warn_of_darkness(film.window(), empty, !automatic, warn);
    if (loss) warn_of_half(*loss, warn);
    if (with_exr) say(fmt::format("wrote {}", files.image.string()));
    if (!files.ids.empty()) say(fmt::format("wrote {} (names of ids)", files.ids.string()));
    if (sensor) say(fmt::format("wrote {} (the camera's image)", files.sensor.string()));
    if (files.preview.empty()) return;
    say(fmt::format("wrote {} ({}{})", files.preview.string(), with_exr ? "preview, " : "",
                    automatic ? fmt::format("R G B x {:.4g}", exposure) : "black"));
}

namespace {

constexpr int k_longest_side = 256;
// Of all grids together: 1 GiB here, and as much again in OpenVDB.
constexpr double k_most_values = 1 << 28;

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
    Bounds bounds = scene.field->bounds();
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
        if (static_cast<double>(lattice.count()) * grids <= k_most_values) return lattice;
    }
}

// Irradiance at every lattice point, [band][point].
using Irradiance = std::vector<std::vector<float>>;

// Adds that of one emitter.
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
                // A voxel that contains the lamp has no single value: that at its edge is used
                // instead.
                const double r = std::max(radius, 0.5 * lattice.voxel);
                light.columns(std::span<const Point3>(&x, 1), column);
                const Spectrum t = attenuation.transmittance(radius, column);
                const double relative = lamp.relative_intensity(v) / lamp.spread(r);
                for (std::size_t b = 0; b < bands; ++b)
                    result[b][lattice.index(i, j, k)] +=
                        static_cast<float>(lamp.axis_intensity()[b] * relative * t[b]);
            }
        }
        if (!progress(static_cast<double>(++done) /
                      static_cast<double>(slices * scene.emitters.size())))
            throw Interrupted();
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
