#include "fit/picture_residuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "camera/camera.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/geometry/mesh.h"
#include "core/image/camera_sensor.h"
#include "core/image/colour.h"
#include "core/image/image_file.h"
#include "core/light/integrator_table.h"
#include "core/scene/pose_file.h"
#include "render/derivatives/derivatives.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

bool has_all_light(const SceneDesc& scene) {
    return scattering_of(scene.render) == RenderDesc::Scattering::multiple;
}

/// The relative error of a prediction itself: shadows and tables are accurate to about 1e-3 at a
/// scene's usual quality, and multiply scattered light, which is estimated by random paths, to
/// 1e-2.
double model_error(const SceneDesc& scene) {
    return has_all_light(scene) ? 1e-2 : 1e-3;
}

/// The steps of unknowns within which derivatives serve, to either side, and those of central
/// differences. Light is interpolated, so that smaller steps would measure the tables; the error of
/// larger ones grows with the square. With all light, smaller steps would measure that the random
/// paths differ on both sides: such noise looks like information about unknowns that compensate
/// each other, absorption and scattering, which then move too little.
double step_of(const SceneUnknown& unknown, bool has_all_light) {
    if (!has_all_light) return 1e-2 * unknown.scale;
    return 0.3 * std::max(std::abs(unknown.start), 0.25 * unknown.scale);
}

/// The least number of pixels that are rendered for a picture. The water's light is evaluated at
/// the centre of a pixel; with fewer pixels its curvature within one is an error of more than 1e-3.
/// With all light each pixel has a node, and variation between nodes is smoothed
/// (docs/multiple.md).
constexpr double k_min_pixels = 2300;

/// The side of cells, about this many of which lie across a picture [pixels]. It is a whole number,
/// so that cells coincide with pixels of a coarser image. For a mosaic it is odd: then the pixels
/// of each colour are centred in the cell, wherever the pattern begins.
int side_of_cells(const CameraDesc& camera, int cells) {
    const double side = static_cast<double>(camera.width) / cells;
    if (camera.sensor && is_bayer(camera.sensor->mosaic))
        return 1 + 2 * std::max(1, static_cast<int>(std::lround((side - 1) / 2)));
    return std::clamp(static_cast<int>(std::lround(side)), 1,
                      std::min(camera.width, camera.height));
}

/// The least number of pixels over which scatter is measured: over fewer it is too inaccurate.
constexpr int k_min_scatter_side = 5;

void refuse_developed(const SensorDesc& sensor) {
    if (sensor.image.is_raw) return;
    throw InputError(fmt::format(
        "{}: its images are developed, and raw numbers are compared; take camera.sensor.image "
        "out and give raw pictures, or take camera.sensor out and let --unknown exposure,response "
        "stand for what developed them",
        sensor.where));
}

/// The number that a value of 1 in a raw picture represents: its bits are the uppermost of a byte
/// or of two [DN].
double number_of_one(const SensorDesc& sensor) {
    const int bits = sensor.bit_depth <= 8 ? 8 : 16;
    return static_cast<double>((1 << bits) - 1) / (1 << (bits - sensor.bit_depth));
}

/// A picture's pixels as what is compared: light, or a sensor's numbers.
class Values {
  public:
    Values(PixelImage image, const std::optional<SensorDesc>& sensor)
        : image_(std::move(image)), sensor_(sensor) {}

    /// The colour `k` of a pixel; none where the pixel's filter is of another.
    std::optional<double> at(int x, int y, std::size_t k) const {
        const bool is_grey = image_.channels < 3;
        if (sensor_ && is_bayer(sensor_->mosaic) && colour_at(sensor_->mosaic, x, y) != k)
            return std::nullopt;
        const auto index = static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                           static_cast<std::size_t>(x);
        const double value =
            image_.pixels[index * static_cast<std::size_t>(image_.channels) + (is_grey ? 0 : k)];
        if (sensor_) return value * number_of_one(*sensor_);
        return image_.is_linear ? value : linear_from_srgb(value);
    }
    /// The value from which on a pixel may be saturated.
    double white() const {
        constexpr double k_nearly = 0.995;
        if (sensor_) {
            const double well = sensor_->full_well ? sensor_->system_gain() * *sensor_->full_well +
                                                         sensor_->black_level
                                                   : sensor_->white_level();
            return k_nearly * std::min(well, sensor_->white_level());
        }
        return image_.is_linear ? std::numeric_limits<double>::infinity() : k_nearly;
    }

    /// Whether a pixel is completely valid: no part of it is masked by the alpha of its file.
    bool is_whole(int x, int y) const {
        if (image_.channels != 2 && image_.channels != 4) return true;
        const auto index = static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                           static_cast<std::size_t>(x);
        return image_.pixels[(index + 1) * static_cast<std::size_t>(image_.channels) - 1] >= 1;
    }
    int width() const { return image_.width; }
    int height() const { return image_.height; }

  private:
    PixelImage image_;
    const std::optional<SensorDesc>& sensor_;
};

/// The variance of a sensor's number around its mean `number`, as EMVA 1288 has it.
double variance_of(double number, const SensorDesc& sensor) {
    const double gain = sensor.system_gain();
    const double signal = std::max(0.0, number - sensor.black_level);
    const double shot = sensor.shot_noise ? gain * signal : 0;
    const double dark = std::hypot(sensor.read_noise, sensor.dsnu) * gain;
    constexpr double k_rounding = 1.0 / 12;
    return shot + dark * dark + std::pow(sensor.prnu * signal, 2) + k_rounding;
}

/// The statistics of a colour's values over a window of a picture.
struct Spread {
    double count = 0, sum = 0, squares = 0, least = 1e300, most = -1e300;

    Spread(const Values& values, const PixelWindow& window, std::size_t colour) {
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x)
                if (const std::optional<double> value = values.at(x, y, colour)) {
                    if (!std::isfinite(*value)) continue;
                    count += 1;
                    sum += *value;
                    squares += *value * *value;
                    least = std::min(least, *value);
                    most = std::max(most, *value);
                }
    }
    double mean() const { return sum / count; }
    double variance() const {
        if (!(most > least) || count < 2) return 0;
        return std::max(0.0, (squares - sum * mean()) / (count - 1));
    }
};

/// Whether a cell can be compared: the lens sees all of it in the water, and no pixel is white,
/// masked or no number.
bool is_comparable(const Camera& camera, const Values& values, const PixelWindow& window,
                   std::size_t colours) {
    for (const int x : {window.x0, window.x1})
        for (const int y : {window.y0, window.y1})
            if (!camera.refracted_ray(x, y)) return false;
    const double white = values.white();
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) {
            if (!values.is_whole(x, y)) return false;
            for (std::size_t k = 0; k < colours; ++k) {
                const std::optional<double> value = values.at(x, y, k);
                if (value && (!(*value < white) || !std::isfinite(*value))) return false;
            }
        }
    return true;
}

/// The image of a scene that a picture shows.
ImageScene scene_of_picture(const SceneDesc& scene, const ObservedPicture& picture) {
    if (!picture.world_from_camera) return scene_of_image(scene, picture.choice);
    SceneDesc posed = scene;
    const TrajectoryDesc place =
        posed.camera.trajectory ? *posed.camera.trajectory : TrajectoryDesc();
    posed.camera.world_from_camera = placed(*picture.world_from_camera, place).affine();
    posed.camera.trajectory.reset();
    return {std::move(posed), picture.choice};
}

/// What is compared of the light of a scene's image: a sensor's numbers, or red, green and blue, or
/// their mean.
class ComparedLight {
  public:
    using Colours = std::array<double, 3>;

    /// `image`: the camera of the pixels, which may be coarser than those of the scene.
    ComparedLight(const SceneDesc& scene, const CameraDesc& image, std::size_t colours)
        : count_(colours),
          bands_(scene.water.bands_nm.size()),
          camera_(image),
          rgb_(make_band_colour(scene.render.colour, scene.water.bands_nm)) {
        if (scene.camera.sensor) numbers_.emplace(scene);
    }

    Colours colours(int x, int y, const Spectrum& radiance) const {
        if (!numbers_) return of_bands(radiance);
        const Spectrum irradiance = factor(x, y) * radiance;
        Colours numbers{};
        for (std::size_t k = 0; k < count_; ++k) numbers[k] = numbers_->at(irradiance, k);
        return numbers;
    }
    /// Their change with the light: the sum over the bands of `change`.
    Colours change(int x, int y, const Spectrum& change) const {
        if (!numbers_) return of_bands(change);
        const double per_radiance = factor(x, y);
        Colours numbers{};
        for (std::size_t k = 0; k < count_; ++k)
            for (std::size_t b = 0; b < bands_; ++b)
                numbers[k] += numbers_->slope({}, k, b) * per_radiance * change[b];
        return numbers;
    }

  private:
    Colours of_bands(const Spectrum& radiance) const {
        const LinearRgb rgb = rgb_(radiance);
        if (count_ == 1) return {(rgb[0] + rgb[1] + rgb[2]) / 3};
        return {rgb[0], rgb[1], rgb[2]};
    }
    double factor(int x, int y) const {
        return numbers_->photoelectrons().irradiance_factor(camera_.lens_ray(x + 0.5, y + 0.5),
                                                            camera_.focus_vergence());
    }

    std::size_t count_, bands_;
    Camera camera_;
    BandColour rgb_;
    std::optional<MeanNumbers> numbers_;
};

PixelImage read_picture(const std::filesystem::path& file) {
    const std::string ending = file.extension().string();
    const bool holds_light = ending == ".exr" || ending == ".hdr" || ending == ".EXR";
    return holds_light ? read_linear_image(file) : read_image(file);
}

}  // namespace

std::vector<ObservedPicture> pictures_called(const std::filesystem::path& name) {
    if (!has_frame_pattern(name.string())) return {{name, {}}};
    std::vector<ObservedPicture> pictures;
    for (const int frame : frames_found(name))
        pictures.push_back({file_of_frame(name, frame), {frame, 0}});
    if (pictures.empty())
        throw IoError(fmt::format("{}: there is no such picture for any frame; check the name",
                                  name.string()));
    return pictures;
}

PictureResiduals::PictureResiduals(const SceneUnknowns& unknowns,
                                   std::vector<ObservedPicture> files, int cells)
    : unknowns_(unknowns), files_(std::move(files)) {
    std::vector<double> start;
    for (const SceneUnknown& unknown : unknowns_.all()) start.push_back(unknown.start);
    const SceneDesc scene = unknowns_.scene(start);
    if (scene.rig_trajectory && !files_.empty() && files_.front().world_from_camera)
        throw InputError(
            fmt::format("{}: moves the rig, and --poses the camera in it; take one of them out",
                        scene.rig_trajectory->where));
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
        const SceneUnknown& unknown = unknowns_.all()[i];
        if (unknown.of == SceneUnknown::Of::exposure) exposures_.push_back(i);
        if (unknown.of == SceneUnknown::Of::response) response_ = i;
    }
    if (scene.camera.sensor) {
        refuse_developed(*scene.camera.sensor);
        colours_ = colour_count(scene.camera.sensor->mosaic);
        dark_ = MeanNumbers(scene).dark();
        if (response_)
            throw UsageError(
                "--unknown response: a sensor's raw numbers are in proportion to light; leave it "
                "out");
    }
    has_all_light_ = has_all_light(scene);
    model_error_ = model_error(scene);
    for (const SceneUnknown& unknown : unknowns_.all())
        steps_.push_back(step_of(unknown, has_all_light_));
    sensor_ = scene.camera.sensor;
    cell_side_ = side_of_cells(scene.camera, cells);
    width_ = scene.camera.width / cell_side_;
    height_ = scene.camera.height / cell_side_;
    if (width_ == 0 || height_ == 0)
        throw InputError(fmt::format("the pictures of {} x {} pixels are too small to compare",
                                     scene.camera.width, scene.camera.height));
    // The remaining pixels are divided equally between the edges.
    left_ = (scene.camera.width - cell_side_ * width_) / 2;
    top_ = (scene.camera.height - cell_side_ * height_) / 2;
    pixels_per_side_ = std::clamp(
        static_cast<int>(std::ceil(std::sqrt(k_min_pixels / (width_ * height_)))), 1, cell_side_);
    first_cell_.push_back(0);
    for (std::size_t i = 0; i < files_.size(); ++i) {
        names_.push_back(files_[i].file.filename().string());
        renderers_.emplace_back();
        read(i, scene);
    }
    weigh(Weights::by_observation);
    const std::size_t all =
        files_.size() * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    constexpr double k_min_fraction = 0.01;
    if (static_cast<double>(cells_.size()) < k_min_fraction * static_cast<double>(all))
        throw InputError(fmt::format(
            "the pictures have next to nothing to compare: {} of {} cells are neither black nor "
            "white; expose them so that what matters is grey",
            cells_.size(), all));
}

void PictureResiduals::read(std::size_t picture, const SceneDesc& scene) {
    const std::filesystem::path& file = files_[picture].file;
    PixelImage image = read_picture(file);
    if (image.width != scene.camera.width || image.height != scene.camera.height)
        throw InputError(fmt::format(
            "{}: is {} x {} pixels, and the scene's camera {} x {}; set camera.resolution and "
            "camera.intrinsics to the picture's",
            file.string(), image.width, image.height, scene.camera.width, scene.camera.height));
    if (scene.camera.sensor &&
        (value_count(scene.camera.sensor->mosaic) == 3) != (image.channels >= 3))
        throw InputError(fmt::format(
            "{}: has {}, which the scene's sensor does not store; check camera.sensor.mosaic",
            file.string(), counted(static_cast<std::size_t>(image.channels), "channel")));
    if (!scene.camera.sensor && image.channels < 3) colours_ = 1;
    const Values values(std::move(image), scene.camera.sensor);
    const Camera camera(scene.camera);
    std::vector<std::optional<Cell>> found(static_cast<std::size_t>(width_) *
                                           static_cast<std::size_t>(height_));
    parallel_for(found.size(), [&](std::size_t index) {
        Cell cell{
            picture, static_cast<int>(index) % width_, static_cast<int>(index) / width_, {}, {}, {},
            {}};
        const int x0 = left_ + cell.x * cell_side_, y0 = top_ + cell.y * cell_side_;
        const PixelWindow window{x0, y0, x0 + cell_side_, y0 + cell_side_};
        if (!is_comparable(camera, values, window, colours_)) return;
        const int more = std::max(0, (k_min_scatter_side - cell_side_ + 1) / 2);
        const PixelWindow around =
            intersection({window.x0 - more, window.y0 - more, window.x1 + more, window.y1 + more},
                         {0, 0, values.width(), values.height()});
        for (std::size_t k = 0; k < colours_; ++k) {
            const Spread spread(values, window, k);
            if (spread.count == 0) return;
            cell.mean[k] = spread.mean();
            if (!sensor_) {
                cell.scatter[k] = Spread(values, around, k).variance() / spread.count;
                continue;
            }
            // The scatter of few pixels is inaccurate: if it is compatible with noise, it is taken
            // as noise.
            constexpr double k_like_noise = 4;
            const double variance = spread.variance();
            if (variance < k_like_noise * variance_of(cell.mean[k], *sensor_))
                cell.noisy_pixels[k] = spread.count;
            else
                cell.scatter[k] = variance / spread.count;
        }
        found[index] = cell;
    });
    double brightest = 0;
    for (const std::optional<Cell>& cell : found)
        if (cell) brightest = std::max(brightest, *std::ranges::max_element(cell->mean));
    brightest_.push_back(brightest);
    for (const std::optional<Cell>& cell : found)
        if (cell && brightest > 0) cells_.push_back(*cell);
    first_cell_.push_back(cells_.size());
}

void PictureResiduals::weigh(Weights by) {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        Cell& cell = cells_[i];
        for (std::size_t k = 0; k < colours_; ++k) {
            const double value = by == Weights::by_observation || light_.empty()
                                     ? cell.mean[k]
                                     : seen(i, light_[i][k]).value;
            const double variance = cell.noisy_pixels[k] > 0
                                        ? variance_of(value, *sensor_) / cell.noisy_pixels[k]
                                        : cell.scatter[k];
            // In dark parts the absolute error is at least that of the bright parts.
            cell.error[k] = std::hypot(std::sqrt(variance), model_error_ * value,
                                       0.1 * model_error_ * brightest_[cell.picture]);
        }
    }
}

void PictureResiduals::show_cells(SceneDesc& scene, int side) const {
    CameraDesc& camera = scene.camera;
    camera.intrinsics.cx -= left_;
    camera.intrinsics.cy -= top_;
    camera.width = cell_side_ * width_;
    camera.height = cell_side_ * height_;
    resize_image(camera, side * width_, side * height_);
    // With a power of two the samples of a pixel are centred in it (PixelSampling).
    constexpr unsigned k_fewest = 4;
    if (!integrator_kind(scene.render.integrator).traces_paths)
        scene.render.samples = static_cast<int>(
            std::bit_ceil(std::max(k_fewest, static_cast<unsigned>(samples_of(scene.render)))));
}

PictureResiduals::Prediction PictureResiduals::predict(std::span<const double> values,
                                                       Light light) {
    Prediction prediction(cells_.size());
    const SceneDesc scene = unknowns_.scene(values);
    for (std::size_t picture = 0; picture < files_.size(); ++picture)
        predict(picture, scene, light, prediction);
    return prediction;
}

void PictureResiduals::predict(std::size_t picture, const SceneDesc& scene, Light light,
                               Prediction& prediction) {
    throw_if_stopped();
    const int side = light == Light::of_the_scene ? pixels_per_side_ : 1;
    const ImageScene whole = scene_of_picture(scene, files_[picture]);
    Renderer& renderer = renderers_[picture];
    renderer.set_scene(whole.with([&](SceneDesc& desc) {
        show_cells(desc, side);
        if (light != Light::scattered_once || !has_all_light_) return;
        desc.render.integrator = RenderDesc::Integrator::volume;
        desc.render.scattering = RenderDesc::Scattering::single;
    }));
    RenderOptions options;
    options.layers = "total";
    const Film& film = renderer.render(options);
    const LayerPlan plan = layer_plan(renderer.scene(), options.layers);
    // Three bands are red, green and blue themselves.
    const std::size_t first =
        plan.has(Layer::total) ? static_cast<std::size_t>(plan.first_channel(Layer::total)) : k_red;
    const ComparedLight compared(whole.desc(), renderer.scene().desc().camera, colours_);
    for (std::size_t i = first_cell_[picture]; i < first_cell_[picture + 1]; ++i) {
        prediction[i] = {};
        for (int n = 0; n < side * side; ++n) {
            const int x = side * cells_[i].x + n % side, y = side * cells_[i].y + n / side;
            Spectrum radiance;
            for (std::size_t b = 0; b < plan.band_count(); ++b)
                radiance[b] = double{film.pixel(x, y)[first + b]};
            const Colours colours = compared.colours(x, y, radiance);
            for (std::size_t k = 0; k < colours_; ++k)
                prediction[i][k] += colours[k] / (side * side);
        }
    }
}

void PictureResiduals::differentiate(std::size_t picture, std::span<const SceneStep> steps) {
    throw_if_stopped();
    const SceneDesc scene = unknowns_.scene(shared_);
    const ImageScene image = coarse_image(picture, scene);
    std::vector<ChangedScene> changes;
    for (const SceneStep& step : steps)
        changes.push_back({unknowns_.all()[step.unknown].name, coarse_image(picture, step.back),
                           coarse_image(picture, step.ahead), step.size});
    renderers_[picture].set_scene(image);
    const std::vector<float> images =
        scene_derivatives(renderers_[picture], changes, {}, [](double) {});
    const ComparedLight compared(scene_of_picture(scene, files_[picture]).desc(),
                                 image.desc().camera, colours_);
    const std::size_t bands = image.desc().water.bands_nm.size();
    const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
    for (std::size_t n = 0; n < steps.size(); ++n)
        for (std::size_t i = first_cell_[picture]; i < first_cell_[picture + 1]; ++i) {
            const auto x = static_cast<std::size_t>(cells_[i].x);
            const auto y = static_cast<std::size_t>(cells_[i].y);
            const std::size_t first = ((n * height + y) * width + x) * bands;
            Spectrum change;
            for (std::size_t b = 0; b < bands; ++b) change[b] = double{images[first + b]};
            by_unknown_[steps[n].unknown][i] = compared.change(cells_[i].x, cells_[i].y, change);
        }
}

PictureResiduals::Seen PictureResiduals::seen(std::size_t cell, double light) const {
    const double exposure = exposures_.empty() ? 1 : shared_[exposures_[cells_[cell].picture]];
    const double power = response_ ? shared_[*response_] : 1;
    const double exposed = exposure * (light - dark_);
    if (!(exposed > 0)) return {dark_, 0, 0, 0};
    const double value = power == 1 ? exposed : std::pow(exposed, power);
    return {dark_ + value, power * value / (light - dark_), power * value / exposure,
            value * std::log(exposed)};
}

std::vector<double> PictureResiduals::exposures_at(std::span<const double> shared) {
    std::vector<double> seen(files_.size(), 0), predicted(files_.size(), 0);
    if (!prepare(shared, false)) return std::vector<double>(files_.size(), 1);
    for (std::size_t i = 0; i < cells_.size(); ++i)
        for (std::size_t k = 0; k < colours_; ++k) {
            seen[cells_[i].picture] += cells_[i].mean[k] - dark_;
            predicted[cells_[i].picture] += light_[i][k] - dark_;
        }
    for (std::size_t picture = 0; picture < files_.size(); ++picture)
        seen[picture] =
            seen[picture] > 0 && predicted[picture] > 0 ? seen[picture] / predicted[picture] : 1;
    return seen;
}

PictureResiduals::SceneStep PictureResiduals::change_by(std::size_t unknown) const {
    std::vector<double> back = shared_, ahead = shared_;
    back[unknown] = moved(unknown, -1);
    ahead[unknown] = moved(unknown, 1);
    return {unknown, unknowns_.scene(back), unknowns_.scene(ahead), ahead[unknown] - back[unknown]};
}

double PictureResiduals::moved(std::size_t unknown, double steps) const {
    return std::clamp(shared_[unknown] + steps * steps_[unknown], unknowns_.all()[unknown].lower,
                      unknowns_.all()[unknown].upper);
}

ImageScene PictureResiduals::coarse_image(std::size_t picture, const SceneDesc& scene) const {
    return scene_of_picture(scene, files_[picture]).with([&](SceneDesc& desc) {
        show_cells(desc, 1);
        desc.render.samples = 1;  // at the centre, as all of the water's light
    });
}

bool PictureResiduals::is_differentiable(const SceneStep& step) {
    std::size_t picture = 0;  // with the most cells
    const auto count = [&](std::size_t p) { return first_cell_[p + 1] - first_cell_[p]; };
    for (std::size_t p = 1; p < files_.size(); ++p)
        if (count(p) > count(picture)) picture = p;
    try {
        differentiate(picture, {&step, 1});
    } catch (const UsageError&) {
        return false;
    }
    Prediction ahead(cells_.size());
    predict(picture, step.ahead, Light::of_the_scene, ahead);
    const double size = moved(step.unknown, 1) - shared_[step.unknown];
    double missing = 0, all = 0;
    for (std::size_t i = first_cell_[picture]; i < first_cell_[picture + 1]; ++i)
        for (std::size_t k = 0; k < colours_; ++k) {
            const double change = ahead[i][k] - light_[i][k];
            missing +=
                std::pow((by_unknown_[step.unknown][i][k] * size - change) / cells_[i].error[k], 2);
            all += std::pow(change / cells_[i].error[k], 2);
        }
    // The motion of the edges of shadows and beams is not in the renderer's derivatives; curvature
    // within a step changes the difference by a few percent.
    constexpr double k_missing = 0.1;
    return all > 0 && missing <= k_missing * k_missing * all;
}

void PictureResiduals::choose_derivatives() {
    by_unknown_.assign(shared_.size(), Prediction(cells_.size()));
    differentiated_.clear();
    together_.clear();
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < shared_.size(); ++i) {
        if (unknowns_.all()[i].of != SceneUnknown::Of::scene) continue;
        const bool is_smooth = !has_all_light_ && is_differentiable(change_by(i));
        (is_smooth ? differentiated_ : others).push_back(i);
    }
    if (others.empty()) return;
    // Single scattering has no noise.
    const Prediction before = predict(shared_, Light::scattered_once);
    for (const std::size_t i : others) {
        std::vector<double> values = shared_;
        values[i] = moved(i, moved(i, 1) > values[i] ? 1 : -1);
        const Prediction after = predict(values, Light::scattered_once);
        std::array<double, 3> changes{};
        for (std::size_t cell = 0; cell < cells_.size(); ++cell)
            for (std::size_t k = 0; k < colours_; ++k)
                changes[k] +=
                    std::pow((after[cell][k] - before[cell][k]) / cells_[cell].error[k], 2);
        // If quadrature refines for one band, others change by its tolerance. If nothing changes at
        // all, multiply scattered light may.
        constexpr double k_independent = 1e-2;
        const double most = *std::ranges::max_element(changes);
        std::array<bool, 3> colours{};
        for (std::size_t k = 0; k < colours.size(); ++k)
            colours[k] = most == 0 || changes[k] > k_independent * k_independent * most;
        const auto is_apart = [&](const Together& group) {
            for (std::size_t k = 0; k < colours.size(); ++k)
                if (group.of_colour[k] && colours[k]) return false;
            return true;
        };
        auto group = std::ranges::find_if(together_, is_apart);
        if (group == together_.end()) group = together_.insert(group, Together{});
        for (std::size_t k = 0; k < colours.size(); ++k)
            if (colours[k]) group->of_colour[k] = i;
    }
}

void PictureResiduals::take_derivatives() {
    derivatives_at_.clear();
    if (!has_chosen_) choose_derivatives();
    has_chosen_ = true;
    std::vector<SceneStep> steps;
    for (const std::size_t i : differentiated_) steps.push_back(change_by(i));
    for (std::size_t picture = 0; picture < files_.size() && !steps.empty(); ++picture)
        differentiate(picture, steps);
    for (const Together& group : together_) {
        std::vector<double> back = shared_, ahead = shared_;
        for (const std::optional<std::size_t> i : group.of_colour) {
            if (!i) continue;
            back[*i] = moved(*i, -1);
            ahead[*i] = moved(*i, 1);
        }
        const Prediction light_back = predict(back, Light::of_the_scene);
        const Prediction light_ahead = predict(ahead, Light::of_the_scene);
        for (std::size_t k = 0; k < colours_; ++k) {
            if (!group.of_colour[k]) continue;
            const std::size_t i = *group.of_colour[k];
            for (std::size_t cell = 0; cell < cells_.size(); ++cell)
                by_unknown_[i][cell][k] =
                    (light_ahead[cell][k] - light_back[cell][k]) / (ahead[i] - back[i]);
        }
    }
    derivatives_at_ = shared_;
}

bool PictureResiduals::is_near(std::span<const double> shared, std::span<const double> other,
                               double steps) const {
    if (other.empty()) return false;
    for (std::size_t i = 0; i < shared.size(); ++i) {
        const SceneUnknown& unknown = unknowns_.all()[i];
        if (unknown.of == SceneUnknown::Of::scene &&
            !(std::abs(shared[i] - other[i]) <= steps * steps_[i]))
            return false;
    }
    return true;
}

bool PictureResiduals::prepare(std::span<const double> shared, bool with_derivatives) {
    shared_.assign(shared.begin(), shared.end());
    try {
        if (!is_near(shared, light_of_, 0)) {
            light_of_.clear();
            light_ = predict(shared, Light::of_the_scene);
            light_of_ = shared_;
        }
        if (with_derivatives && !is_near(shared, derivatives_at_, has_all_light_ ? 0.1 : 1))
            take_derivatives();
        return true;
    } catch (const InputError&) {
        light_of_.clear();
        return false;  // no such scene: the solver takes a smaller step
    }
}

bool PictureResiduals::evaluate(std::size_t group, const Block* /*block*/, double* residuals,
                                double* by_shared, double* /*by_block*/) const {
    const Cell& cell = cells_[group];
    for (std::size_t k = 0; k < colours_; ++k) {
        const double error = cell.error[k] * deviation();
        const Seen predicted = seen(group, light_[group][k]);
        residuals[k] = (predicted.value - cell.mean[k]) / error;
        if (by_shared == nullptr) continue;
        const std::size_t n = shared_.size();
        for (std::size_t i = 0; i < n; ++i) {
            double derivative = 0;
            if (unknowns_.all()[i].of != SceneUnknown::Of::scene) {
                if (response_ && i == *response_)
                    derivative = predicted.by_power;
                else if (unknowns_.all()[i].picture == cell.picture)
                    derivative = predicted.by_exposure;
            } else {
                derivative = predicted.by_light * by_unknown_[i][group][k];
            }
            by_shared[k * n + i] = derivative / error;
        }
    }
    return true;
}

std::vector<ResidualGroup> PictureResiduals::groups() const {
    return std::vector<ResidualGroup>(cells_.size(), {static_cast<int>(colours_)});
}

Observations::Place PictureResiduals::place(std::size_t group) const {
    const Cell& cell = cells_[group];
    return {cell.picture,
            {left_ + (cell.x + 0.5) * cell_side_, top_ + (cell.y + 0.5) * cell_side_}};
}

double PictureResiduals::clustering(std::span<const double> residuals,
                                    const std::vector<bool>& outliers) const {
    constexpr int k_blocks_across = 5;
    const int side = std::max(1, width_ / k_blocks_across);
    // Sums by picture, block and colour: for independent residuals the expected square of a sum is
    // the sum of the squares.
    std::map<std::array<std::size_t, 4>, double> sums;
    double squares = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        if (outliers[i]) continue;
        for (std::size_t k = 0; k < colours_; ++k) {
            const double residual = residuals[i * colours_ + k];
            sums[{cells_[i].picture, static_cast<std::size_t>(cells_[i].x / side),
                  static_cast<std::size_t>(cells_[i].y / side), k}] += residual;
            squares += residual * residual;
        }
    }
    double of_blocks = 0;
    for (const auto& [block, sum] : sums) of_blocks += sum * sum;
    return squares > 0 ? std::max(1.0, of_blocks / squares) : 1;
}

double PictureResiduals::relative_rms(const FitResult& result) const {
    double squares = 0, sum = 0, count = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        if (result.outliers[i]) continue;
        for (std::size_t k = 0; k < colours_; ++k) {
            const double residual = result.residuals[i * colours_ + k] * cells_[i].error[k];
            squares += residual * residual;
            sum += cells_[i].mean[k];
            count += 1;
        }
    }
    return sum > 0 ? std::sqrt(squares / count) / (sum / count) : 0;
}

PictureResiduals::Comparison PictureResiduals::comparison(std::size_t picture) const {
    constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
    Comparison comparison{width_, height_, {}, {}};
    const auto size = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    comparison.seen.assign(size, {k_none, k_none, k_none});
    comparison.predicted = comparison.seen;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        const Cell& cell = cells_[i];
        if (cell.picture != picture) continue;
        const auto index = static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(width_) +
                           static_cast<std::size_t>(cell.x);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t colour = std::min(k, colours_ - 1);
            comparison.seen[index][k] = cell.mean[colour];
            comparison.predicted[index][k] = seen(i, light_[i][colour]).value;
        }
    }
    return comparison;
}

}  // namespace uw
