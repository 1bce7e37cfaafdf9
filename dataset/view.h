#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/geometry/surfaces.h"
#include "core/image/colour_view.h"
#include "core/image/film.h"
#include "core/image/layers.h"
#include "core/image/pixel_image.h"
#include "core/scene/camera_desc.h"
#include "core/scene/render_desc.h"
#include "core/scene/scene_desc.h"
#include "dataset/definition.h"
#include "dataset/set_files.h"

namespace uw {

/// A point of a static surface, by which cameras of a set can be related.
struct Landmark {
    Point3 position;  // world
};

/// The checksums (SHA-256) of the files that a view was rendered from, by their names relative to
/// the scene's folder. Files that are part of the scene's own hash are not among them.
using InputSums = std::map<std::string, std::string>;

/// A view that has been rendered, of which formats write files.
struct ViewImages {
    const DatasetDefinition& definition;
    View view;
    double time = 0;         // of the scene [s]
    std::int64_t stamp = 0;  // of the clock that its poses have (FrameStamps) [ns]
    CameraDesc camera;       // with its pose
    ColourDesc colour;       // how bands become R G B
    std::vector<double> bands_nm;
    Film film;
    LayerPlan plan;                      // of the film
    std::optional<DigitalImage> sensor;  // the camera's own image
    Exposures exposures;
    std::shared_ptr<const ColourView> display;  // the view of pictures; null: sRGB
    ImageMetadata metadata;
    std::shared_ptr<const Surfaces> surfaces;
    std::shared_ptr<const std::vector<Landmark>> points;  // null: no format needs them
    InputSums inputs;
    std::vector<SetFile> shared;  // see ViewRecord

    int width() const { return film.width(); }
    int height() const { return film.height(); }
    bool has(Layer layer) const { return plan.has(layer); }
    /// A layer's values at a pixel. Precondition: has(layer).
    std::span<const float> at(Layer layer, int x, int y) const {
        return film.pixel(x, y).subspan(static_cast<std::size_t>(plan.first_channel(layer)));
    }

    /// Calls `visit(x, y)` for every pixel, row by row from the top. Throws Interrupted.
    template <class Visit>
    void for_each_pixel(const Visit& visit) const {
        for (int y = 0; y < height(); ++y) {
            throw_if_stopped();
            for (int x = 0; x < width(); ++x) visit(x, y);
        }
    }

    /// Whether any of a layer's values is a number: a frame without a next one has no flow.
    bool has_values(Layer layer) const;
};

/// Writes a PNG of `film` at an exposure, of the set's bits and through the scene's view.
void write_picture_of(const ViewImages& images, const Film& film, double exposure,
                      const std::filesystem::path& file);

/// Writes the view's image as a PNG: the camera's own if it has a sensor, else R G B times the
/// exposure as sRGB, of 8 or 16 bits. It is encoded once, for the first of its files.
void write_image(const ViewImages& images, SetFiles& files, const std::string& role,
                 const std::string& path);

/// Writes the surfaces' distance along the camera's axis as a PNG of 16 bits: times `scale` [1/m],
/// rounded; 0 where there is no surface or it is beyond DatasetDefinition::depth_far. Throws
/// InputError for a distance that does not fit into 16 bits.
void write_depth(const ViewImages& images, SetFiles& files, const std::string& role,
                 const std::string& path, double scale);

/// The layer `clean` of a film as an image of its own, in the image's colours. Precondition: the
/// film, whose layers are `plan`, has it. Throws as make_band_colour.
Film clean_film(const Film& film, const LayerPlan& plan, const ColourDesc& colour,
                std::span<const double> bands_nm);

/// The record of a view that has been written: everything from which the tables of cameras, poses
/// and files are made. Its file is written last, so that a view which has one is complete.
struct ViewRecord {
    View view;
    std::string set;         // the sum of the definition (sum_of)
    double time = 0;         // as ViewImages::time
    std::int64_t stamp = 0;  // likewise
    CameraDesc camera;       // resolution, intrinsics, distortion, port, pose: no more of it
    InputSums inputs;
    /// Files from which the view was made and which the views of a draw share: surface points,
    /// pinholes.
    std::vector<SetFile> shared;
    std::vector<SetFile> files;

    /// The file with a role; null if there is none.
    const SetFile* file(std::string_view role) const;
    /// Whether its own and its shared files are whole (is_whole).
    bool has_all_files(const std::filesystem::path& folder, bool by_content) const;
};

/// The sum by which records know their set.
std::string sum_of(const DatasetDefinition& definition);

/// The name of a view's record, relative to the set's folder.
std::string record_file(const DatasetDefinition& definition, const View& view);

std::string record_text(const DatasetDefinition& definition, const ViewRecord& record);

/// The record of a view in the set's folder; none if there is none, or it is damaged or of another
/// set than that with this sum.
std::optional<ViewRecord> read_record(const std::filesystem::path& folder,
                                      const DatasetDefinition& definition, const std::string& sum,
                                      const View& view);

}  // namespace uw
