#include "edit/session/state_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <variant>

#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/geometry/mesh_reader.h"
#include "core/image/layers.h"
#include "edit/session/picture.h"
#include "edit/session/view_geometry.h"
#include "edit/session/view_table.h"
#include "media/water/water_types.h"
#include "render/scene_rendering.h"

namespace uw {

namespace {

constexpr double k_crease_cosine = 0.8660254037844386;  // of 30 degrees
constexpr int k_circle_sides = 48;

std::array<float, 3> floats_of(const Point3& p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

Point3 point_of(const std::array<float, 3>& p) {
    return {p[0], p[1], p[2]};
}

double length_of(const OutlineSegment& segment) {
    return std::hypot(segment.to[0] - segment.from[0], segment.to[1] - segment.from[1],
                      segment.to[2] - segment.from[2]);
}

/// Collects the segments of one scene.
class Outlines {
  public:
    void add(const GeometryDesc& desc) {
        switch (desc.type) {
            case GeometryDesc::Type::file:
                add_mesh(desc);
                break;
            case GeometryDesc::Type::box:
                add_box(desc);
                break;
            case GeometryDesc::Type::sphere:
                add_sphere(desc);
                break;
            case GeometryDesc::Type::plane:
                break;
        }
    }
    std::vector<OutlineSegment> release() { return std::move(segments_); }

  private:
    // An edge of a mesh while its faces are met.
    struct Edge {
        std::uint32_t a = 0, b = 0;  // vertices
        Vector3 normal{0};           // of the first face
        int faces = 0;
        bool is_crease = false;
    };

    void add_line(const Affine& world_from_line, const Point3& a, const Point3& b) {
        segments_.push_back({floats_of(world_from_line * a), floats_of(world_from_line * b)});
    }

    void add_box(const GeometryDesc& desc) {
        const auto corner = [&](int bits) {
            Point3 p;
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = ((bits >> axis) & 1) != 0 ? desc.max[axis] : desc.min[axis];
            return p;
        };
        for (int bits = 0; bits < 8; ++bits)
            for (int axis = 0; axis < 3; ++axis)
                if (((bits >> axis) & 1) == 0)
                    add_line(desc.world_from_object, corner(bits), corner(bits | 1 << axis));
    }

    void add_sphere(const GeometryDesc& desc) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto at = [&](int i) {
                const double turn = 2 * std::numbers::pi * i / k_circle_sides;
                Vector3 offset(0);
                offset[(axis + 1) % 3] = desc.radius * std::cos(turn);
                offset[(axis + 2) % 3] = desc.radius * std::sin(turn);
                return desc.center + offset;
            };
            for (int i = 0; i < k_circle_sides; ++i)
                add_line(desc.world_from_object, at(i), at(i + 1));
        }
    }

    void add_mesh(const GeometryDesc& desc) {
        MeshFile file;
        try {
            std::vector<std::string> ignored;
            file = read_mesh(desc.file, ignored, {.camera_or_lamps = true});
        } catch (const std::exception&) {
            return;
        }
        add_triangles(desc.world_from_object, file.mesh);
        for (const SharedMesh& shared : file.shared) {
            const std::size_t first = segments_.size();
            add_triangles(Affine(), shared.mesh);
            const std::vector<OutlineSegment> outline(
                segments_.begin() + static_cast<std::ptrdiff_t>(first), segments_.end());
            segments_.resize(first);
            for (const SharedMesh::Placement& placement : shared.placements) {
                const Affine map = desc.world_from_object * placement.file_from_mesh;
                for (const OutlineSegment& line : outline)
                    add_line(map, point_of(line.from), point_of(line.to));
            }
        }
    }

    void add_triangles(const Affine& world_from_mesh, const TriangleMesh& mesh) {
        const auto vertex = [&](std::uint32_t v) {
            const float* p = &mesh.positions[3 * std::size_t{v}];
            return Point3{p[0], p[1], p[2]};
        };
        const std::vector<std::uint32_t> joined = joined_vertices(mesh);
        std::unordered_map<std::uint64_t, Edge> edges;
        for (std::size_t at = 0; at + 2 < mesh.triangles.size(); at += 3) {
            const std::uint32_t* corner = &mesh.triangles[at];
            const Vector3 normal = glm::cross(vertex(corner[1]) - vertex(corner[0]),
                                              vertex(corner[2]) - vertex(corner[0]));
            if (!(glm::length(normal) > 0)) continue;
            for (int k = 0; k < 3; ++k)
                meet(edges, joined[corner[k]], joined[corner[(k + 1) % 3]], glm::normalize(normal));
        }
        for (const auto& [key, edge] : edges)
            if (edge.faces == 1 || edge.is_crease)
                add_line(world_from_mesh, vertex(edge.a), vertex(edge.b));
    }

    static void meet(std::unordered_map<std::uint64_t, Edge>& edges, std::uint32_t a,
                     std::uint32_t b, const Vector3& normal) {
        if (a > b) std::swap(a, b);
        Edge& edge = edges[std::uint64_t{a} << 32 | b];
        if (edge.faces++ == 0) {
            edge.a = a;
            edge.b = b;
            edge.normal = normal;
        } else if (glm::dot(edge.normal, normal) < k_crease_cosine) {
            edge.is_crease = true;
        }
    }

    // Maps each vertex to the first one at its place: files repeat vertices where normals or
    // textures differ.
    static std::vector<std::uint32_t> joined_vertices(const TriangleMesh& mesh) {
        std::map<std::array<float, 3>, std::uint32_t> first;
        std::vector<std::uint32_t> joined;
        joined.reserve(mesh.vertex_count());
        for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
            const float* p = &mesh.positions[3 * std::size_t{v}];
            joined.push_back(first.try_emplace({p[0], p[1], p[2]}, v).first->second);
        }
        return joined;
    }

    std::vector<OutlineSegment> segments_;
};

}  // namespace

std::vector<OutlineSegment> scene_outlines(const std::vector<GeometryDesc>& geometry,
                                           std::size_t most) {
    Outlines outlines;
    for (const GeometryDesc& desc : geometry) outlines.add(desc);
    std::vector<OutlineSegment> segments = outlines.release();
    const auto is_before = [](const OutlineSegment& a, const OutlineSegment& b) {
        const double x = length_of(a), y = length_of(b);
        return x != y ? x > y : std::tie(a.from, a.to) < std::tie(b.from, b.to);
    };
    std::ranges::sort(segments, is_before);
    if (segments.size() > most) segments.resize(most);
    return segments;
}

namespace {

Json scalar_json(const ConfigNode& node) {
    if (node.quoted) return node.scalar;
    if (node.scalar == "true") return true;
    if (node.scalar == "false") return false;
    double number = 0;
    if (parse_number(node.scalar, number) == NumberText::number) return number;
    return node.scalar;
}

/// Part of a scene file as JSON, with its scalars as YAML means them: numbers, true and false, or
/// text.
Json config_json(const ConfigNode& node) {
    switch (node.kind) {
        case ConfigNode::Kind::scalar:
            return scalar_json(node);
        case ConfigNode::Kind::sequence: {
            Json list = Json::array();
            for (const ConfigNode& item : node.items) list.push_back(config_json(item));
            return list;
        }
        case ConfigNode::Kind::map: {
            Json map = Json::object();
            for (const ConfigNode::Entry& entry : node.entries)
                map[entry.key] = config_json(entry.value);
            return map;
        }
        case ConfigNode::Kind::null:
            break;
    }
    return nullptr;
}

Json pixel_json(const ImagePoint& pixel) {
    return Json::array({number_json(pixel.x), number_json(pixel.y)});
}

Json handle_json(const Camera& camera, const Point3& world) {
    const ViewHandle handle = view_handle(camera, world);
    return {{"point", point_json(world)},
            {"pixel", handle.pixel ? pixel_json(*handle.pixel) : Json(nullptr)},
            {"inside", handle.inside},
            {"rim", pixel_json(handle.rim)}};
}

struct ProfileJson {
    Json operator()(const IsotropicProfileDesc& /*profile*/) const {
        return {{"type", "isotropic"}};
    }
    Json operator()(const SpotProfileDesc& profile) const {
        return {{"type", "spot"}, {"beam", profile.beam}, {"edge", profile.edge}};
    }
    Json operator()(const CosineProfileDesc& profile) const {
        return {{"type", "cosine"}, {"fwhm", profile.fwhm}};
    }
    Json operator()(const TableProfileDesc& profile) const {
        return {{"type", "table"},
                {"angles", list_json(profile.angles)},
                {"values", list_json(profile.values)}};
    }
    Json operator()(const IesProfileDesc& profile) const {
        return {{"type", "ies"},
                {"file", profile.file.lexically_relative(folder).generic_string()},
                {"rotate", profile.rotate},
                {"tilt", profile.tilt}};
    }
    Json operator()(const LineProfileDesc& profile) const {
        return {{"type", "line"},
                {"angle", profile.angle},
                {"width", profile.width},
                {"rotate", profile.rotate}};
    }
    Json operator()(const ImageProfileDesc& profile) const {
        return {{"type", "image"},
                {"file", profile.file.lexically_relative(folder).generic_string()},
                {"fov", profile.fov},
                {"rotate", profile.rotate}};
    }
    std::filesystem::path folder;
};

Json brightness_json(const LampDesc& lamp, const ConfigNode* entry) {
    Json brightness;
    if (lamp.emissive_volume)
        brightness = {{"kind", "emission"},
                      {"unit", lamp.emissive_volume->emission.blackbody ? "1/m" : "W/(sr m3)"},
                      {"value", list_json(lamp.emissive_volume->emission.per_unit)}};
    else if (lamp.sun && lamp.intensity)
        brightness = {
            {"kind", "irradiance"}, {"unit", "W/m2"}, {"value", list_json(*lamp.intensity)}};
    else if (lamp.sun)
        brightness = {{"kind", "lux"}, {"unit", "lx"}, {"value", *lamp.lumens}};
    else if (lamp.intensity)
        brightness = {
            {"kind", "intensity"}, {"unit", "W/sr"}, {"value", list_json(*lamp.intensity)}};
    else if (lamp.power)
        brightness = {{"kind", "power"}, {"unit", "W"}, {"value", list_json(*lamp.power)}};
    else if (lamp.lumens)
        brightness = {{"kind", "lumens"}, {"unit", "lm"}, {"value", *lamp.lumens}};
    else
        brightness = {{"kind", "profile"}, {"unit", nullptr}, {"value", nullptr}};
    // With a spectrum there is one number for all bands.
    if (lamp.spectrum && brightness["value"].is_array())
        brightness["value"] = brightness["value"][0];
    const ConfigNode* spectrum = entry ? entry->find("spectrum") : nullptr;
    brightness["spectrum"] = spectrum ? config_json(*spectrum) : Json(nullptr);
    return brightness;
}

// Why the editor does not change a lamp; empty if it does.
std::string reason_to_lock(const LampDesc& lamp, const ConfigNode* entry) {
    if (lamp.emissive_volume)
        return "it is the light of a volume, and is changed there in the scene file";
    if (lamp.sky) return "it is the light of the sky, and is changed there in the scene file";
    return entry ? "" : "it comes from a glTF file, which is not written here";
}

// The luminous surface of a lamp that is not a point, by its keys in scene files.
Json extent_json(const std::optional<LampExtentDesc>& extent) {
    if (!extent) return nullptr;
    if (extent->shape != LampExtentDesc::Shape::rectangle)
        return {{"type", extent->shape == LampExtentDesc::Shape::disk ? "disk" : "sphere"},
                {"radius", extent->radius},
                {"samples", extent->samples}};
    return {{"type", "rectangle"},
            {"width", extent->width},
            {"height", extent->height},
            {"rotate", extent->rotate},
            {"samples", extent->samples}};
}

// The additional members of a sun, by its keys in scene files.
Json sun_json(const std::optional<SunDesc>& sun) {
    if (!sun) return nullptr;
    return {{"angle", sun->angle}, {"samples", sun->samples}};
}

std::string_view frame_of(const SceneDesc& desc, const LampDesc& lamp, const ConfigNode* entry) {
    const ConfigNode* frame = entry ? entry->find("frame") : nullptr;
    if (frame && frame->scalar == "world") return "world";
    if (frame && frame->scalar == "rig") return "rig";
    if (lamp.sun) return "world";
    if (lamp.trajectory) return "trajectory";
    if (lamp.fixed_to_camera) return "camera";
    if (!entry) return "world";
    return frame || desc.cameras.empty() ? "camera" : "rig";
}

/// One lamp of the state: what the file says of it, where it is in the world and in the image.
/// `tree` is the scene file's.
Json lamp_json(const EditedScene& edited, std::size_t index, const ConfigNode& tree) {
    const SceneDesc& desc = edited.scene.desc();
    const LampDesc& lamp = desc.lamps[index];
    const EditedLamp& known = edited.lamps[index];
    const ConfigNode* entries = tree.find("lamps");
    const ConfigNode* entry = known.entry && entries ? &entries->items[*known.entry] : nullptr;
    const PlacedLamp placed = placed_lamp(lamp, desc.camera);
    Json cone = Json::array();
    for (const ImagePoint& point : beam_outline(*edited.camera, lamp, placed))
        cone.push_back(pixel_json(point));
    const auto half_angle = beam_half_angle(lamp.profile);
    const std::string why_not = reason_to_lock(lamp, entry);
    return {{"index", index},
            {"name", lamp.name},
            {"path", entry ? Json(fmt::format("lamps[{}]", *known.entry)) : Json(nullptr)},
            {"editable", why_not.empty()},
            {"why_not", why_not.empty() ? Json(nullptr) : Json(why_not)},
            {"on", known.on},
            {"frame", frame_of(desc, lamp, entry)},
            {"position", point_json(lamp.position)},
            {"direction", vector_json(lamp.direction)},
            {"world_position", point_json(placed.position)},
            {"world_direction", vector_json(placed.direction)},
            {"profile", lamp.sun ? Json{{"type", "sun"}}
                        : lamp.emissive_volume
                            ? Json{{"type", "volume"}}
                            : std::visit(ProfileJson{desc.file.parent_path()}, lamp.profile)},
            {"extent", extent_json(lamp.extent)},
            {"sun", sun_json(lamp.sun)},
            {"half_angle", half_angle ? Json(*half_angle) : Json(nullptr)},
            {"brightness", brightness_json(lamp, entry)},
            {"band_intensity", list_json(known.brightness.first(edited.bands()))},
            {"rgb_scale", list_json(edited.colour_scale(known.brightness))},
            {"handle", handle_json(*edited.camera, placed.position)},
            {"axis_handle", handle_json(*edited.camera, axis_point(placed))},
            {"cone", std::move(cone)}};
}

/// The lamp spectra that a scene can name without a file, as values of `spectrum`.
Json lamp_spectrum_names_json() {
    Json names = Json::array(
        {{{"type", "flat"}}, {{"type", "d65"}}, {{"type", "blackbody"}, {"temperature", 3200}}});
    // The LEDs among the CIE's illuminants (CIE 15:2018).
    for (const std::string_view led : {"LED-B1", "LED-B2", "LED-B3", "LED-B4", "LED-B5", "LED-BH1",
                                       "LED-RGB1", "LED-V1", "LED-V2"})
        names.push_back({{"type", "led"}, {"name", led}});
    return names;
}

// A folder that is deeper, or has more of them, is not one of lamps' files.
constexpr int k_folder_depth = 2;
constexpr std::size_t k_max_files = 200;

Json port_values_json(const FlatPortDesc& port) {
    return {{"type", "flat"},
            {"normal", vector_json(port.normal)},
            {"distance", port.distance},
            {"thickness", port.thickness},
            {"n_air", port.n_air},
            {"n_glass", port.n_glass},
            {"n_water", port.n_water},
            {"fresnel", port.fresnel}};
}

Json port_values_json(const DomePortDesc& port) {
    return {{"type", "dome"},          {"center", point_json(port.center)},
            {"radius", port.radius},   {"thickness", port.thickness},
            {"n_air", port.n_air},     {"n_glass", port.n_glass},
            {"n_water", port.n_water}, {"fresnel", port.fresnel}};
}

// The port, with the path under which it can be edited, which is null where a calibration or a rig
// holds it.
Json port_json(const CameraDesc& camera, const ConfigNode& tree) {
    if (!camera.port) return nullptr;
    Json port = std::visit([](const auto& desc) { return port_values_json(desc); }, *camera.port);
    const ConfigNode* node = tree.find("camera");
    const ConfigNode* const written = node ? node->find("port") : nullptr;
    port["path"] = written ? Json("camera.port") : Json(nullptr);
    // The materials that indices are given by, as they are written; null: by numbers.
    const auto material = [&](const std::optional<DispersionDesc>& known, const char* key) -> Json {
        if (!known) return nullptr;
        const ConfigNode* const own = written ? written->find(key) : nullptr;
        const bool is_word = own && own->kind == ConfigNode::Kind::scalar;
        return is_word ? own->scalar : scene_text(*known);
    };
    std::visit(
        [&](const auto& desc) {
            port["materials"] = {{"n_air", material(desc.dispersion.air, "n_air")},
                                 {"n_glass", material(desc.dispersion.glass, "n_glass")},
                                 {"n_water", material(desc.dispersion.water, "n_water")}};
        },
        *camera.port);
    return port;
}

Json camera_json(const EditedScene& edited, const ConfigNode& tree) {
    const SceneDesc& desc = edited.scene.desc();
    const Affine& world_from_camera = desc.camera.world_from_camera;
    Json frustum = Json::array();
    for (const Point3& corner : view_frustum(*edited.camera)) frustum.push_back(point_json(corner));
    const auto axis = [&](double x, double y, double z) {
        return vector_json(world_from_camera.apply_to_vector({x, y, z}));
    };
    return {{"name", desc.camera_name},
            {"position", point_json(world_from_camera * Point3{})},
            {"forward", axis(0, 0, 1)},
            {"right", axis(1, 0, 0)},
            {"up", axis(0, -1, 0)},
            {"frustum", std::move(frustum)},
            {"port", port_json(desc.camera, tree)}};
}

Json water_json(const SceneDesc& desc, const ConfigNode& tree) {
    const WaterDesc& water = desc.water;
    const auto optional = [](const std::optional<double>& value) {
        return value ? Json(*value) : Json(nullptr);
    };
    const ConfigNode* node = tree.find("water");
    return {
        {"preset", water.preset.empty() ? Json(nullptr) : Json(water.preset)},
        {"presets", jerlov_preset_names()},
        {"particles", {{"small", optional(water.small_ppm)}, {"large", optional(water.large_ppm)}}},
        {"salinity", water.salinity},
        {"temperature", water.temperature},
        {"path", "water"},
        {"keys", node ? config_json(*node) : Json::object()}};
}

std::string name_in_folder(const std::filesystem::path& file, const SceneDesc& desc) {
    return file.lexically_relative(desc.file.parent_path()).generic_string();
}

Json volumes_json(const SceneDesc& desc, const SceneShapes* shapes) {
    Json volumes = Json::array();
    for (std::size_t i = 0; i < desc.volumes.size(); ++i) {
        const VolumeDesc& volume = desc.volumes[i];
        Json concentrations = Json::object();
        for (const GridMappingDesc& grid : volume.grids)
            if (!grid.optics)
                concentrations[grid.grid] = {{"small", grid.small_ppm}, {"large", grid.large_ppm}};
        const bool has_bounds = shapes && i < shapes->volumes.size();
        volumes.push_back({{"index", i},
                           {"file", name_in_folder(volume.file, desc)},
                           {"path", fmt::format("volumes[{}]", i)},
                           {"bounds", has_bounds ? bounds_json(shapes->volumes[i]) : Json(nullptr)},
                           {"concentrations", std::move(concentrations)}});
    }
    return volumes;
}

/// The layers of light that not every scene has.
Json light_layers_json(const ImageScene& scene) {
    const LayerPlan plan = layer_plan(scene, {});
    Json layers = Json::array();
    for (const Layer layer : {Layer::forward, Layer::multiple, Layer::snow})
        if (plan.is_provided(layer))
            layers.push_back(k_layers[static_cast<std::size_t>(layer)].name);
    return layers;
}

// The frame that is shown and those that there are; null if nothing moves.
Json moment_json(const ImageScene& scene) {
    const std::optional<FrameRange> frames = frames_of(scene.whole());
    if (!frames || !scene.time()) return nullptr;
    const auto& frame = scene.choice().frame;
    return {{"first", frames->first},
            {"last", frames->last},
            {"frame", frame ? Json(*frame) : Json(nullptr)},
            {"time", *scene.time()}};
}

// What `uwvdb render` renders and the editor's picture leaves out: one sentence each.
Json not_shown_json(const EditedScene& edited) {
    const SceneDesc &desc = edited.scene.desc(), &whole = edited.scene.whole();
    Json sentences = Json::array();
    if (desc.camera.sensor)
        sentences.push_back(
            "The picture is the light before the camera's sensor: its noise and "
            "development are not shown.");
    if (has_motion(whole) && edited.scene.time())
        sentences.push_back("How things move is changed in the scene file.");
    const auto [width, height] =
        picture_size(PictureQuality::final, desc.camera.width, desc.camera.height);
    if (width < desc.camera.width)
        sentences.push_back(fmt::format("The picture has {} x {} of the image's {} x {} pixels.",
                                        width, height, desc.camera.width, desc.camera.height));
    if (desc.water.forward_scatter.K > 0 && desc.lamps.size() > 1)
        sentences.push_back(
            "Forward scatter blurs each lamp's light by its own way through the "
            "water; render takes the mean of all lamps' ways.");
    return sentences;
}

// The view of the picture, and how its table (ViewTable) is looked up.
Json view_json(const std::shared_ptr<const ColourView>& view) {
    if (!view) return nullptr;
    return {{"name", view->name},
            {"key", view->number},
            {"side", ViewTable::k_side},
            {"least", ViewTable::k_least},
            {"octaves", ViewTable::k_octaves}};
}

Json ies_files_json(const SceneDesc& desc) {
    namespace fs = std::filesystem;
    std::vector<std::string> names;
    std::error_code error;
    fs::path folder = desc.file.parent_path();
    if (folder.empty()) folder = ".";
    for (auto at = fs::recursive_directory_iterator(
             folder, fs::directory_options::skip_permission_denied, error);
         !error && at != fs::recursive_directory_iterator() && names.size() < k_max_files;
         at.increment(error)) {
        if (at.depth() >= k_folder_depth) at.disable_recursion_pending();
        const std::string ending = at->path().extension().string();
        const bool is_there = !at->is_symlink(error) || lies_within(folder, at->path());
        if (is_there && (ending == ".ies" || ending == ".IES"))
            names.push_back(at->path().lexically_relative(folder).generic_string());
    }
    std::ranges::sort(names);
    return names;
}

}  // namespace

Json outline_segments_json(const std::vector<OutlineSegment>& outlines) {
    Json segments = Json::array();
    for (const OutlineSegment& s : outlines)
        segments.push_back({s.from[0], s.from[1], s.from[2], s.to[0], s.to[1], s.to[2]});
    return segments;
}

Json scene_json(const EditedScene& edited, const ConfigNode& tree, const SceneShapes* shapes) {
    const SceneDesc& desc = edited.scene.desc();
    Json lamps = Json::array();
    for (std::size_t i = 0; i < desc.lamps.size(); ++i) lamps.push_back(lamp_json(edited, i, tree));
    Json cameras = Json::array();
    for (const auto& camera : edited.scene.whole().cameras) cameras.push_back(camera.name);
    return {{"image",
             {{"width", desc.camera.width},
              {"height", desc.camera.height},
              {"bands", list_json(desc.water.bands_nm)},
              {"bands_are_rgb", edited.has_plain_colour}}},
            {"warnings", edited.warnings},
            {"light", light_layers_json(edited.scene)},
            {"not_shown", not_shown_json(edited)},
            {"view", view_json(edited.view)},
            {"camera", camera_json(edited, tree)},
            {"rig", !desc.cameras.empty()},
            {"cameras", std::move(cameras)},
            {"moment", moment_json(edited.scene)},
            {"lamps", std::move(lamps)},
            {"ies_files", ies_files_json(desc)},
            {"spectra", lamp_spectrum_names_json()},
            {"water", water_json(desc, tree)},
            {"volumes", volumes_json(desc, shapes)}};
}

}  // namespace uw
