#include "fit/unknowns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/key_path.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

std::optional<double> number_in(const ConfigNode& node) {
    double value = 0;
    if (node.kind != ConfigNode::Kind::scalar || node.quoted ||
        parse_number(node.scalar, value) != NumberText::number)
        return std::nullopt;
    return value;
}

/// The unknowns of pictures, in addition to those of scenes.
constexpr double k_min_exposure = 1e-3;  // of where it begins
constexpr std::string_view k_exposure = "exposure", k_response = "response";

/// The segments of a path: "lamps.*.position[0]" are lamps, *, position, [0].
std::vector<std::string> segments_of(const std::string& path) {
    std::vector<std::string> segments;
    for (const KeyStep& step : parse_key_path(path)) segments.push_back(step.text());
    return segments;
}

/// Refuses a path that leads nowhere in the scene, with what may have been meant.
[[noreturn]] void refuse_missing(const ConfigNode& tree, const std::string& path) {
    const ConfigNode* parent = &tree;
    std::string at;
    for (const KeyStep& step : parse_key_path(path)) {
        at += (at.empty() || step.index ? "" : ".") + step.text();
        const ConfigNode* const found = find_value(tree, at);
        if (found != nullptr) {
            parent = found;
            continue;
        }
        std::vector<std::string_view> there;
        for (const ConfigNode::Entry& entry : parent->entries) there.push_back(entry.key);
        const std::string_view nearest = nearest_word(step.key, there);
        throw UsageError(fmt::format("the scene has no {}; {}", printable(at),
                                     nearest.empty()
                                         ? "write there what you expect, from where the fit begins"
                                         : fmt::format("did you mean '{}'?", nearest)));
    }
    throw UsageError(fmt::format("the scene has no {}", printable(path)));
}

bool is_direction(const ConfigNode& node, std::string_view path) {
    return node.kind == ConfigNode::Kind::sequence && node.items.size() == 3 &&
           (path.ends_with(".normal") || path.ends_with(".direction"));
}

}  // namespace

SceneUnknowns::SceneUnknowns(ConfigNode tree, std::filesystem::path file,
                             std::span<const std::string> keys,
                             std::span<const std::string> pictures)
    : tree_(std::move(tree)), file_(std::move(file)) {
    for (const std::string& key : keys) {
        if (key == k_exposure || key == k_response) {
            add_of_pictures(key, pictures);
            continue;
        }
        const std::string origin = "--unknown " + printable(key);
        if (parse_key_path(key).empty())
            throw UsageError(
                fmt::format("{}: not of the form of a key's path; for example "
                            "water.absorption or lamps.*.position",
                            origin));
        try {
            for (const std::string& path : expanded_paths(tree_, key, origin)) {
                const ConfigNode* const node = find_value(tree_, path);
                if (node == nullptr) refuse_missing(tree_, path);
                add(*node, path);
            }
        } catch (const UsageError& fault) {
            throw UsageError(fmt::format("{}: {}", origin, fault.what()));
        } catch (const InputError& fault) {
            throw UsageError(fault.what());
        }
    }
    for (std::size_t i = 0; i < unknowns_.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (unknowns_[i].name == unknowns_[j].name)
                throw UsageError(
                    fmt::format("--unknown: {} is named twice; leave one out", unknowns_[i].name));
    limit();
}

void SceneUnknowns::add_of_pictures(const std::string& key, std::span<const std::string> pictures) {
    if (pictures.empty())
        throw UsageError(fmt::format(
            "--unknown {}: is that of pictures, and corners do not tell it; leave it out", key));
    const auto add_one = [&](const std::string& path, const std::string& name, SceneUnknown::Of of,
                             std::size_t picture) {
        places_.push_back({path, unknowns_.size()});
        SceneUnknown unknown{name, "", 1, 1, k_min_exposure};
        unknown.of = of;
        unknown.picture = picture;
        unknowns_.push_back(std::move(unknown));
    };
    if (key == k_response) {
        add_one(key, key, SceneUnknown::Of::response, 0);
        return;
    }
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const std::string path = fmt::format("{}[{}]", key, i);
        add_one(path, fmt::format("{} ({})", path, pictures[i]), SceneUnknown::Of::exposure, i);
    }
}

void SceneUnknowns::begin_at(std::size_t unknown, double exposure) {
    unknowns_[unknown].start = unknowns_[unknown].scale = exposure;
    unknowns_[unknown].lower = k_min_exposure * exposure;
}

void SceneUnknowns::add(const ConfigNode& node, const std::string& path) {
    if (is_direction(node, path)) {
        Vector3 direction{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto component = number_in(node.items[static_cast<std::size_t>(axis)]);
            if (!component) throw UsageError(fmt::format("{} is no direction", path));
            direction[axis] = *component;
        }
        if (!(glm::length(direction) > 0)) throw UsageError(fmt::format("{} is 0", path));
        direction = glm::normalize(direction);
        const Vector3 aside = std::abs(direction.x) < 0.8 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
        const Vector3 first = glm::normalize(aside - glm::dot(aside, direction) * direction);
        places_.push_back(
            {path, unknowns_.size(), true, direction, {first, glm::cross(direction, first)}});
        for (const int tilt : {1, 2})
            unknowns_.push_back({fmt::format("{} (tilt {})", path, tilt), "deg", 0, 1});
        return;
    }
    if (number_in(node)) {
        add_number(node, path, 0);
        return;
    }
    if (node.kind != ConfigNode::Kind::sequence || node.items.empty())
        throw UsageError(
            fmt::format("{} is {}; name a number or a list of numbers", path, node.description()));
    double greatest = 0;
    for (const ConfigNode& item : node.items)
        greatest = std::max(greatest, std::abs(number_in(item).value_or(0)));
    for (std::size_t i = 0; i < node.items.size(); ++i)
        add_number(node.items[i], fmt::format("{}[{}]", path, i), greatest);
}

void SceneUnknowns::add_number(const ConfigNode& node, const std::string& path, double scale) {
    const std::optional<double> value = number_in(node);
    if (!value)
        throw UsageError(
            fmt::format("{} is {}, where a number is needed", path, node.description()));
    constexpr double k_scale_of_zero = 0.01;  // a centimetre, 1 % per metre
    scale = std::max(scale, std::abs(*value));
    places_.push_back({path, unknowns_.size()});
    unknowns_.push_back({path, "", *value, scale > 0 ? scale : k_scale_of_zero});
}

void SceneUnknowns::limit() {
    std::vector<double> values;
    for (const SceneUnknown& unknown : unknowns_) values.push_back(unknown.start);
    scene(values);  // throws if the scene itself is invalid
    const auto is_refused = [&](std::size_t i, double value) {
        const double start = std::exchange(values[i], value);
        bool refused = false;
        try {
            scene(values);
        } catch (const InputError&) {
            refused = true;
        }
        values[i] = start;
        return refused;
    };
    // The last value that is accepted on the way from `from`, which is, to `to`, which is not.
    const auto last_accepted = [&](std::size_t i, double from, double to) {
        constexpr int k_halvings = 40;
        for (int k = 0; k < k_halvings; ++k) {
            const double middle = 0.5 * (from + to);
            (is_refused(i, middle) ? to : from) = middle;
        }
        return from;
    };
    for (const Place& place : places_) {
        if (place.is_direction || unknowns_[place.first].of != SceneUnknown::Of::scene) continue;
        SceneUnknown& unknown = unknowns_[place.first];
        const double below = -1e-3 * unknown.scale, above = 1e3 * unknown.scale;
        if (unknown.start >= 0 && is_refused(place.first, below))
            unknown.lower =
                is_refused(place.first, 0) ? last_accepted(place.first, unknown.start, 0) : 0;
        if (unknown.start >= 0 && is_refused(place.first, above))
            unknown.upper = last_accepted(place.first, unknown.start, above);
    }
}

std::vector<std::pair<std::string, std::string>> SceneUnknowns::settings(
    std::span<const double> values) const {
    std::vector<std::pair<std::string, std::string>> all;
    for (const Place& place : places_) {
        if (unknowns_[place.first].of != SceneUnknown::Of::scene) continue;
        if (!place.is_direction) {
            all.emplace_back(place.path, number_text(values[place.first]));
            continue;
        }
        const Vector3 tilted = glm::normalize(
            place.direction + std::tan(values[place.first] * k_degree) * place.tilts[0] +
            std::tan(values[place.first + 1] * k_degree) * place.tilts[1]);
        const double components[] = {tilted.x, tilted.y, tilted.z};
        all.emplace_back(place.path, numbers_text(components));
    }
    return all;
}

SceneDesc SceneUnknowns::scene(std::span<const double> values) const {
    ConfigNode tree = tree_;
    for (const auto& [path, text] : settings(values))
        set_value(tree, path, parse_yaml_value(text, "the fit"), "the fit");
    return load_scene_tree(tree, file_);
}

std::vector<std::size_t> SceneUnknowns::within(const std::string& key) const {
    const std::vector<std::string> wanted = segments_of(key);
    std::vector<std::size_t> found;
    for (const Place& place : places_) {
        const std::vector<std::string> segments = segments_of(place.path);
        const bool is_within = !wanted.empty() && wanted.size() <= segments.size() &&
                               std::ranges::equal(wanted, std::span(segments).first(wanted.size()),
                                                  [](const std::string& a, const std::string& b) {
                                                      return a == "*" || a == b;
                                                  });
        if (!is_within) continue;
        found.push_back(place.first);
        if (place.is_direction) found.push_back(place.first + 1);
    }
    if (found.empty())
        throw UsageError(fmt::format("{}: none of the unknowns is called that", printable(key)));
    return found;
}

}  // namespace uw
