#include "core/scene/variations/distribution_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/text.h"
#include "core/scene/text/flow_text.h"
#include "core/scene/yaml/config_map.h"

namespace uw {
namespace {

constexpr auto k_kinds =
    std::to_array<std::string_view>({"uniform", "log-uniform", "normal", "integer", "choice"});

/// Two numbers, the first below the second.
std::array<double, 2> interval(const ConfigValue& value) {
    constexpr auto k_interval_mend = "give [lowest, highest]";
    const std::vector<ConfigValue> ends = value.list_of(2, k_interval_mend);
    const std::array<double, 2> numbers{ends[0].number(k_interval_mend),
                                        ends[1].number(k_interval_mend)};
    if (numbers[0] >= numbers[1])
        value.fail(fmt::format("{} is not below {}; {}", numbers[0], numbers[1], k_interval_mend));
    return numbers;
}

LogUniformDistribution log_uniform(const ConfigValue& value) {
    const auto [low, high] = interval(value);
    if (low <= 0) value.fail("logarithms need numbers above 0; give [lowest, highest]");
    return {low, high};
}

IntegerDistribution integer(const ConfigValue& value) {
    constexpr auto k_integer_mend = "give two whole numbers, [lowest, highest]";
    interval(value);
    const std::vector<ConfigValue> ends = value.list_of(2, k_integer_mend);
    constexpr int k_largest = std::numeric_limits<int>::max();
    return {ends[0].integer(-k_largest, k_largest, k_integer_mend),
            ends[1].integer(-k_largest, k_largest, k_integer_mend)};
}

NormalDistribution normal(const ConfigValue& value, const std::optional<ConfigValue>& within) {
    const std::vector<ConfigValue> numbers = value.list_of(2, "give [mean, standard deviation]");
    NormalDistribution d{numbers[0].number("give the mean"),
                         numbers[1].positive("give the standard deviation")};
    if (!within) return d;
    const std::array<double, 2> ends = interval(*within);
    d.low = ends[0];
    d.high = ends[1];
    constexpr double k_least_probability = 1e-6;  // a mistake rather than a wish
    if (normal_probability((d.low - d.mean) / d.deviation, (d.high - d.mean) / d.deviation) <
        k_least_probability)
        within->fail("less than a millionth of the distribution lies within; widen it");
    return d;
}

ChoiceOfTexts choice(const ConfigValue& value, const std::optional<ConfigValue>& weights) {
    ChoiceOfTexts result;
    for (const ConfigValue& one : value.list("give a list of values"))
        result.texts.push_back(flow_text(one.node()));
    if (result.texts.empty()) value.fail("is an empty list; give values to choose from");
    result.shares = read_shares(result.texts.size(), weights, value);
    return result;
}

}  // namespace

Shares shares_of(std::size_t count, std::vector<double> weights, const ConfigValue& where) {
    if (weights.empty()) weights.assign(count, 1);
    Shares shares;
    std::partial_sum(weights.begin(), weights.end(), std::back_inserter(shares.up_to));
    const double sum = shares.up_to.back();
    if (sum <= 0) where.fail("no weight is above 0; give one that is");
    for (double& share : shares.up_to) share /= sum;
    // What has no weight at the end must not be reached by rounding.
    const double last = shares.up_to.back();
    for (double& share : shares.up_to)
        if (share == last) share = 1;
    return shares;
}

Shares read_shares(std::size_t count, const std::optional<ConfigValue>& weights,
                   const ConfigValue& of) {
    if (!weights) return shares_of(count, {}, of);
    std::vector<double> numbers;
    for (const ConfigValue& weight : weights->list_of(count, "give a weight for each"))
        numbers.push_back(weight.non_negative("give a weight, such as 1"));
    return shares_of(count, std::move(numbers), *weights);
}

bool is_distribution(const ConfigNode& node) {
    return std::ranges::any_of(k_kinds, [&](auto kind) { return node.find(kind) != nullptr; });
}

DrawnFrom read_distribution(const ConfigValue& value) {
    ConfigMap map(value,
                  {"uniform", "log-uniform", "normal", "integer", "choice", "within", "weights"},
                  k_distribution_mend);
    const auto is_given = [&](std::string_view kind) { return map.has(kind); };
    const auto kind = std::ranges::find_if(k_kinds, is_given);
    if (kind == k_kinds.end())
        value.fail(fmt::format("names no distribution; use one of {}", alternatives(k_kinds)));
    const ConfigValue numbers = *map.find(*kind);
    DrawnFrom result;
    if (*kind == "uniform") {
        const auto [low, high] = interval(numbers);
        result = UniformDistribution{low, high};
    } else if (*kind == "log-uniform") {
        result = log_uniform(numbers);
    } else if (*kind == "normal") {
        result = normal(numbers, map.find("within"));
    } else if (*kind == "integer") {
        result = integer(numbers);
    } else {
        result = choice(numbers, map.find("weights"));
    }
    map.finish(fmt::format("'{}'", *kind));
    return result;
}

}  // namespace uw
