#include "core/image/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <set>
#include <tuple>

#include "core/base/json_string.h"

namespace uw {

namespace {

std::string_view typename_of(MatteOf of) {
    return of == MatteOf::objects ? "CryptoObject" : "CryptoMaterial";
}

std::uint32_t scrambled(std::uint32_t block) {
    return std::rotl(block * 0xcc9e2d51U, 15) * 0x1b873593U;
}

}  // namespace

std::uint32_t murmur_hash_3(std::string_view text) {
    const auto byte = [&](std::size_t i) {
        return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
    };
    std::uint32_t hash = 0;
    std::size_t at = 0;
    for (; at + 4 <= text.size(); at += 4) {
        const std::uint32_t block =
            byte(at) | byte(at + 1) << 8U | byte(at + 2) << 16U | byte(at + 3) << 24U;
        hash = std::rotl(hash ^ scrambled(block), 13) * 5 + 0xe6546b64U;
    }
    std::uint32_t rest = 0;
    for (std::size_t i = text.size(); i > at; --i) rest = rest << 8U | byte(i - 1);
    hash ^= scrambled(rest);
    hash ^= static_cast<std::uint32_t>(text.size());
    hash = (hash ^ hash >> 16U) * 0x85ebca6bU;
    hash = (hash ^ hash >> 13U) * 0xc2b2ae35U;
    return hash ^ hash >> 16U;
}

float matte_id(std::string_view name) {
    std::uint32_t hash = murmur_hash_3(name);
    const std::uint32_t exponent = hash >> 23U & 255U;
    if (exponent == 0 || exponent == 255) hash ^= 1U << 23U;
    return std::bit_cast<float>(hash);
}

std::vector<std::string> matte_channels(MatteOf of) {
    std::vector<std::string> names;
    for (std::size_t rank = 0; rank < k_matte_ranks; rank += 2)
        for (const char channel : {'R', 'G', 'B', 'A'})
            names.push_back(fmt::format("{}{:02}.{}", typename_of(of), rank / 2, channel));
    return names;
}

void add_matte_header(MatteOf of, std::span<const std::string> names, ImageMetadata& metadata) {
    const std::string name(typename_of(of));
    const std::string key =
        "cryptomatte/" + fmt::format("{:08x}", murmur_hash_3(name)).substr(0, 7) + "/";
    // The set has each name once.
    std::string manifest;
    for (const std::string& of_surface : std::set(names.begin(), names.end()))
        manifest +=
            fmt::format("{}{}:\"{:08x}\"", manifest.empty() ? "{" : ",", json_string(of_surface),
                        std::bit_cast<std::uint32_t>(matte_id(of_surface)));
    metadata[key + "name"] = name;
    metadata[key + "hash"] = std::string("MurmurHash3_32");
    metadata[key + "conversion"] = std::string("uint32_to_float32");
    metadata[key + "manifest"] = manifest.empty() ? "{}" : manifest + "}";
}

void add_matte(float id, double fraction, std::vector<Matte>& mattes) {
    if (id == 0 || !(fraction > 0)) return;
    const auto same = std::ranges::find(mattes, id, &Matte::id);
    if (same == mattes.end())
        mattes.push_back({id, fraction});
    else
        same->fraction += fraction;
}

void store_mattes(std::vector<Matte>& mattes, std::span<float> channels) {
    std::ranges::sort(mattes, [](const Matte& a, const Matte& b) {
        return std::tuple(-a.fraction, a.id) < std::tuple(-b.fraction, b.id);
    });
    std::ranges::fill(channels, 0.0F);
    for (std::size_t i = 0; i < std::min(mattes.size(), k_matte_ranks); ++i) {
        channels[2 * i] = mattes[i].id;
        channels[2 * i + 1] = static_cast<float>(mattes[i].fraction);
    }
}

void mix_mattes(std::span<const float> more, double weight, std::span<float> mean) {
    std::vector<Matte> mattes;
    const auto fraction_in = [](std::span<const float> list, float id) {
        for (std::size_t i = 0; i < list.size(); i += 2)
            if (list[i] == id) return static_cast<double>(list[i + 1]);
        return 0.0;
    };
    for (std::size_t i = 0; i < mean.size(); i += 2) {
        const auto before = static_cast<double>(mean[i + 1]);
        add_matte(mean[i], before + weight * (fraction_in(more, mean[i]) - before), mattes);
    }
    for (std::size_t i = 0; i < more.size(); i += 2)
        if (fraction_in(mean, more[i]) == 0)
            add_matte(more[i], weight * static_cast<double>(more[i + 1]), mattes);
    store_mattes(mattes, mean);
}

}  // namespace uw
