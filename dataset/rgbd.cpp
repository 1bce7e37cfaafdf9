#include "dataset/rgbd.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include "camera/calibration.h"
#include "camera/camera.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/text.h"
#include "core/image/exr_file.h"
#include "core/image/image_file.h"
#include "core/image/png_file.h"

namespace uw {

namespace fs = std::filesystem;

namespace {

bool begins_with(std::span<const std::byte> bytes, std::string_view magic) {
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(), [](char a, std::byte b) {
               return static_cast<unsigned char>(a) == std::to_integer<unsigned>(b);
           });
}
bool is_png(std::span<const std::byte> bytes) {
    return begins_with(bytes, "\x89PNG");
}
bool is_jpeg(std::span<const std::byte> bytes) {
    return begins_with(bytes, "\xff\xd8\xff");
}
bool is_exr(std::span<const std::byte> bytes) {
    return begins_with(bytes, "\x76\x2f\x31\x01");
}

/// An image of depths as the file has it, with what the file says of it.
struct RawDepth {
    PixelImage image;
    double per_value = 1;  // the file's units per value of the image
    bool is_whole = false;
    std::optional<DepthKind> kind;
};

std::string chosen_channel(const fs::path& file, const std::string& wanted,
                           const std::vector<std::string>& channels) {
    const auto has = [&](std::string_view name) {
        return std::ranges::find(channels, name) != channels.end();
    };
    if (!wanted.empty()) {
        if (has(wanted)) return wanted;
        const std::vector<std::string_view> words(channels.begin(), channels.end());
        throw InputError(fmt::format("{}: --channel {}: there is no such channel; {}",
                                     file.string(), printable(wanted), suggestion(wanted, words)));
    }
    for (const char* known : {"depth.Z", "range.V"})
        if (has(known)) return known;
    if (channels.size() == 1) return channels.front();
    for (const char* usual : {"Z", "Y", "R"})
        if (has(usual)) return usual;
    throw InputError(
        fmt::format("{}: none of its channels is known to hold depths; name one of "
                    "them with --channel: {}",
                    file.string(),
                    alternatives(std::vector<std::string_view>(channels.begin(), channels.end()))));
}

RawDepth read_raw_depth(const fs::path& file, const std::string& channel) {
    const std::vector<std::byte> bytes = read_image_bytes(file);
    RawDepth raw;
    if (is_exr(bytes)) {
        raw.image = read_exr_channel(bytes, file.string(), [&](const auto& channels) {
            const std::string chosen = chosen_channel(file, channel, channels);
            if (chosen == "depth.Z") raw.kind = DepthKind::z;
            if (chosen == "range.V") raw.kind = DepthKind::range;
            return chosen;
        });
        return raw;
    }
    if (!channel.empty())
        throw UsageError(
            fmt::format("--channel: {} is no OpenEXR; leave the option out", file.string()));
    if (is_jpeg(bytes))
        throw InputError(file.string() +
                         ": a JPEG keeps no depths; give the PNG or OpenEXR that the camera or "
                         "data set has");
    if (is_png(bytes)) {
        const std::optional<PngHeader> header = read_png_header(file);
        raw.image = read_png(bytes, file.string());
        raw.per_value = header && header->bits == 16 ? 65535 : 255;
        raw.is_whole = true;
    } else {
        raw.image = read_linear_image(file);
    }
    if (raw.image.channels > 2)
        throw InputError(fmt::format(
            "{}: a picture in colour, where depths are expected: a grey PNG of 16 bits or an "
            "OpenEXR; are --image and --depth swapped?",
            file.string()));
    return raw;
}

DepthKind kind_of(const RawDepth& raw, const DepthReading& reading, const fs::path& file) {
    if (reading.kind) return *reading.kind;
    if (raw.kind) return *raw.kind;
    throw UsageError(
        fmt::format("--depth-kind: {} does not say what it holds; give z, depth along the optical "
                    "axis, as most "
                    "data sets have, range, distance from the camera's centre, or disparity",
                    file.string()));
}

double scale_of(const RawDepth& raw, const DepthReading& reading, const fs::path& file) {
    if (reading.scale) return *reading.scale;
    if (!raw.is_whole) return 1;
    throw UsageError(fmt::format(
        "--depth-scale: {} has whole numbers; give how many are a metre: tum (5000), kitti (256), "
        "nyu (1000) or a number",
        file.string()));
}

/// What is as far is none: what programs write where they see nothing.
constexpr double k_no_depth = 1e9;

}  // namespace

Grid2D<double> read_inverse_depth(const fs::path& file, const DepthReading& reading,
                                  const CameraDesc& camera_desc) {
    const RawDepth raw = read_raw_depth(file, reading.channel);
    const DepthKind kind = kind_of(raw, reading, file);
    if (kind == DepthKind::disparity && !reading.baseline)
        throw UsageError(
            "--baseline: disparities need the distance of the two cameras; give it in metres");
    const double units = raw.per_value / scale_of(raw, reading, file);
    if (raw.image.width != camera_desc.width || raw.image.height != camera_desc.height)
        throw InputError(fmt::format(
            "{}: the depths have {} x {} pixels, the picture {} x {}; give depths that are "
            "registered to the picture",
            file.string(), raw.image.width, raw.image.height, camera_desc.width,
            camera_desc.height));
    CameraDesc desc = camera_desc;
    desc.world_from_camera = Affine{};
    const Camera camera(desc);
    const double farthest = std::min(reading.farthest.value_or(k_no_depth), k_no_depth);
    Grid2D<double> inverse_depth(desc.width, desc.height);
    bool has_depth = false;
    for (int y = 0; y < desc.height; ++y) {
        throw_if_stopped();
        for (int x = 0; x < desc.width; ++x) {
            const std::size_t channels = static_cast<std::size_t>(raw.image.channels);
            const double stored = raw.image.pixels[inverse_depth.index(x, y) * channels];
            const double value = raw.is_whole
                                     ? std::round(stored * raw.per_value) / raw.per_value * units
                                     : stored * units;
            const auto direction = camera.lens_direction(x + 0.5, y + 0.5);
            if (!(value > 0) || !std::isfinite(value) || !direction || !(direction->z > 0))
                continue;
            double z = value;
            if (kind == DepthKind::range) z = value * direction->z;
            if (kind == DepthKind::disparity) z = desc.intrinsics.fx * *reading.baseline / value;
            if (!(z < k_no_depth) || z > farthest) continue;
            inverse_depth(x, y) = 1 / z;
            has_depth = true;
        }
    }
    if (!has_depth)
        throw InputError(fmt::format(
            "{}: no pixel has a depth{}; see whether it is the right file{}", file.string(),
            reading.farthest ? fmt::format(" of up to {:g} m", *reading.farthest) : "",
            reading.farthest ? ", and --depth-scale and --depth-far" : ""));
    return inverse_depth;
}

namespace {

bool is_picture_name(const fs::path& file) {
    const std::string ending = lower_case(file.extension().string());
    return std::ranges::any_of(std::array{".png", ".jpg", ".jpeg", ".exr", ".tif", ".tiff", ".hdr"},
                               [&](const char* known) { return ending == known; });
}

/// The images of a folder by name without ending.
std::map<std::string, fs::path> images_in(const fs::path& folder) {
    std::map<std::string, fs::path> found;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        const fs::path& file = at->path();
        if (!is_picture_name(file)) continue;
        const auto [other, is_new] = found.emplace(file.stem().string(), file);
        if (!is_new)
            throw InputError(fmt::format("{}: there is {} as well; leave one of them in the folder",
                                         file.string(), other->second.filename().string()));
    }
    if (error) throw IoError(folder.string() + ": cannot read the folder; check its permissions");
    if (found.empty())
        throw InputError(folder.string() +
                         ": the folder has no images; give one with PNG, JPEG or "
                         "OpenEXR files");
    return found;
}

/// The times that names are [s]; none if one is not.
std::optional<std::vector<std::pair<double, fs::path>>> times_of(
    const std::map<std::string, fs::path>& files) {
    std::vector<std::pair<double, fs::path>> times;
    for (const auto& [name, file] : files) {
        double time = 0;
        if (name.find('.') == std::string::npos || parse_number(name, time) != NumberText::number)
            return std::nullopt;
        times.emplace_back(time, file);
    }
    std::ranges::sort(times);
    return times;
}

/// As associate.py of TUM's benchmark: the nearest pairs first, each image in one of them.
std::vector<RgbdPair> pairs_by_time(const std::vector<std::pair<double, fs::path>>& pictures,
                                    const std::vector<std::pair<double, fs::path>>& depths) {
    constexpr double k_longest = 0.02;  // [s], the script's
    struct Candidate {
        double apart;
        std::size_t picture, depth;
    };
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < pictures.size(); ++i)
        for (std::size_t k = 0; k < depths.size(); ++k) {
            const double apart = std::abs(pictures[i].first - depths[k].first);
            if (apart < k_longest) candidates.push_back({apart, i, k});
        }
    std::ranges::stable_sort(candidates, {}, &Candidate::apart);
    std::vector<std::optional<std::size_t>> depth_of(pictures.size());
    std::vector<bool> taken(depths.size());
    for (const Candidate& c : candidates)
        if (!depth_of[c.picture] && !taken[c.depth]) {
            depth_of[c.picture] = c.depth;
            taken[c.depth] = true;
        }
    std::vector<RgbdPair> pairs;
    for (std::size_t i = 0; i < pictures.size(); ++i)
        if (depth_of[i]) pairs.push_back({pictures[i].second, depths[*depth_of[i]].second});
    return pairs;
}

}  // namespace

std::vector<RgbdPair> rgbd_pairs(const fs::path& pictures, const fs::path& depths) {
    const bool is_folder = fs::is_directory(pictures);
    if (is_folder != fs::is_directory(depths))
        throw UsageError("--depth: --image and --depth are two files or two folders");
    if (!is_folder) return {{pictures, depths}};
    const std::map<std::string, fs::path> by_name = images_in(pictures);
    const std::map<std::string, fs::path> depth_by_name = images_in(depths);
    const auto lacks_depth = [&](const auto& entry) {
        return !depth_by_name.contains(entry.first);
    };
    const auto lacking = std::ranges::find_if(by_name, lacks_depth);
    if (lacking == by_name.end()) {
        std::vector<RgbdPair> pairs;
        for (const auto& [name, file] : by_name) pairs.push_back({file, depth_by_name.at(name)});
        return pairs;
    }
    const auto times = times_of(by_name), depth_times = times_of(depth_by_name);
    if (times && depth_times)
        if (const auto pairs = pairs_by_time(*times, *depth_times); !pairs.empty()) return pairs;
    throw InputError(fmt::format(
        "{}: no image in {} has the same name, or a time within 0.02 s; name pairs alike, or take "
        "the picture away",
        lacking->second.string(), depths.string()));
}

DepthHoles find_holes(const Grid2D<double>& inverse_depth) {
    DepthHoles holes;
    Grid2D<std::uint8_t> seen(inverse_depth.width(), inverse_depth.height());
    std::size_t most = 0;
    std::vector<std::array<int, 2>> open;
    for (int y = 0; y < seen.height(); ++y)
        for (int x = 0; x < seen.width(); ++x) {
            std::size_t pixels = 0;
            int left = x, right = x, bottom = y;
            const auto visit = [&](int i, int j) {
                if (i < 0 || j < 0 || i >= seen.width() || j >= seen.height() || seen(i, j) != 0 ||
                    inverse_depth(i, j) > 0)
                    return;
                seen(i, j) = 1;
                open.push_back({i, j});
            };
            visit(x, y);
            while (!open.empty()) {
                const auto [i, j] = open.back();
                open.pop_back();
                ++pixels;
                left = std::min(left, i);
                right = std::max(right, i);
                bottom = std::max(bottom, j);
                visit(i - 1, j);
                visit(i + 1, j);
                visit(i, j - 1);
                visit(i, j + 1);
            }
            if (pixels == 0) continue;
            ++holes.count;
            holes.pixels += pixels;
            if (pixels <= most) continue;
            most = pixels;
            holes.largest = {left, y, right - left + 1, bottom - y + 1};
        }
    return holes;
}

std::array<int, 2> picture_size(const fs::path& file) {
    const PixelImage image = read_image(file);
    return {image.width, image.height};
}

RgbdSurface read_rgbd(const RgbdPair& pair, const DepthReading& reading, const CameraDesc& camera,
                      const DepthMeshOptions& options) {
    RgbdSurface surface;
    surface.picture = read_image_bytes(pair.picture);
    if (is_png(surface.picture)) surface.picture_type = "image/png";
    if (is_jpeg(surface.picture)) surface.picture_type = "image/jpeg";
    if (is_exr(surface.picture)) surface.picture_type = "image/x-exr";
    if (surface.picture_type.empty())
        throw InputError(pair.picture.string() +
                         ": not a format that a mesh can contain; save the picture as PNG, JPEG or "
                         "OpenEXR");
    const PixelImage picture = read_image(surface.picture, pair.picture.string());
    if (picture.width != camera.width || picture.height != camera.height)
        throw InputError(fmt::format(
            "{}: the picture has {} x {} pixels, the camera {} x {}; give the intrinsics of that "
            "size",
            pair.picture.string(), picture.width, picture.height, camera.width, camera.height));
    const Grid2D<double> inverse_depth = read_inverse_depth(pair.depth, reading, camera);
    surface.holes = find_holes(inverse_depth);
    std::vector<double> known;
    std::ranges::copy_if(inverse_depth, std::back_inserter(known), [](double w) { return w > 0; });
    std::ranges::sort(known);
    surface.nearest = 1 / known.back();
    surface.median = 1 / known[known.size() / 2];
    surface.farthest = 1 / known.front();
    CameraDesc desc = camera;
    desc.world_from_camera = Affine{};
    const Camera lens(desc);
    surface.mesh = mesh_of_depth(
        inverse_depth,
        [&](double x, double y) -> std::optional<Vector3> {
            const auto direction = lens.lens_direction(x, y);
            if (!direction || !(direction->z > 0)) return std::nullopt;
            return Vector3(direction->x / direction->z, -direction->y / direction->z, -1);
        },
        options);
    return surface;
}

std::string rgbd_scene_text(const CameraDesc& camera, const std::string& mesh,
                            PictureMeaning meaning, double median) {
    std::string text = "uwvdb: 2\n" + write_calibration(CalibrationFormat::scene, camera);
    text += "  pose: {position: [0, 0, 0], look_at: [0, 0, -1], up: [0, 1, 0]}\n";
    text += "water:\n  preset: jerlov-II\n";
    text += "geometry:\n  - {file: " + Json(mesh).dump() + "}\n";
    if (meaning == PictureMeaning::emission) return text;
    // A white surface at the median depth, facing the camera, has about 1 W/m2/sr without water.
    const double intensity = 0.5 * std::numbers::pi * median * median;
    text += "lamps:                            # camera axes: x right, y down, z forward\n";
    for (const auto& [name, x] : {std::pair("left", -0.4), std::pair("right", 0.4)})
        text += fmt::format(
            "  - {{name: {}, position: [{}, -0.2, 0], profile: {{type: spot, beam: 110, edge: "
            "30}}, intensity: {:.2g}}}\n",
            name, x, intensity);
    return text;
}

}  // namespace uw
