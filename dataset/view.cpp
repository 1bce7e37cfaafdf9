#include "dataset/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/spectrum.h"
#include "core/image/colour.h"
#include "core/image/image_file.h"
#include "core/image/picture_file.h"
#include "core/image/pixel_image.h"
#include "dataset/camera_json.h"
#include "dataset/set_files.h"

namespace uw {

namespace {

constexpr std::string_view k_image_role = "image";

void write_new_image(const ViewImages& images, const std::filesystem::path& file) {
    if (images.sensor)
        write_png(file, *images.sensor, images.metadata);
    else
        write_picture_of(images, images.film, images.exposures.image, file);
}

}  // namespace

void write_picture_of(const ViewImages& images, const Film& film, double exposure,
                      const std::filesystem::path& file) {
    OutputFile out(file);
    write_picture(out, film, {exposure, images.definition.is_16_bit ? 16 : 8, images.display.get()},
                  images.metadata);
    out.commit();
}

bool ViewImages::has_values(Layer layer) const {
    for (int y = 0; y < height(); ++y) {
        throw_if_stopped();
        for (int x = 0; x < width(); ++x)
            if (std::isfinite(at(layer, x, y).front())) return true;
    }
    return false;
}

void write_image(const ViewImages& images, SetFiles& files, const std::string& role,
                 const std::string& path) {
    // All roles but this one's are copies in the folders of other formats.
    const auto written = std::ranges::find_if(
        files.written(), [](const SetFile& file) { return file.role.starts_with(k_image_role); });
    if (written != files.written().end()) {
        const std::string from = written->path;
        files.add_copy(role, path, from);
        return;
    }
    files.add(role, path,
              [&](const std::filesystem::path& file) { write_new_image(images, file); });
}

void write_depth(const ViewImages& images, SetFiles& files, const std::string& role,
                 const std::string& path, double scale) {
    constexpr double k_most = 65535;
    DigitalImage depth{images.width(), images.height(), 1, 16, false, {}};
    depth.values.reserve(depth.row_values() * static_cast<std::size_t>(depth.height));
    const double far = images.definition.depth_far.value_or(HUGE_VAL);
    double nearest = HUGE_VAL, farthest = 0;
    images.for_each_pixel([&](int x, int y) {
        const double z = images.at(Layer::depth, x, y).front();
        const bool is_seen = z > 0 && z <= far;
        if (is_seen) {
            nearest = std::min(nearest, z);
            farthest = std::max(farthest, z);
        }
        const double value = is_seen ? std::min(std::round(z * scale), k_most) : 0;
        depth.values.push_back(static_cast<std::uint16_t>(value));
    });
    if (std::round(farthest * scale) > k_most || std::round(nearest * scale) < 1)
        throw InputError(fmt::format(
            "{}: depths of {:.4g} to {:.4g} m do not fit into 16 bits at {:g} per metre, which "
            "hold {:.3g} to {:.4g} m; give another --depth-scale where the format leaves the "
            "choice, or --depth-far {:.4g} to leave out what is beyond",
            path, nearest, farthest, scale, 0.5 / scale, k_most / scale, k_most / scale));
    files.add(role, path, [&](const std::filesystem::path& file) {
        write_png(file, depth, {{"depth_per_metre", scale}});
    });
}

Film clean_film(const Film& film, const LayerPlan& plan, const ColourDesc& colour,
                std::span<const double> bands_nm) {
    const BandColour rgb_of = make_band_colour(colour, bands_nm);
    const auto first = static_cast<std::size_t>(plan.first_channel(Layer::clean));
    Film clean(film.width(), film.height(), film.window(), {"R", "G", "B", "A"});
    Spectrum radiance{};
    for (int y = 0; y < film.height(); ++y) {
        throw_if_stopped();
        for (int x = 0; x < film.width(); ++x) {
            const std::span<const float> pixel = film.pixel(x, y);
            std::ranges::copy(pixel.subspan(first, bands_nm.size()), radiance.begin());
            const std::span<float> out = clean.pixel(x, y);
            std::ranges::transform(rgb_of(radiance), out.begin(),
                                   [](double v) { return static_cast<float>(v); });
            out[k_alpha] = pixel[k_alpha];
        }
    }
    return clean;
}

const SetFile* ViewRecord::file(std::string_view role) const {
    const auto found = std::ranges::find(files, role, &SetFile::role);
    return found == files.end() ? nullptr : &*found;
}

bool ViewRecord::has_all_files(const std::filesystem::path& folder, bool by_content) const {
    const auto are_whole = [&](const std::vector<SetFile>& list) {
        return std::ranges::all_of(
            list, [&](const SetFile& file) { return is_whole(folder, file, by_content); });
    };
    return are_whole(shared) && are_whole(files);
}

std::string sum_of(const DatasetDefinition& definition) {
    return sha256_of(definition_json(definition).dump());
}

std::string record_file(const DatasetDefinition& definition, const View& view) {
    return definition.file(view, "views", ".json");
}

namespace {

/// The number of the view's frame; null if the set has no frames.
Json frame_json(const DatasetDefinition& definition, const View& view) {
    const std::optional<int> number = definition.frames[view.frame];
    return number ? Json(*number) : Json(nullptr);
}

}  // namespace

std::string record_text(const DatasetDefinition& definition, const ViewRecord& record) {
    const auto list = [](const std::vector<SetFile>& files) {
        Json all = Json::array();
        for (const SetFile& file : files) all.push_back(set_file_json(file));
        return all;
    };
    const View& v = record.view;
    return json_text({{"set", record.set},
                      {"draw", v.draw},
                      {"frame", frame_json(definition, v)},
                      {"camera", v.camera},
                      {"time", record.time},
                      {"stamp_ns", record.stamp},
                      {"view", camera_json(record.camera)},
                      {"inputs", record.inputs},
                      {"shared", list(record.shared)},
                      {"files", list(record.files)}});
}

std::optional<ViewRecord> read_record(const std::filesystem::path& folder,
                                      const DatasetDefinition& definition, const std::string& sum,
                                      const View& view) {
    std::ifstream in = open_own_file(folder / record_file(definition, view));
    if (!in) return std::nullopt;
    try {
        const Json json = Json::parse(in);
        ViewRecord record;
        json.at("set").get_to(record.set);
        record.view = {json.at("draw").get<std::size_t>(), view.frame,
                       json.at("camera").get<std::size_t>()};
        json.at("time").get_to(record.time);
        json.at("stamp_ns").get_to(record.stamp);
        record.camera = camera_from_json(json.at("view"));
        json.at("inputs").get_to(record.inputs);
        for (const Json& file : json.at("shared"))
            record.shared.push_back(set_file_from_json(file));
        for (const Json& file : json.at("files")) record.files.push_back(set_file_from_json(file));
        if (record.set != sum || record.view != view ||
            json.at("frame") != frame_json(definition, view))
            return std::nullopt;
        return record;
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

}  // namespace uw
