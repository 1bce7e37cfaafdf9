#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene/scene_desc.h"
#include "core/scene/trajectory.h"
#include "fit/robust_fit.h"
#include "fit/unknowns.h"
#include "render/renderer.h"

namespace uw {

/// Photographs of which a scene predicts the light.

/// A picture, and the image of the scene that it shows.
struct ObservedPicture {
    std::filesystem::path file;
    ImageChoice choice;
    /// Replaces the scene's, before the `transform` of its camera's trajectory, if it has one.
    std::optional<Pose> world_from_camera{};
};

/// The pictures that a name denotes: a file, or, with a pattern for the frame's number
/// ("dive/%04d.png"), those of all frames. Throws IoError if there are none.
std::vector<ObservedPicture> pictures_called(const std::filesystem::path& name);

/// The difference between the light that a scene predicts and that of pictures. Each picture is
/// divided into cells, squares of whole pixels; a group is the mean over a cell in each of its
/// colours, and the residual is in units of the standard error of that mean: from the scatter of
/// the cell's pixels, which is great at edges (or, if it is no more than that, from the noise of
/// the scene's sensor), and a thousandth of the light.
///
/// The prediction for a cell is the light over exactly its pixels: a cell is a pixel, or several,
/// of a coarser image. For a mosaic its side is odd, so that the pixels of every colour are centred
/// in the cell.
///
/// Scenes with a sensor predict its numbers as they are stored raw, from which the sensor's black
/// level, gain, mosaic and efficiencies follow; other scenes red, green and blue, of pictures with
/// linear values as they are, of others by the sRGB curve. Cells in which a pixel is white, masked
/// by its alpha or without a ray into the water are left out. Unknown exposures multiply the light
/// of each picture, and an unknown response is the power to which that is raised: 1 where a
/// camera's curve is sRGB's.
class PictureResiduals final : public Observations {
  public:
    /// `cells`: about how many lie across a picture's width. `unknowns` outlive it. Throws
    /// InputError for pictures that are not of the scene's resolution or have nothing to see, and
    /// for a sensor whose image is developed; and throws as read_image and Renderer.
    PictureResiduals(const SceneUnknowns& unknowns, std::vector<ObservedPicture> files, int cells);

    bool prepare(std::span<const double> shared, bool with_derivatives) override;
    bool evaluate(std::size_t group, const Block* block, double* residuals, double* by_shared,
                  double* by_block) const override;
    std::vector<ResidualGroup> groups() const override;
    std::size_t block_count() const override { return 0; }

    const std::vector<std::string>& images() const override { return names_; }
    Place place(std::size_t group) const override;
    const char* noun() const override { return "cell"; }
    const char* unit() const override { return "times the scatter"; }
    double of_group(double rms) const override { return rms; }
    bool is_rough() const override { return has_all_light_; }
    void weigh(Weights by) override;
    /// Computed from the means over blocks of cells, five across a picture: it covers the errors
    /// that cells have in common, such as those of light that is interpolated between nodes.
    double clustering(std::span<const double> residuals,
                      const std::vector<bool>& outliers) const override;

    /// The exposures by which the light of the scene with these unknowns has to be multiplied to be
    /// as bright as each picture.
    std::vector<double> exposures_at(std::span<const double> shared);

    /// The RMS of prediction less observation over the mean of what was observed, for the cells
    /// that `result` keeps.
    double relative_rms(const FitResult& result) const;

    /// A picture as observed, and as predicted by the scene that was prepared last, by cells.
    struct Comparison {
        int width = 0, height = 0;
        std::vector<std::array<double, 3>> seen, predicted;  // NaN: left out
    };
    Comparison comparison(std::size_t picture) const;
    std::size_t colours() const { return colours_; }

  private:
    /// The mean of a cell, by colour; grey ones have one.
    using Colours = std::array<double, 3>;
    struct Cell {
        std::size_t picture = 0;
        int x = 0, y = 0;  // in the divided picture
        Colours mean{}, error{};
        /// The number of pixels if their scatter is no more than the sensor's noise; else 0, and
        /// the variance of the mean by their scatter.
        Colours noisy_pixels{}, scatter{};
    };
    using Prediction = std::vector<Colours>;  // of each cell

    /// Which light: all that the scene has, or, which takes far less time, that scattered once.
    enum class Light : std::uint8_t { of_the_scene, scattered_once };

    void read(std::size_t picture, const SceneDesc& scene);
    /// Makes the camera's image one of the cells, each of side x side pixels.
    void show_cells(SceneDesc& scene, int side) const;
    Prediction predict(std::span<const double> values, Light light);
    /// Predicts the cells of one picture.
    void predict(std::size_t picture, const SceneDesc& scene, Light light, Prediction& prediction);
    /// An unknown decreased and increased by its step, within its limits, from the values of
    /// shared_.
    struct SceneStep {
        std::size_t unknown = 0;
        SceneDesc back, ahead;
        double size = 0;  // from one to the other
    };
    SceneStep change_by(std::size_t unknown) const;
    /// The unknown's value in shared_, so many steps on but within its limits.
    double moved(std::size_t unknown, double steps) const;
    /// The image of a picture's cells, a pixel each.
    ImageScene coarse_image(std::size_t picture, const SceneDesc& scene) const;
    /// Fills by_unknown_ for the cells of a picture from the renderer's derivatives. Throws as
    /// scene_derivatives.
    void differentiate(std::size_t picture, std::span<const SceneStep> steps);
    /// Whether the renderer differentiates by an unknown, and its derivatives explain what the step
    /// changes, as seen in one of the pictures.
    bool is_differentiable(const SceneStep& step);
    /// Decides by which unknowns the renderer differentiates, and which of the others are moved
    /// together.
    void choose_derivatives();
    void take_derivatives();
    /// Whether scenes are within this many steps of each other.
    bool is_near(std::span<const double> shared, std::span<const double> other, double steps) const;
    /// The value of a cell for the light that the scene predicts, and its derivatives.
    struct Seen {
        double value = 0, by_light = 0, by_exposure = 0, by_power = 0;
    };
    Seen seen(std::size_t cell, double light) const;

    const SceneUnknowns& unknowns_;
    std::vector<ObservedPicture> files_;
    std::vector<std::string> names_;
    int width_ = 0, height_ = 0;  // of pictures, in cells
    int cell_side_ = 1;           // [pixels]
    int left_ = 0, top_ = 0;      // pixels before the first cell
    std::size_t colours_ = 3;
    std::optional<SensorDesc> sensor_;  // as the fit begins
    std::vector<Cell> cells_;
    std::vector<std::size_t> first_cell_;  // of each picture, and behind the last
    std::vector<double> brightest_;        // mean of a cell, per picture
    std::deque<Renderer> renderers_;       // one per picture, which keeps what does not change
    bool has_all_light_ = false;
    int pixels_per_side_ = 1;  // rendered of a cell
    double model_error_ = 0;
    std::vector<double> steps_;            // per unknown, of derivatives
    std::vector<std::size_t> exposures_;   // the unknowns that are those of pictures; or none
    std::optional<std::size_t> response_;  // the unknown that is it
    double dark_ = 0;                      // the signal without light
    std::vector<double> shared_;           // the unknowns as they were prepared last
    Prediction light_;                     // of the scene
    std::vector<double> light_of_;         // for which unknowns; empty: none
    /// The unknowns at which derivatives were taken; empty: not yet. They serve within a step to
    /// either side.
    std::vector<double> derivatives_at_;
    bool has_chosen_ = false;                  // how derivatives are taken
    std::vector<Prediction> by_unknown_;       // the derivatives of each cell's light
    std::vector<std::size_t> differentiated_;  // the unknowns by which the renderer does it
    /// Unknowns that are moved together for central differences, one for each colour, as no colour
    /// depends on two of them: those of bands. An unknown may have several colours.
    struct Together {
        std::array<std::optional<std::size_t>, 3> of_colour{};
    };
    std::vector<Together> together_;
};

}  // namespace uw
