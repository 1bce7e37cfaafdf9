#include "core/scene/variations/draw.h"

#include <algorithm>
#include <cstddef>

#include "core/scene/text/number_text.h"
#include "core/scene/variations/draw_random.h"

namespace uw {
namespace {

std::size_t index_of(const Shares& shares, double u) {
    const auto found = std::ranges::upper_bound(shares.up_to, u);
    return static_cast<std::size_t>(found - shares.up_to.begin());
}

struct TextOf {
    double u;  // uniform in (0, 1)

    std::string operator()(const std::string& constant) const { return constant; }
    std::string operator()(const NumberDistribution& distribution) const {
        return number_text(quantile(distribution, u));
    }
    std::string operator()(const ChoiceOfTexts& choice) const {
        return choice.texts[index_of(choice.shares, u)];
    }
};

std::string text_of(const DrawnKey& key, std::uint64_t seed, int variation) {
    std::string text;
    for (std::size_t i = 0; i < key.components.size(); ++i)
        text += (i > 0 ? ", " : "") +
                std::visit(TextOf{draw_random(seed, key.key, i, variation)}, key.components[i]);
    return key.is_list ? "[" + text + "]" : text;
}

}  // namespace

std::vector<std::string> drawn_keys(const VariationsDesc& variations) {
    std::vector<std::string> keys;
    for (const DrawnKey& key : variations.keys) keys.push_back(key.key);
    for (const DrawnRows& rows : variations.together)
        keys.insert(keys.end(), rows.keys.begin(), rows.keys.end());
    return keys;
}

std::vector<DrawnValue> draw(const VariationsDesc& variations, int variation) {
    std::vector<DrawnValue> values;
    for (const DrawnKey& key : variations.keys)
        values.push_back({key.key, text_of(key, variations.seed, variation), key.where});
    for (const DrawnRows& together : variations.together) {
        const double u = draw_random(variations.seed, together.keys.front(), 0, variation);
        const DrawnRows::Row& row = together.rows[index_of(together.shares, u)];
        for (std::size_t i = 0; i < row.texts.size(); ++i)
            values.push_back({together.keys[i], row.texts[i], row.where});
    }
    return values;
}

std::string values_text(const std::vector<DrawnValue>& values) {
    std::string text;
    for (const DrawnValue& value : values)
        text += (text.empty() ? "" : ", ") + value.override_text();
    return text;
}

}  // namespace uw
