#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/image/aces.h"
#include "core/image/colour_view.h"

namespace OCIO = OCIO_NAMESPACE;

namespace {

using Check = std::function<void(const std::filesystem::path&)>;

std::string one_line(std::string text) {
    for (char& c : text)
        if (c == '\n') c = ' ';
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    return text;
}

/// "no view 'Fancy'; there are Standard, Filmic".
template <class Name>
std::string missing(const std::string& what, const std::string& word, int count, const Name& name) {
    std::string text = "no " + what + " '" + word + "'; ";
    text += count > 0 ? "there are " : "there are none";
    for (int i = 0; i < count; ++i) text += (i > 0 ? ", " : "") + std::string(name(i));
    return text;
}

/// The looks in a list such as "+neutral, -grade".
std::vector<std::string> looks_of(std::string_view list) {
    std::vector<std::string> looks;
    while (!list.empty()) {
        const std::size_t end = list.find_first_of(",:|");
        std::string look(list.substr(0, end));
        list = end == std::string_view::npos ? std::string_view() : list.substr(end + 1);
        constexpr const char* k_blanks = " \t";
        look.erase(0, look.find_first_not_of(k_blanks));
        look.erase(look.find_last_not_of(k_blanks) + 1);
        if (!look.empty() && (look.front() == '+' || look.front() == '-')) look.erase(0, 1);
        looks.push_back(std::move(look));
    }
    return looks;
}

/// Follows every reference of a config before OpenColorIO does, whose recursion has no end where a
/// part refers to itself, and whose work doubles with each part that refers to another one twice.
class ConfigWalk {
  public:
    /// `check` is called with every file that any part of the config refers to.
    ConfigWalk(const OCIO::Config& config, const Check& check)
        : config_(config), shared_(config.getCurrentContext()), context_(*shared_), check_(check) {}

    /// What is wrong, to follow the config's name; empty if nothing is. Passes on what `check`
    /// throws.
    std::string fault() {
        try {
            walk();
        } catch (const Fault& fault) {
            return fault.what;
        }
        return "";
    }

  private:
    struct Fault {
        std::string what;
    };
    /// What a part is made of, with all that it refers to.
    struct Extent {
        std::size_t steps = 0;
        int height = 0;  // of the longest chain of references
    };

    void walk() {
        const int spaces =
            config_.getNumColorSpaces(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL);
        for (int i = 0; i < spaces; ++i)
            take_space(config_.getColorSpaceNameByIndex(OCIO::SEARCH_REFERENCE_SPACE_ALL,
                                                        OCIO::COLORSPACE_ALL, i));
        for (int i = 0; i < config_.getNumLooks(); ++i) take_look(config_.getLookNameByIndex(i));
        for (int i = 0; i < config_.getNumViewTransforms(); ++i)
            take_view_transform(config_.getViewTransformNameByIndex(i));
        for (int i = 0; i < config_.getNumNamedTransforms(OCIO::NAMEDTRANSFORM_ALL); ++i)
            take_named(config_.getNamedTransformNameByIndex(OCIO::NAMEDTRANSFORM_ALL, i));
        for (int d = 0; d < config_.getNumDisplaysAll(); ++d) {
            const std::string display = config_.getDisplayAll(d);
            for (const OCIO::ViewType type : {OCIO::VIEW_DISPLAY_DEFINED, OCIO::VIEW_SHARED})
                for (int v = 0; v < config_.getNumViews(type, display.c_str()); ++v)
                    take_view(display, config_.getView(type, display.c_str(), v));
        }
    }

    /// Takes a part, which messages call so, once. `take_parts` adds up what it refers to: in
    /// either direction, since OpenColorIO follows both wherever it looks for variables.
    template <class TakeParts>
    Extent take(const std::string& part, const TakeParts& take_parts) {
        if (const auto again = std::ranges::find(open_, part); again != open_.end()) {
            std::string way;
            for (auto at = again; at != open_.end(); ++at) way += *at + " -> ";
            throw Fault{"its " + part + " refers to itself (" + way + part +
                        "); let one of them refer to something else"};
        }
        if (const auto known = known_.find(part); known != known_.end()) return known->second;
        open_.push_back(part);
        Extent extent = take_parts();
        ++extent.height;
        // Real configs have a tenth of either.
        constexpr std::size_t k_max_steps = 1000;
        constexpr int k_highest = 100;
        if (extent.height > k_highest || open_.size() > k_highest)
            throw Fault{"its " + part +
                        " is at the end of a chain of more than 100 references; shorten it"};
        if (extent.steps > k_max_steps)
            throw Fault{"its " + part + " takes more than 1000 steps; divide it"};
        open_.pop_back();
        return known_[part] = extent;
    }

    static std::string text(const char* words) { return words != nullptr ? words : ""; }
    static Extent sum(const Extent& a, const Extent& b) {
        return {a.steps + b.steps, std::max(a.height, b.height)};
    }

    /// A colour space, or a named transform in its place.
    Extent take_space(const std::string& name) {
        const std::string resolved = text(context_.resolveStringVar(name.c_str()));
        const OCIO::ConstColorSpaceRcPtr space = config_.getColorSpace(resolved.c_str());
        if (!space) return take_named(resolved);
        // Roles and aliases stand for one space.
        return take("colour space '" + text(space->getName()) + "'", [&] {
            return sum(take_transform(space->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE)),
                       take_transform(space->getTransform(OCIO::COLORSPACE_DIR_FROM_REFERENCE)));
        });
    }
    Extent take_named(const std::string& name) {
        const auto named = config_.getNamedTransform(name.c_str());
        if (!named) return {};  // OpenColorIO says so
        return take("named transform '" + text(named->getName()) + "'", [&] {
            return sum(take_transform(named->getTransform(OCIO::TRANSFORM_DIR_FORWARD)),
                       take_transform(named->getTransform(OCIO::TRANSFORM_DIR_INVERSE)));
        });
    }
    Extent take_look(const std::string& name) {
        const auto look = config_.getLook(name.c_str());
        if (!look) return {};
        return take("look '" + text(look->getName()) + "'", [&] {
            return sum(take_space(text(look->getProcessSpace())),
                       sum(take_transform(look->getTransform()),
                           take_transform(look->getInverseTransform())));
        });
    }
    Extent take_looks(const std::string& list) {
        Extent all;
        for (const std::string& look : looks_of(text(context_.resolveStringVar(list.c_str()))))
            all = sum(all, take_look(look));
        return all;
    }
    Extent take_view_transform(const std::string& name) {
        const auto view = config_.getViewTransform(name.c_str());
        if (!view) return {};
        return take("view transform '" + text(view->getName()) + "'", [&] {
            return sum(take_transform(view->getTransform(OCIO::VIEWTRANSFORM_DIR_TO_REFERENCE)),
                       take_transform(view->getTransform(OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE)));
        });
    }
    Extent take_view(const std::string& display, const std::string& view) {
        return take("view '" + view + "' of the display '" + display + "'", [&] {
            const char *d = display.c_str(), *v = view.c_str();
            std::string space = text(config_.getDisplayViewColorSpaceName(d, v));
            if (space == OCIO::OCIO_VIEW_USE_DISPLAY_NAME) space = display;
            const std::string transform = text(config_.getDisplayViewTransformName(d, v));
            const Extent all =
                sum(take_space(space), take_looks(text(config_.getDisplayViewLooks(d, v))));
            return transform.empty() ? all : sum(all, take_view_transform(transform));
        });
    }
    /// From one space to another; where one of them is a display's, by the config's own way there.
    Extent take_conversion(const std::string& from, const std::string& to) {
        const Extent all = sum(take_space(from), take_space(to));
        const auto is_of_display = [&](const std::string& name) {
            const auto space = config_.getColorSpace(context_.resolveStringVar(name.c_str()));
            return space && space->getReferenceSpaceType() == OCIO::REFERENCE_SPACE_DISPLAY;
        };
        const auto view = config_.getDefaultSceneToDisplayViewTransform();
        if (!view || is_of_display(from) == is_of_display(to)) return all;
        return sum(all, take_view_transform(text(view->getName())));
    }

    Extent take_transform(const OCIO::ConstTransformRcPtr& transform) {
        if (!transform) return {};
        using OCIO::DynamicPtrCast;
        Extent all{1, 0};
        if (const auto group = DynamicPtrCast<const OCIO::GroupTransform>(transform)) {
            for (int i = 0; i < group->getNumTransforms(); ++i)
                all = sum(all, take_transform(group->getTransform(i)));
        } else if (const auto file = DynamicPtrCast<const OCIO::FileTransform>(transform)) {
            take_file(*file);
        } else if (const auto space = DynamicPtrCast<const OCIO::ColorSpaceTransform>(transform)) {
            all = sum(all, take_conversion(text(space->getSrc()), text(space->getDst())));
        } else if (const auto look = DynamicPtrCast<const OCIO::LookTransform>(transform)) {
            all = sum(all, sum(take_looks(text(look->getLooks())),
                               take_conversion(text(look->getSrc()), text(look->getDst()))));
        } else if (const auto view = DynamicPtrCast<const OCIO::DisplayViewTransform>(transform)) {
            all = sum(all, sum(take_space(text(view->getSrc())),
                               take_view(text(view->getDisplay()), text(view->getView()))));
        }
        return all;
    }
    void take_file(const OCIO::FileTransform& file) {
        std::string path;
        try {
            path = context_.resolveFileLocation(file.getSrc());
        } catch (const OCIO::Exception&) {
            return;  // there is none, which matters only if the view needs it
        }
        if (files_.insert(path).second) check_(path);
    }

    const OCIO::Config& config_;
    OCIO::ConstContextRcPtr shared_;
    const OCIO::Context& context_;
    const Check& check_;
    std::vector<std::string> open_;  // what is being taken, from the outermost part on
    std::map<std::string, Extent> known_;
    std::set<std::string> files_;
};

/// What linear sRGB is in a config: a space of its own, or one that a matrix leads to.
struct Input {
    std::string space;
    bool is_aces = false;  // ACES2065-1, for which values are multiplied by k_aces_from_srgb
};

constexpr const char* k_aces_role = "aces_interchange";

/// Whether a space's primaries are those of sRGB: by what its red, green and blue are in
/// ACES2065-1.
bool has_primaries_of_srgb(const OCIO::Config& config, const char* space) {
    try {
        const auto processor = config.getProcessor(space, k_aces_role)->getDefaultCPUProcessor();
        // Two definitions of the same space differ by how they adapt its white; other primaries are
        // ten times as far away.
        constexpr float k_near = 0.02F;
        for (std::size_t c = 0; c < 3; ++c) {
            std::array<float, 3> rgb{};
            rgb.at(c) = 1;
            processor->applyRGB(rgb.data());
            for (std::size_t row = 0; row < 3; ++row)
                if (!(std::abs(rgb.at(row) - static_cast<float>(uw::k_aces_from_srgb[row][c])) <
                      k_near))
                    return false;
        }
        return true;
    } catch (const OCIO::Exception&) {
        return false;
    }
}

Input input_of(const OCIO::Config& config, const std::string& wanted, std::string& fault) {
    if (!wanted.empty()) {
        if (config.getColorSpace(wanted.c_str())) return {wanted};
        fault = missing("colour space", wanted, config.getNumColorSpaces(),
                        [&](int i) { return config.getColorSpaceNameByIndex(i); });
        return {};
    }
    // As the configs of ACES and of OpenColorIO's own examples call it.
    for (const char* name : {"lin_rec709", "Linear Rec.709 (sRGB)", "lin_srgb", "Linear Rec.709",
                             "Utility - Linear - sRGB", "Utility - Linear - Rec.709"})
        if (config.getColorSpace(name)) return {name};
    const bool has_aces = config.hasRole(k_aces_role);
    const bool has_linear = config.hasRole(OCIO::ROLE_SCENE_LINEAR);
    if (has_aces && !(has_linear && has_primaries_of_srgb(config, OCIO::ROLE_SCENE_LINEAR)))
        return {k_aces_role, true};
    if (has_linear) return {OCIO::ROLE_SCENE_LINEAR};
    fault =
        "which of its colour spaces is linear sRGB? It has neither lin_rec709 nor the roles "
        "aces_interchange and scene_linear; add input: NAME to render.view";
    return {};
}

class OpenColorIOView : public uw::ColourView {
  public:
    OpenColorIOView(OCIO::ConstCPUProcessorRcPtr processor, bool is_aces)
        : processor_(std::move(processor)), is_aces_(is_aces) {}

    void apply(std::span<float> rgb) const override {
        if (is_aces_)
            for (std::size_t i = 0; i + 2 < rgb.size(); i += 3)
                uw::srgb_to_aces(rgb.subspan(i).first<3>());
        OCIO::PackedImageDesc image(rgb.data(), static_cast<long>(rgb.size() / 3), 1, 3);
        processor_->apply(image);
    }

  private:
    OCIO::ConstCPUProcessorRcPtr processor_;
    bool is_aces_;
};

/// Whether each look in a list such as "+neutral, -grade" exists.
bool has_looks(const OCIO::Config& config, const std::string& looks, std::string& fault) {
    for (const std::string& look : looks_of(looks)) {
        if (config.getLook(look.c_str())) continue;
        fault = missing("look", look, config.getNumLooks(),
                        [&](int i) { return config.getLookNameByIndex(i); });
        return false;
    }
    return true;
}

std::shared_ptr<uw::ColourView> make_view(const uw::ViewRequest& request, std::string& fault) {
    OCIO::SetLoggingLevel(OCIO::LOGGING_LEVEL_NONE);
    const OCIO::ConstConfigRcPtr config = OCIO::Config::CreateFromFile(request.config.c_str());
    fault = ConfigWalk(*config, request.check).fault();
    if (!fault.empty()) return nullptr;
    const std::string display =
        request.display.empty() ? config->getDefaultDisplay() : request.display;
    const int views = config->getNumViews(display.c_str());
    if (views == 0) {
        fault = missing("display", display, config->getNumDisplays(),
                        [&](int i) { return config->getDisplay(i); });
        return nullptr;
    }
    const std::string view =
        request.view.empty() ? config->getDefaultView(display.c_str()) : request.view;
    // Exact names: what OpenColorIO would accept besides is not in its lists.
    bool is_known = false;
    for (int i = 0; i < views; ++i) is_known |= view == config->getView(display.c_str(), i);
    if (!is_known) {
        fault = missing("view", view, views,
                        [&](int i) { return config->getView(display.c_str(), i); }) +
                " for the display '" + display + "'";
        return nullptr;
    }
    if (!has_looks(*config, request.look, fault)) return nullptr;
    const Input input = input_of(*config, request.input, fault);
    if (!fault.empty()) return nullptr;

    const auto transform = OCIO::DisplayViewTransform::Create();
    transform->setSrc(input.space.c_str());
    transform->setDisplay(display.c_str());
    transform->setView(view.c_str());
    const auto pipeline = OCIO::LegacyViewingPipeline::Create();
    pipeline->setDisplayViewTransform(transform);
    if (!request.look.empty()) {
        pipeline->setLooksOverrideEnabled(true);
        pipeline->setLooksOverride(request.look.c_str());
    }
    const OCIO::ConstProcessorRcPtr processor = pipeline->getProcessor(config);
    auto made =
        std::make_shared<OpenColorIOView>(processor->getDefaultCPUProcessor(), input.is_aces);
    made->name = view + " / " + display + (request.look.empty() ? "" : ", " + request.look);
    made->files.emplace_back(request.config);
    const auto about = processor->getProcessorMetadata();
    for (int i = 0; i < about->getNumFiles(); ++i) made->files.emplace_back(about->getFile(i));
    return made;
}

}  // namespace

extern "C" uw::MakeView uwvdb_make_view_2;

extern "C" void uwvdb_make_view_2(const uw::ViewRequest& request,
                                  std::shared_ptr<uw::ColourView>& view, std::string& fault) {
    try {
        view = make_view(request, fault);
    } catch (const OCIO::Exception& error) {
        fault = "OpenColorIO cannot use it: " + one_line(error.what());
    }
}
