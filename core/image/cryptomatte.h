#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/pixel_image.h"

namespace uw {

/// Cryptomatte (Friedman and Jones 2015; specification 1.2): a pixel holds the identifiers of what
/// it shows, each with the fraction of the pixel that it covers, from the largest fraction on.
/// Compositors make a matte of any name from them.

/// Identifiers of a pixel in a matte's layer, and the channels for them and their fractions.
inline constexpr std::size_t k_matte_ranks = 6, k_matte_values = 2 * k_matte_ranks;

/// MurmurHash3_x86_32 of a text, with seed 0.
std::uint32_t murmur_hash_3(std::string_view text);

/// The identifier of a name: the float with the bits of its hash, of which one is changed where
/// they would be no normal number.
float matte_id(std::string_view name);

/// What the names of a matte's layer belong to.
enum class MatteOf : std::uint8_t { objects, materials };

/// The channels of a matte's layer: `CryptoObject00.R` and so on.
std::vector<std::string> matte_channels(MatteOf of);

/// Adds to an image's header what compositors read of a matte's layer, with the identifier of each
/// of `names`.
void add_matte_header(MatteOf of, std::span<const std::string> names, ImageMetadata& metadata);

/// What a pixel shows; 0 is nothing.
struct Matte {
    float id;
    double fraction;
};

/// Adds a fraction to that of the same identifier.
void add_matte(float id, double fraction, std::vector<Matte>& mattes);

/// Writes the largest fractions in the order of Cryptomatte, and 0 into the channels left. Sorts
/// `mattes`.
void store_mattes(std::vector<Matte>& mattes, std::span<float> channels);

/// Makes of a mean that with `more`, whose weight in it is `weight`. Fractions that are the same in
/// both stay as they are, to the bit.
void mix_mattes(std::span<const float> more, double weight, std::span<float> mean);

}  // namespace uw
