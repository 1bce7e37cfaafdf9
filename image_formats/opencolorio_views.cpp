#include <OpenColorIO/OpenColorIO.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

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

void tell_files(const OCIO::ConstTransformRcPtr& transform, const OCIO::Context& context,
                const Check& check) {
    if (const auto group = OCIO_DYNAMIC_POINTER_CAST<const OCIO::GroupTransform>(transform))
        for (int i = 0; i < group->getNumTransforms(); ++i)
            tell_files(group->getTransform(i), context, check);
    const auto file = OCIO_DYNAMIC_POINTER_CAST<const OCIO::FileTransform>(transform);
    if (!file) return;
    std::string path;
    try {
        path = context.resolveFileLocation(file->getSrc());
    } catch (const OCIO::Exception&) {
        return;  // there is none, which matters only if the view needs it
    }
    check(path);
}

/// Every file that any part of the config refers to.
void tell_files(const OCIO::Config& config, const Check& check) {
    const OCIO::ConstContextRcPtr shared = config.getCurrentContext();
    const OCIO::Context& context = *shared;
    const int spaces =
        config.getNumColorSpaces(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL);
    for (int i = 0; i < spaces; ++i) {
        const auto space = config.getColorSpace(config.getColorSpaceNameByIndex(
            OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL, i));
        if (!space) continue;
        tell_files(space->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE), context, check);
        tell_files(space->getTransform(OCIO::COLORSPACE_DIR_FROM_REFERENCE), context, check);
    }
    for (int i = 0; i < config.getNumLooks(); ++i) {
        const auto look = config.getLook(config.getLookNameByIndex(i));
        tell_files(look->getTransform(), context, check);
        tell_files(look->getInverseTransform(), context, check);
    }
    for (int i = 0; i < config.getNumViewTransforms(); ++i) {
        const auto view = config.getViewTransform(config.getViewTransformNameByIndex(i));
        tell_files(view->getTransform(OCIO::VIEWTRANSFORM_DIR_TO_REFERENCE), context, check);
        tell_files(view->getTransform(OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE), context, check);
    }
    for (int i = 0; i < config.getNumNamedTransforms(); ++i) {
        const auto named = config.getNamedTransform(config.getNamedTransformNameByIndex(i));
        tell_files(named->getTransform(OCIO::TRANSFORM_DIR_FORWARD), context, check);
        tell_files(named->getTransform(OCIO::TRANSFORM_DIR_INVERSE), context, check);
    }
}

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
bool has_looks(const OCIO::Config& config, std::string_view looks, std::string& fault) {
    while (!looks.empty()) {
        const std::size_t end = looks.find_first_of(",:|");
        std::string look(looks.substr(0, end));
        looks = end == std::string_view::npos ? std::string_view() : looks.substr(end + 1);
        constexpr const char* k_blanks = " \t";
        look.erase(0, look.find_first_not_of(k_blanks));
        look.erase(look.find_last_not_of(k_blanks) + 1);
        if (!look.empty() && (look.front() == '+' || look.front() == '-')) look.erase(0, 1);
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
    tell_files(*config, request.check);
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
