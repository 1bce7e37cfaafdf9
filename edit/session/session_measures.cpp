#include "edit/session/session_measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/output_files.h"
#include "core/base/parallel.h"
#include "core/image/picture_file.h"
#include "core/image/pixel_image.h"
#include "core/image/preview_exposure.h"
#include "edit/session/edit_session.h"
#include "edit/session/picture.h"
#include "edit/session/request_members.h"
#include "edit/session/view_table.h"
#include "render/measures/picture_numbers.h"

namespace uw {

namespace {

constexpr std::array<std::pair<std::string_view, SuggestRequest::Objective>, 3> k_objectives{
    {{"contrast", SuggestRequest::Objective::contrast},
     {"signal_to_backscatter", SuggestRequest::Objective::signal_to_backscatter},
     {"irradiance", SuggestRequest::Objective::irradiance}}};

SuggestRequest::Objective objective_member(const Json& request) {
    if (!request.contains("objective")) return SuggestRequest::Objective::contrast;
    const std::string name = text_member(request, "objective");
    for (const auto& [known, objective] : k_objectives)
        if (name == known) return objective;
    throw UsageError("objective: use contrast, signal_to_backscatter or irradiance");
}

std::size_t lamp_member(const Json& request, const char* key, const ImageScene& scene) {
    const std::string name = text_member(request, key);
    const auto& lamps = scene.desc().lamps;
    const auto found = std::ranges::find(lamps, name, &LampDesc::name);
    if (found == lamps.end())
        throw UsageError(fmt::format("{}: there is no lamp of that name that is on", key));
    return static_cast<std::size_t>(found - lamps.begin());
}

// {"from", "to"} or {"min", "max"}.
std::pair<Point3, Point3> range_member(const Json& request, const char* key, const char* from,
                                       const char* to) {
    const Json& range = member(request, key);
    if (!range.is_object()) throw UsageError(fmt::format("{}: expected two points", key));
    return {at_origin_plus(vector_member(range, from)), at_origin_plus(vector_member(range, to))};
}

Json lamp_place_json(const LampDesc& lamp) {
    return {{"lamp", lamp.name},
            {"position", point_json(lamp.position)},
            {"direction", vector_json(lamp.direction)}};
}

// Reads a window's request to search a lamp's position. Throws UsageError where the request is
// malformed, makes no sense, or names lamps that are not in `scene`.
SuggestRequest suggest_request(const Json& request, const ImageScene& scene) {
    SuggestRequest wanted;
    wanted.lamp = lamp_member(request, "lamp", scene);
    if (request.contains("mirror") && !request["mirror"].is_null())
        wanted.partner = lamp_member(request, "mirror", scene);
    wanted.in_box = request.contains("box");
    std::tie(wanted.from, wanted.to) = wanted.in_box ? range_member(request, "box", "min", "max")
                                                     : range_member(request, "along", "from", "to");
    wanted.distance = number_member(request, "distance", wanted.distance);
    wanted.objective = objective_member(request);
    wanted.aim = flag_member(request, "aim", false) ? SuggestRequest::Aim::target
                                                    : SuggestRequest::Aim::keep;
    wanted.min_light = number_member(request, "least_light", wanted.min_light);
    const double samples = number_member(request, "samples", static_cast<double>(wanted.samples));
    if (!(samples >= 12 && samples <= 10000)) throw UsageError("samples: expected 12 to 10000");
    wanted.samples = static_cast<std::size_t>(samples);
    check_suggest_request(wanted, scene.desc().lamps);
    return wanted;
}

// {"signal", "backscatter", ...}, as SessionMeasures::numbers says.
Json numbers_json(const PictureNumbers& numbers) {
    const auto optional = [](const std::optional<double>& value) {
        return value ? number_json(*value) : Json(nullptr);
    };
    Json evenness;
    if (const auto& e = numbers.evenness)
        evenness = {{"mean", number_json(e->mean)},
                    {"least", number_json(e->least)},
                    {"greatest", number_json(e->greatest)},
                    {"percentile5", number_json(e->percentile5)},
                    {"median", number_json(e->median)},
                    {"percentile95", number_json(e->percentile95)},
                    {"least_to_mean", number_json(e->min_to_mean)},
                    {"percentile5_to_mean", number_json(e->percentile5_to_mean)},
                    {"pixels", e->pixels}};
    return {{"signal", number_json(numbers.signal)},
            {"backscatter", number_json(numbers.backscatter)},
            {"signal_to_backscatter", number_json(numbers.signal_to_backscatter)},
            {"contrast", number_json(numbers.contrast)},
            {"clean_contrast", optional(numbers.clean_contrast)},
            {"share_above", number_json(numbers.fraction_above)},
            {"lost_to_water", optional(numbers.lost_to_water)},
            {"evenness", std::move(evenness)}};
}

Json target_numbers_json(const TargetNumbers& numbers) {
    return {{"distance", number_json(numbers.distance)},
            {"contrast", number_json(numbers.contrast)},
            {"signal", number_json(numbers.signal)},
            {"backscatter", number_json(numbers.backscatter)},
            {"signal_to_backscatter", number_json(numbers.signal_to_backscatter)},
            {"irradiance", number_json(numbers.irradiance)}};
}

// A position that was tried, its objective, and its numbers.
Json suggest_point_json(const SuggestPoint& point) {
    return {{"position", point_json(point.position)},
            {"value", number_json(point.value)},
            {"allowed", point.allowed},
            {"numbers", target_numbers_json(point.numbers)}};
}

// The result of the search: the map of the objective, the previous and the best position, and the
// lamps there.
Json suggestion_json(const Suggestion& found) {
    Json map = Json::array();
    for (const SuggestPoint& point : found.map)
        map.push_back({{"position", point_json(point.position)},
                       {"value", number_json(point.value)},
                       {"allowed", point.allowed}});
    Json lamps = Json::array({lamp_place_json(found.lamp)});
    if (found.partner) lamps.push_back(lamp_place_json(*found.partner));
    return {{"map", {{"counts", found.counts}, {"points", std::move(map)}}},
            {"before", suggest_point_json(found.before)},
            {"best", suggest_point_json(found.best)},
            {"lamps", std::move(lamps)},
            {"tried", found.tried}};
}

// Unless a window chooses one, the part has this fraction of the image's shorter side.
constexpr double k_patch_fraction = 0.2;

// The part of the full image, or of a picture of it, that is meant.
PixelWindow scaled(const PixelWindow& part, const SceneDesc& desc, const Picture& picture) {
    const double x = static_cast<double>(picture.width) / desc.camera.width;
    const double y = static_cast<double>(picture.height) / desc.camera.height;
    PixelWindow scaled{
        static_cast<int>(std::floor(part.x0 * x)), static_cast<int>(std::floor(part.y0 * y)),
        static_cast<int>(std::ceil(part.x1 * x)), static_cast<int>(std::ceil(part.y1 * y))};
    scaled.x1 = std::min(scaled.x1, picture.width);
    scaled.y1 = std::min(scaled.y1, picture.height);
    return scaled;
}

Json window_json(const PixelWindow& window, double scale) {
    return {{"x0", window.x0 * scale},
            {"y0", window.y0 * scale},
            {"x1", window.x1 * scale},
            {"y1", window.y1 * scale}};
}

void check_part(const PixelWindow& part, const CameraDesc& camera) {
    if (part.x0 < 0 || part.y0 < 0 || part.x0 >= part.x1 || part.y0 >= part.y1 ||
        part.x1 > camera.width || part.y1 > camera.height)
        throw UsageError(fmt::format("x0, y0, x1, y1: not a part of the image of {} x {} pixels",
                                     camera.width, camera.height));
}

}  // namespace

SessionMeasures::~SessionMeasures() {
    cancel_suggest();
    ++newest_curves_;
    are_curves_outdated_ = true;
    if (searching_.joinable()) searching_.join();
}

Json SessionMeasures::curves(const EditedScene& scene) {
    const std::int64_t own = ++newest_curves_;
    are_curves_outdated_ = true;
    const std::lock_guard lock(probe_mutex_);
    are_curves_outdated_ = false;
    if (newest_curves_ != own) are_curves_outdated_ = true;  // a request came before that
    const StopScope scope(are_curves_outdated_);
    try {
        Json curves = {{"distance", Json::array()},
                       {"contrast", Json::array()},
                       {"signal_to_backscatter", Json::array()},
                       {"irradiance", Json::array()}};
        for (const TargetNumbers& numbers : probe_.curve(lit_scene(scene), target_distances())) {
            const Json point = target_numbers_json(numbers);
            for (auto& [name, values] : curves.items()) values.push_back(point[name]);
        }
        return curves;
    } catch (const Interrupted&) {
        throw ConflictError("a newer request has come");
    }
}

Json SessionMeasures::numbers(const NumbersRequest& request) {
    const std::shared_ptr<const Picture> picture = session_.picture();
    std::shared_ptr<const EditedScene> now = session_.scene();
    if (!picture || !now) throw ConflictError("there is no picture yet");
    // A newer scene has no picture so far: then the numbers are those of the picture at hand.
    if (!is_same_picture(*picture->scene, *now)) now = picture->scene;
    const SceneDesc& desc = now->scene.desc();
    const double scale = static_cast<double>(desc.camera.width) / picture->width;
    const PictureLayers layers = mixed_layers(*picture, *now);
    const PixelWindow whole{0, 0, picture->width, picture->height};
    PixelWindow part = whole;
    std::string_view kind = "image";
    if (request.part) {
        check_part(*request.part, desc.camera);
        part = scaled(*request.part, desc, *picture);
        kind = "pixels";
    } else if (const int side = static_cast<int>(
                   std::lround(k_patch_fraction * std::min(picture->width, picture->height)));
               const auto patterned = side > 1 ? patterned_part(layers, side) : std::nullopt) {
        part = *patterned;
        kind = "checkerboard";
    }
    Json json = {{"key", picture->number},
                 {"revision", now->revision},
                 {"quality", name_of(picture->quality)},
                 {"ratio", request.ratio},
                 {"image", numbers_json(measure_picture(layers, whole, request.ratio))},
                 {"patch", numbers_json(measure_picture(layers, part, request.ratio))}};
    json["patch"]["kind"] = kind;
    json["patch"]["window"] = window_json(part, scale);
    if (request.with_curves) json["curves"] = curves(*now);
    return json;
}

std::string SessionMeasures::numbers_csv(const NumbersRequest& request) {
    NumbersRequest all = request;
    all.with_curves = true;
    const Json json = numbers(all);
    std::string csv = "quantity,image,patch\n";
    for (const auto& [name, value] : json["image"].items()) {
        if (value.is_object()) {
            for (const auto& [part, number] : value.items())
                csv += fmt::format("{}.{},{},{}\n", name, part, number.dump(),
                                   json["patch"][name].value(part, Json()).dump());
        } else {
            csv += fmt::format("{},{},{}\n", name, value.dump(), json["patch"][name].dump());
        }
    }
    csv += "\ndistance_m,contrast,signal_to_backscatter,irradiance_W_m2\n";
    const Json& curves = json["curves"];
    for (std::size_t i = 0; i < curves["distance"].size(); ++i)
        csv +=
            fmt::format("{},{},{},{}\n", curves["distance"][i].dump(), curves["contrast"][i].dump(),
                        curves["signal_to_backscatter"][i].dump(), curves["irradiance"][i].dump());
    return csv;
}

std::string SessionMeasures::picture_png(std::optional<double> exposure) {
    const std::shared_ptr<const EditedScene> scene = session_.scene();
    if (!scene) throw ConflictError("there is no scene yet");
    const StopScope scope(session_.events().is_closed());
    Renderer renderer;
    renderer.set_scene(lit_scene(*scene));
    const Film& film = renderer.render();
    const double used = exposure ? *exposure : automatic_exposure(film).value_or(1.0);
    const ScratchFolder folder;
    const std::filesystem::path file = folder.path() / "picture.png";
    OutputFile out(file);
    write_picture(out, film, {.exposure = used, .view = scene->view.get()},
                  {{"uwvdb/scene", scene->scene.desc().file.filename().string()},
                   {"uwvdb/scene_hash", scene->scene.desc().hash}});
    out.commit();
    std::ifstream in = open_own_file(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

void SessionMeasures::tell(Json event) {
    session_.events().publish("suggest",
                              event.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string SessionMeasures::view_table() {
    const std::shared_ptr<const EditedScene> scene = session_.scene();
    if (!scene || !scene->view) throw ConflictError("the picture is shown as sRGB");
    return ViewTable::bytes_of(*scene->view);
}

Json SessionMeasures::suggest(const Json& request) {
    const std::lock_guard lock(search_mutex_);
    const std::shared_ptr<const EditedScene> edited = session_.scene();
    if (!edited) throw ConflictError("there is no scene yet");
    ImageScene scene = lit_scene(*edited);
    const SuggestRequest wanted = suggest_request(request, scene);
    is_cancelled_ = true;
    if (searching_.joinable()) searching_.join();
    is_cancelled_ = false;
    const std::int64_t id = ++last_search_;
    searching_ =
        std::thread([this, id, scene = std::move(scene), wanted] { search(id, scene, wanted); });
    return {{"id", id}};
}

void SessionMeasures::cancel_suggest() {
    is_cancelled_ = true;
}

void SessionMeasures::search(std::int64_t id, const ImageScene& scene,
                             const SuggestRequest& request) {
    work_in_background();
    Json event = {{"id", id}, {"samples", request.samples}};
    try {
        const StopScope scope(is_cancelled_);
        TargetProbe probe;
        std::size_t told = 0;
        const Suggestion found =
            suggest_position(probe, scene, request, [&](const Suggestion& so_far) {
                // Windows are told some twenty times.
                if (so_far.tried >= told + std::max<std::size_t>(1, request.samples / 20)) {
                    told = so_far.tried;
                    Json progress = event;
                    progress["state"] = "searching";
                    progress["tried"] = so_far.tried;
                    progress["best"] = suggest_point_json(so_far.best);
                    tell(std::move(progress));
                }
            });
        event["state"] = "found";
        event.update(suggestion_json(found));
    } catch (const Interrupted&) {
        event["state"] = "cancelled";
    } catch (const std::exception& error) {
        event["state"] = "failed";
        event["message"] = line_of(error);
    }
    tell(std::move(event));
}

}  // namespace uw
