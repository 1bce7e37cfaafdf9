#include "core/image/camera_sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/image/spectral_bands.h"

namespace uw {

namespace {

// The SI's constants, exact by definition.
constexpr double k_planck = 6.62607015e-34;       // J s
constexpr double k_speed_of_light = 299792458.0;  // m/s
constexpr double k_nanometre = 1e-9;

double pixel_area(const CameraDesc& camera) {
    if (const auto& pitch = camera.sensor->pixel_pitch) return *pitch * *pitch;
    const double focal_length = camera.lens->focal_length;
    return focal_length * focal_length / (camera.intrinsics.fx * camera.intrinsics.fy);
}

/// (n_air / n_water)^2 where radiance is counted in the water before a port.
double port_factor_of(const CameraDesc& camera) {
    if (!camera.port) return 1;
    return std::visit(
        [](const auto& port) {
            const double ratio = port.radiance_in_air ? 1.0 : port.n_air / port.n_water;
            return ratio * ratio;
        },
        *camera.port);
}

/// Integral of eta(lambda) lambda over the interval, in nm^2: quadratic from sample to sample.
double integral_with_wavelength(const SampledCurve& efficiency, const BandInterval& interval) {
    const auto product = [&](double nm) { return nm * efficiency.value(nm); };
    double sum = 0;
    for (std::size_t i = 0; i + 1 < efficiency.x.size(); ++i) {
        const double from = std::max(efficiency.x[i], interval.begin);
        const double to = std::min(efficiency.x[i + 1], interval.end);
        if (from < to)
            sum += (to - from) / 6 * (product(from) + 4 * product(0.5 * (from + to)) + product(to));
    }
    return sum;
}

/// The mean of eta(lambda) lambda over a band's interval [nm]; outside its samples eta is 0.
double mean_with_wavelength(const SampledCurve& efficiency, double band_nm,
                            const BandInterval& interval) {
    if (interval.width() > 0)
        return integral_with_wavelength(efficiency, interval) / interval.width();
    return efficiency.covers(band_nm) ? band_nm * efficiency.value(band_nm) : 0;
}

std::vector<SampledCurve> efficiency_curves(const SensorDesc& sensor) {
    constexpr std::array<std::string_view, 3> k_colours{"r", "g", "b"};
    const QuantumEfficiencyDesc& desc = sensor.quantum_efficiency;
    const CsvTable table = read_csv_file(desc.file, desc.where);
    std::vector<SampledCurve> curves;
    if (sensor.mosaic == SensorMosaic::mono)
        curves.push_back(table.curve("wavelength_nm", "qe"));
    else
        for (const std::string_view colour : k_colours)
            curves.push_back(table.curve("wavelength_nm", colour));
    double most = 0;
    for (SampledCurve& curve : curves)
        for (std::size_t i = 0; i < curve.y.size(); ++i) {
            if (desc.is_per_power) curve.y[i] /= curve.x[i];
            if (curve.y[i] < 0)
                throw InputError(
                    fmt::format("{}: '{}' has a negative value at {:g} nm; efficiencies "
                                "are 0 or more",
                                desc.where, table.name(), curve.x[i]));
            most = std::max(most, curve.y[i]);
        }
    if (!desc.peak && most > 1)
        throw InputError(
            fmt::format("{}: '{}' has values up to {:g}, more than one electron per "
                        "photon; if they are up to a factor, add the greatest "
                        "efficiency: peak: 0.6",
                        desc.where, table.name(), most));
    if (desc.peak && most > 0)
        for (SampledCurve& curve : curves)
            for (double& value : curve.y) value *= *desc.peak / most;
    return curves;
}

}  // namespace

Photoelectrons::Photoelectrons(const SceneDesc& scene)
    : bands_(scene.water.bands_nm.size()),
      lens_(RenderDesc::Output::sensor_irradiance, scene.camera.lens),
      port_factor_(port_factor_of(scene.camera)) {
    const SensorDesc& sensor = *scene.camera.sensor;
    const std::vector<double>& bands_nm = scene.water.bands_nm;
    const std::vector<BandInterval> intervals = band_intervals(bands_nm);
    const double mean_width = mean_band_width(intervals);
    const QuantumEfficiencyDesc& efficiency = sensor.quantum_efficiency;
    std::vector<SampledCurve> curves;
    if (!efficiency.file.empty()) curves = efficiency_curves(sensor);
    const double energy_to_count =
        pixel_area(scene.camera) * *sensor.exposure * k_nanometre / (k_planck * k_speed_of_light);
    for (std::size_t colour = 0; colour < colour_count(sensor.mosaic); ++colour) {
        double sum = 0;
        for (std::size_t b = 0; b < bands_; ++b) {
            // The power of a band (docs/colour.md).
            const double width_ratio = mean_width > 0 ? intervals[b].width() / mean_width : 1;
            const double middle = 0.5 * (intervals[b].begin + intervals[b].end);
            const double mean =
                curves.empty() ? efficiency.values[colour][b] * middle
                               : mean_with_wavelength(curves[colour], bands_nm[b], intervals[b]);
            per_irradiance_[colour][b] = energy_to_count * width_ratio * mean;
            sum += mean;
        }
        if (!(sum > 0))
            throw InputError(
                fmt::format("{}: {} no light of water.bands; check the efficiencies "
                            "and their wavelengths",
                            efficiency.where,
                            colour_count(sensor.mosaic) == 1
                                ? "the sensor sees"
                                : fmt::format("its {} pixels see",
                                              std::array{"red", "green", "blue"}[colour])));
    }
}

namespace {

// What a random number is for.
enum Purpose : std::uint64_t { k_of_pixels = 1, k_of_images = 2 };

std::uint64_t seed_of_camera(std::uint64_t seed, std::string_view camera) {
    for (const char c : camera) seed = PathRandom::seed_of(seed, static_cast<unsigned char>(c));
    return seed;
}

PathRandom random_of(std::uint64_t seed, int x, int y, std::size_t colour) {
    const auto pixel = static_cast<std::uint64_t>(y) << 32U | static_cast<std::uint64_t>(x);
    return {PathRandom::seed_of(seed, pixel, colour), 0};
}

}  // namespace

SensorReadout::SensorReadout(const SensorDesc& desc, const ImageIdentity& image)
    : desc_(desc),
      gain_(desc.system_gain()),
      dark_electrons_(desc.dark_current * desc.exposure.value()) {
    const std::uint64_t camera = seed_of_camera(PathRandom::seed_of(desc.seed), image.camera);
    fixed_seed_ = PathRandom::seed_of(camera, k_of_pixels);
    image_seed_ = PathRandom::seed_of(camera, k_of_images, static_cast<std::uint64_t>(image.frame));
}

double SensorReadout::number(double photoelectrons, int x, int y, std::size_t colour) const {
    NormalPair fixed{0, 0};
    if (desc_.prnu > 0 || desc_.dsnu > 0) {
        PathRandom random = random_of(fixed_seed_, x, y, colour);
        fixed = standard_normals(random);
    }
    PathRandom random = random_of(image_seed_, x, y, colour);
    const double response = std::max(0.0, 1 + desc_.prnu * fixed.first);
    double electrons = response * std::max(0.0, photoelectrons) + dark_electrons_;
    if (desc_.shot_noise) electrons = poisson(electrons, random);
    if (desc_.full_well) electrons = std::min(electrons, *desc_.full_well);
    electrons += desc_.dsnu * fixed.second;
    if (desc_.read_noise > 0) electrons += desc_.read_noise * standard_normals(random).first;
    const double number = std::floor(gain_ * electrons + desc_.black_level + 0.5);
    return std::clamp(number, 0.0, desc_.white_level());
}

MeanNumbers::MeanNumbers(const SceneDesc& scene)
    : photoelectrons_(scene), sensor_(*scene.camera.sensor) {}

double MeanNumbers::electrons(const Spectrum& irradiance, std::size_t colour) const {
    return photoelectrons_.mean(irradiance, colour) +
           sensor_.dark_current * sensor_.exposure.value();
}

double MeanNumbers::at(const Spectrum& irradiance, std::size_t colour) const {
    double number = electrons(irradiance, colour);
    if (sensor_.full_well) number = std::min(number, *sensor_.full_well);
    return sensor_.system_gain() * number + sensor_.black_level;
}

double MeanNumbers::slope(const Spectrum& irradiance, std::size_t colour, std::size_t band) const {
    if (sensor_.full_well && electrons(irradiance, colour) > *sensor_.full_well) return 0;
    return sensor_.system_gain() * photoelectrons_.per_irradiance(colour, band);
}

double MeanNumbers::dark() const {
    return at({}, 0);
}

std::size_t colour_at(SensorMosaic mosaic, int x, int y) {
    // The colours at (0, 0), (1, 0), (0, 1), (1, 1).
    constexpr std::size_t r = 0, g = 1, b = 2;
    using Pattern = std::array<std::size_t, 4>;
    constexpr Pattern rggb{r, g, g, b}, bggr{b, g, g, r}, grbg{g, r, b, g}, gbrg{g, b, r, g};
    const std::size_t place = static_cast<std::size_t>(x & 1) + 2 * static_cast<std::size_t>(y & 1);
    switch (mosaic) {
        case SensorMosaic::rggb:
            return rggb[place];
        case SensorMosaic::bggr:
            return bggr[place];
        case SensorMosaic::grbg:
            return grbg[place];
        case SensorMosaic::gbrg:
            return gbrg[place];
        case SensorMosaic::mono:
        case SensorMosaic::three:
            break;
    }
    return 0;
}

namespace {

// The light of a pixel per band; with three bands these are R G B.
std::span<const float> light_of(const LayerPlan& plan, std::span<float> pixel) {
    if (plan.has(Layer::total)) return plan.channels(Layer::total, pixel);
    return pixel.first(3);
}

}  // namespace

CameraSensor::CameraSensor(const SceneDesc& scene, std::int64_t frame)
    : mosaic_(scene.camera.sensor->mosaic),
      photoelectrons_(scene),
      readout_(*scene.camera.sensor, {scene.camera_name, frame}) {}

void CameraSensor::expose(const RaySource& rays, const LayerPlan& plan, Film& film) const {
    const PixelWindow& window = film.window();
    const double vergence = rays.focus_vergence();
    parallel_for(static_cast<std::size_t>(window.height()), [&](std::size_t line) {
        const int y = window.y0 + static_cast<int>(line);
        for (int x = window.x0; x < window.x1; ++x) {
            const std::span<float> pixel = film.pixel(x, y);
            Spectrum irradiance;
            if (pixel[k_alpha] > 0) {
                const double factor =
                    photoelectrons_.irradiance_factor(rays.lens_ray(x + 0.5, y + 0.5), vergence);
                std::size_t b = 0;
                for (const float radiance : light_of(plan, pixel))
                    irradiance[b++] = factor * static_cast<double>(radiance);
            }
            std::size_t colour = colour_at(mosaic_, x, y);
            for (float& number : plan.channels(Layer::sensor, pixel)) {
                const double electrons = photoelectrons_.mean(irradiance, colour);
                number = static_cast<float>(readout_.number(electrons, x, y, colour++));
            }
        }
    });
}

}  // namespace uw
