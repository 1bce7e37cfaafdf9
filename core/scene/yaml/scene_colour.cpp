#include "core/scene/yaml/config_map.h"
#include "core/scene/yaml/scene_sections.h"

namespace uw {

ColourDesc read_colour(ConfigMap& map, const SceneContext& context) {
    using Response = ColourDesc::Response;
    ColourDesc colour;
    colour.where = map.value().location() + ".response";
    if (const auto entry = map.find("response")) {
        colour.where = entry->location();
        const std::string text =
            entry->text("write cie, bands, or the name of a camera's CSV file");
        if (text.ends_with(".csv")) {
            colour.response = Response::camera;
            colour.file = read_existing_file(*entry, context);
        } else {
            constexpr std::array<std::pair<std::string_view, Response>, 3> k_responses{
                {{"auto", Response::automatic},
                 {"bands", Response::bands},
                 {"cie", Response::cie}}};
            colour.response = entry->choice(k_responses);
        }
        if (colour.response == Response::bands && context.band_count != 3)
            entry->fail("only three bands can be R, G and B themselves; write response: cie");
    }
    const auto white = map.find("white");
    if (!white) return colour;
    const bool bands_themselves =
        colour.response == Response::bands ||
        (colour.response == Response::automatic && context.band_count == 3);
    if (bands_themselves)
        white->fail("R, G and B are the three bands themselves; write response: cie beside it");
    if (white->node().kind == ConfigNode::Kind::scalar) {
        constexpr std::array<std::pair<std::string_view, bool>, 1> k_words{{{"none", true}}};
        colour.raw = white->choice(k_words);
    } else {
        colour.white = read_spectrum(*white, context);
    }
    return colour;
}

}  // namespace uw
