#include "fit/picture_residuals.h"

#include <fmt/format.h>

#include <algorithm>
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
#include "core/image/image_file.h"
#include "core/light/integrator_table.h"
#include "core/scene/pose_file.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

bool has_all_light(const SceneDesc& scene) {
    return scattering_of(scene.render) == RenderDesc::Scattering::multiple;
}

/// What a prediction may be off by for reasons of its own: shadows and tables are exact to about
/// 1e-3 at a scene's usual quality, and light that is scattered more than once, which is found by
/// random paths, to 1e-2.
double model_error(const SceneDesc& scene) {
    return has_all_light(scene) ? 1e-2 : 1e-3;
}

/// By how much of their scales unknowns are moved for derivatives, to either side. Light is
/// interpolated, so that smaller steps would measure the tables; of larger ones central differences
/// are off by the square. Random paths are the same ones on both sides but for where they end,
/// which smaller steps would measure.
double step_of(const SceneDesc& scene) {
    return has_all_light(scene) ? 1e-1 : 1e-2;
}

void refuse_developed(const SensorDesc& sensor) {
    if (sensor.image.is_raw) return;
    throw InputError(fmt::format(
        "{}: its images are developed, and raw numbers are compared; take camera.sensor.image "
        "out and give raw pictures, or take camera.sensor out and give pictures of light",
        sensor.where));
}

/// The number that a raw picture's values of 1 stand for: its bits are the uppermost of a byte or
/// of two [DN].
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
    /// From where on a pixel may be white, whatever it sees.
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

    /// The variance of a sensor's number around its mean `number`, as EMVA 1288 has it; none if it
    /// is not known.
    std::optional<double> variance(double number) const {
        if (!sensor_) return std::nullopt;
        const double gain = sensor_->system_gain();
        const double signal = std::max(0.0, number - sensor_->black_level);
        const double shot = sensor_->shot_noise ? gain * signal : 0;
        const double dark = std::hypot(sensor_->read_noise, sensor_->dsnu) * gain;
        constexpr double k_rounding = 1.0 / 12;
        return shot + dark * dark + std::pow(sensor_->prnu * signal, 2) + k_rounding;
    }

  private:
    PixelImage image_;
    const std::optional<SensorDesc>& sensor_;
};

/// What a sensor's raw numbers are in the mean, before they are rounded.
class MeanNumbers {
  public:
    /// `scene`: with the camera's full resolution.
    explicit MeanNumbers(const SceneDesc& scene)
        : electrons_(scene), sensor_(*scene.camera.sensor) {}

    double at(const Spectrum& irradiance, std::size_t colour) const {
        double electrons =
            electrons_.mean(irradiance, colour) + sensor_.dark_current * sensor_.exposure.value();
        if (sensor_.full_well) electrons = std::min(electrons, *sensor_.full_well);
        return sensor_.system_gain() * electrons + sensor_.black_level;
    }
    double factor(const LensRay& ray, double focus_vergence) const {
        return electrons_.irradiance_factor(ray, focus_vergence);
    }

  private:
    Photoelectrons electrons_;
    SensorDesc sensor_;
};

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
    if (scene.camera.sensor) {
        refuse_developed(*scene.camera.sensor);
        colours_ = colour_count(scene.camera.sensor->mosaic);
    }
    has_all_light_ = has_all_light(scene);
    model_error_ = model_error(scene);
    step_ = step_of(scene);
    width_ = std::min(cells, scene.camera.width);
    cell_side_ = static_cast<double>(scene.camera.width) / width_;
    height_ = std::max(1, static_cast<int>(std::lround(scene.camera.height / cell_side_)));
    for (std::size_t i = 0; i < files_.size(); ++i) {
        names_.push_back(files_[i].file.filename().string());
        renderers_.emplace_back();
        read(i, scene);
    }
    const std::size_t all =
        files_.size() * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    constexpr double k_least_share = 0.01;
    if (static_cast<double>(cells_.size()) < k_least_share * static_cast<double>(all))
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
    const double white = values.white();
    std::vector<std::optional<Cell>> found(static_cast<std::size_t>(width_) *
                                           static_cast<std::size_t>(height_));
    const auto edge = [](int index, int count, int pixels) {
        return static_cast<int>(std::lround(static_cast<double>(index) * pixels / count));
    };
    parallel_for(found.size(), [&](std::size_t index) {
        Cell cell{
            picture, static_cast<int>(index) % width_, static_cast<int>(index) / width_, {}, {}};
        const int x0 = edge(cell.x, width_, scene.camera.width),
                  x1 = edge(cell.x + 1, width_, scene.camera.width),
                  y0 = edge(cell.y, height_, scene.camera.height),
                  y1 = edge(cell.y + 1, height_, scene.camera.height);
        for (std::size_t k = 0; k < colours_; ++k) {
            double count = 0, sum = 0, squares = 0, least = 1e300, most = -1e300;
            for (int y = y0; y < y1; ++y)
                for (int x = x0; x < x1; ++x)
                    if (const std::optional<double> value = values.at(x, y, k)) {
                        if (!(*value < white) || !std::isfinite(*value)) return;
                        count += 1;
                        sum += *value;
                        squares += *value * *value;
                        least = std::min(least, *value);
                        most = std::max(most, *value);
                    }
            if (count == 0) return;
            cell.mean[k] = sum / count;
            double variance = most > least && count > 1
                                  ? std::max(0.0, (squares - sum * cell.mean[k]) / (count - 1))
                                  : 0;
            // Of few pixels the scatter is known badly: what scatters as noise does, is noise.
            constexpr double k_like_noise = 4;
            const std::optional<double> noise = values.variance(cell.mean[k]);
            if (noise && variance < k_like_noise * *noise) variance = *noise;
            cell.error[k] = std::sqrt(variance / count + std::pow(model_error_ * cell.mean[k], 2));
        }
        found[index] = cell;
    });
    double brightest = 0;
    for (const std::optional<Cell>& cell : found)
        if (cell) brightest = std::max(brightest, *std::ranges::max_element(cell->mean));
    for (std::optional<Cell>& cell : found) {
        if (!cell || !(brightest > 0)) continue;
        // Where all is dark, nothing is known to better than what the bright parts are known to.
        for (double& error : cell->error) error = std::hypot(error, 0.1 * model_error_ * brightest);
        cells_.push_back(*cell);
    }
}

PictureResiduals::Prediction PictureResiduals::predict(std::span<const double> values,
                                                       Light light) {
    SceneDesc scene = unknowns_.scene(values);
    if (light == Light::scattered_once && has_all_light(scene)) {
        scene.render.integrator = RenderDesc::Integrator::volume;
        scene.render.scattering = RenderDesc::Scattering::single;
    }
    Prediction prediction(cells_.size());
    std::size_t next = 0;
    for (std::size_t picture = 0; picture < files_.size(); ++picture) {
        throw_if_stopped();
        const ImageScene whole = scene_of_picture(scene, files_[picture]);
        Renderer& renderer = renderers_[picture];
        renderer.set_scene(
            whole.with([&](SceneDesc& desc) { resize_image(desc.camera, width_, height_); }));
        RenderOptions options;
        options.layers = "total";
        const Film& film = renderer.render(options);
        const LayerPlan plan = layer_plan(renderer.scene(), options.layers);
        std::optional<MeanNumbers> numbers;
        if (whole.desc().camera.sensor) numbers.emplace(whole.desc());
        const Camera camera(renderer.scene().desc().camera);
        for (; next < cells_.size() && cells_[next].picture == picture; ++next) {
            const Cell& cell = cells_[next];
            const std::span<const float> pixel = film.pixel(cell.x, cell.y);
            Colours& colours = prediction[next];
            if (numbers) {
                const double factor = numbers->factor(camera.lens_ray(cell.x + 0.5, cell.y + 0.5),
                                                      camera.focus_vergence());
                // Three bands are red, green and blue themselves.
                const std::size_t first =
                    plan.has(Layer::total)
                        ? static_cast<std::size_t>(plan.first_channel(Layer::total))
                        : k_red;
                Spectrum irradiance;
                for (std::size_t b = 0; b < plan.band_count(); ++b)
                    irradiance[b] = factor * double{pixel[first + b]};
                for (std::size_t k = 0; k < colours_; ++k) colours[k] = numbers->at(irradiance, k);
            } else if (colours_ == 1) {
                colours[0] = (double{pixel[0]} + double{pixel[1]} + double{pixel[2]}) / 3;
            } else {
                for (std::size_t k = 0; k < colours_; ++k) colours[k] = double{pixel[k]};
            }
        }
    }
    return prediction;
}

void PictureResiduals::group_unknowns(std::span<const double> shared) {
    moved_.resize(shared.size());
    std::vector<std::array<bool, 3>> taken;  // per group
    // Where light is scattered once, what does not depend on an unknown stays the same to the bit.
    const Prediction before = predict(shared, Light::scattered_once);
    for (std::size_t i = 0; i < shared.size(); ++i) {
        std::vector<double> values(shared.begin(), shared.end());
        const SceneUnknown& unknown = unknowns_.all()[i];
        const double step = step_ * unknown.scale;
        values[i] = values[i] + step <= unknown.upper ? values[i] + step : values[i] - step;
        const Prediction after = predict(values, Light::scattered_once);
        std::array<bool, 3>& colours = moved_[i].colours;
        for (std::size_t k = 0; k < colours.size(); ++k)
            colours[k] = !std::ranges::equal(
                before, after, {}, [&](const Colours& a) { return a[k]; },
                [&](const Colours& a) { return a[k]; });
        // Only what is scattered again may depend on it.
        if (std::ranges::none_of(colours, [](bool depends) { return depends; }))
            colours = {true, true, true};
        const auto overlaps = [&](const std::array<bool, 3>& other) {
            for (std::size_t k = 0; k < other.size(); ++k)
                if (other[k] && colours[k]) return true;
            return false;
        };
        const auto place = std::ranges::find_if_not(taken, overlaps);
        moved_[i].group = static_cast<std::size_t>(place - taken.begin());
        if (place == taken.end()) {
            taken.push_back(colours);
            together_.push_back({{i}, {}, {}});
            continue;
        }
        for (std::size_t k = 0; k < colours.size(); ++k)
            if (colours[k]) (*place)[k] = true;
        together_[moved_[i].group].unknowns.push_back(i);
    }
}

void PictureResiduals::take_derivatives(std::span<const double> shared) {
    if (moved_.empty()) group_unknowns(shared);
    derivatives_at_.clear();
    for (Together& group : together_) {
        std::vector<double> back(shared.begin(), shared.end()), ahead = back;
        for (const std::size_t i : group.unknowns) {
            const SceneUnknown& unknown = unknowns_.all()[i];
            back[i] = std::max(shared[i] - step_ * unknown.scale, unknown.lower);
            ahead[i] = std::min(shared[i] + step_ * unknown.scale, unknown.upper);
            moved_[i].step = ahead[i] - back[i];
        }
        group.back = predict(back, Light::of_the_scene);
        group.ahead = predict(ahead, Light::of_the_scene);
    }
    derivatives_at_.assign(shared.begin(), shared.end());
}

bool PictureResiduals::has_derivatives_near(std::span<const double> shared) const {
    if (derivatives_at_.empty()) return false;
    for (std::size_t i = 0; i < shared.size(); ++i)
        if (std::abs(shared[i] - derivatives_at_[i]) > step_ * unknowns_.all()[i].scale)
            return false;
    return true;
}

bool PictureResiduals::prepare(std::span<const double> shared, bool with_derivatives) {
    try {
        if (!std::ranges::equal(shared, prepared_)) {
            prepared_.clear();
            prediction_ = predict(shared, Light::of_the_scene);
            prepared_.assign(shared.begin(), shared.end());
        }
        if (with_derivatives && !has_derivatives_near(shared)) take_derivatives(shared);
        return true;
    } catch (const InputError&) {
        prepared_.clear();
        return false;  // no such scene: the solver takes a smaller step
    }
}

bool PictureResiduals::evaluate(std::size_t group, const Block* /*block*/, double* residuals,
                                double* by_shared, double* /*by_block*/) const {
    const Cell& cell = cells_[group];
    for (std::size_t k = 0; k < colours_; ++k) {
        const double error = cell.error[k] * deviation();
        residuals[k] = (prediction_[group][k] - cell.mean[k]) / error;
        if (by_shared == nullptr) continue;
        for (std::size_t i = 0; i < moved_.size(); ++i) {
            const Together& moved = together_[moved_[i].group];
            by_shared[k * moved_.size() + i] =
                moved_[i].colours[k]
                    ? (moved.ahead[group][k] - moved.back[group][k]) / (moved_[i].step * error)
                    : 0;
        }
    }
    return true;
}

std::vector<ResidualGroup> PictureResiduals::groups() const {
    return std::vector<ResidualGroup>(cells_.size(), {static_cast<int>(colours_)});
}

Observations::Place PictureResiduals::place(std::size_t group) const {
    const Cell& cell = cells_[group];
    return {cell.picture, {(cell.x + 0.5) * cell_side_, (cell.y + 0.5) * cell_side_}};
}

double PictureResiduals::convergence() const {
    return has_all_light_ ? 1e-4 : Observations::convergence();
}

double PictureResiduals::clustering(std::span<const double> residuals,
                                    const std::vector<bool>& outliers) const {
    constexpr int k_blocks_across = 5;
    const int side = std::max(1, width_ / k_blocks_across);
    // By picture, block and colour; of independent residuals the square of a sum is, in the mean,
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
            comparison.predicted[index][k] = prediction_[i][colour];
        }
    }
    return comparison;
}

}  // namespace uw
