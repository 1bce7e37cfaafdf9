#include "render/scene_variations.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/variations/key_overlap.h"
#include "core/scene/variations/variations_reader.h"
#include "core/scene/yaml/scene_override.h"
#include "core/scene/yaml/scene_reader.h"
#include "core/scene/yaml/yaml_document.h"
#include "render/scene_loading.h"

namespace uw {
namespace {

constexpr std::size_t k_longest_value = 80;    // in messages
constexpr std::size_t k_longest_values = 300;  // likewise, of all of them

/// Where a drawn value comes from, as the place of faults in it.
std::string origin_of(const DrawnValue& value, int variation) {
    return fmt::format("{}: variation {}: {}", value.where, variation,
                       printable(value.override_text(), k_longest_value));
}

void refuse_overrides_of_drawn(const ConfigNode& tree, const VariationsDesc& desc,
                               const std::vector<std::string>& overrides) {
    for (const std::string& text : overrides)
        for (const std::string& key : drawn_keys(desc))
            if (is_part_of(tree, text.substr(0, text.find('=')), key))
                throw UsageError(fmt::format(
                    "--set {}: the variations draw {}, so this would have no effect; leave it out, "
                    "or take the key out of variations",
                    printable(text, k_longest_value), printable(key)));
}

}  // namespace

SceneVariations::SceneVariations(const std::filesystem::path& file,
                                 const std::vector<std::string>& overrides)
    : file_(file), tree_(read_scene_tree(file, overrides)), desc_(read_variations(tree_, file)) {
    if (desc_) refuse_overrides_of_drawn(tree_, *desc_, overrides);
}

SceneVariations::SceneVariations(ConfigNode tree, std::filesystem::path file)
    : file_(std::move(file)), tree_(std::move(tree)), desc_(read_variations(tree_, file_)) {}

VariedScene SceneVariations::varied(int variation, const SceneArrays* arrays) const {
    ConfigNode tree = tree_;
    const std::vector<DrawnValue> drawn = values(variation);
    try {
        for (const DrawnValue& value : drawn) {
            const std::string place = origin_of(value, variation);
            set_value(tree, value.key, parse_yaml_value(value.text, place), place);
        }
        SceneDesc desc = load_scene_tree(tree, file_, arrays);
        return {std::move(tree), std::move(desc)};
    } catch (const InputError& fault) {
        // What lies in one of the values says so itself.
        const std::string_view what = fault.what();
        for (const DrawnValue& value : drawn)
            if (what.starts_with(origin_of(value, variation))) throw;
        throw InputError(fmt::format("{} (variation {}: {})", what, variation,
                                     printable(values_text(drawn), k_longest_values)));
    } catch (const IoError& fault) {
        throw IoError(fmt::format("{} (variation {}: {})", fault.what(), variation,
                                  printable(values_text(drawn), k_longest_values)));
    }
}

}  // namespace uw
