#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/output_files.h"
#include "core/image/film.h"
#include "core/image/pixel_image.h"

namespace uw {

/// How the lines of an EXR are compressed, all without loss: not at all, by deflate each line by
/// itself, or in blocks of 16.
enum class ExrCompression : std::uint8_t { none, zips, zip };

struct ExrChannel {
    std::string name;
    bool is_half = false;  // else a 32-bit float
};

/// How an image is stored as an EXR.
struct ExrOptions {
    /// How the channels of light (is_light) are stored; all others are 32-bit floats. Automatic
    /// means half floats, whose 11 bits are finer than the image is exact, where R G B A and
    /// `total` are its only light and half floats can hold it (half_loss); else 32-bit floats,
    /// whose layers add up.
    enum class Precision { automatic, half, single };
    Precision precision = Precision::automatic;
    ExrCompression compression = ExrCompression::zip;
    /// An ACES image container (SMPTE ST 2065-4): R, G, B and A alone, converted from linear sRGB
    /// to ACES2065-1. It has half floats and no compression.
    bool is_aces = false;

    static ExrOptions aces() { return {Precision::half, ExrCompression::none, true}; }
};

/// Their words on the command line.
inline constexpr std::array<std::pair<std::string_view, ExrOptions::Precision>, 3>
    k_precision_names{{{"auto", ExrOptions::Precision::automatic},
                       {"half", ExrOptions::Precision::half},
                       {"float", ExrOptions::Precision::single}}};
inline constexpr std::array<std::pair<std::string_view, ExrCompression>, 3> k_compression_names{
    {{"zip", ExrCompression::zip}, {"zips", ExrCompression::zips}, {"none", ExrCompression::none}}};

/// What half floats cannot hold of the light of an image.
struct HalfLoss {
    std::size_t too_large = 0;  // finite values that would become infinite
    /// Whether the mean of a channel is so small, and not 0, that the rounding of small values to
    /// multiples of 2^-24 is more than 1e-4 of it.
    bool too_dark = false;

    bool is_none() const { return too_large == 0 && !too_dark; }
};
HalfLoss half_loss(const Film& film);

/// The channels of `film`, sorted by name, as they are to be stored.
std::vector<ExrChannel> exr_channels(const Film& film, ExrOptions::Precision precision);

/// Whether an image with these channels may have been stored with this precision.
bool is_stored_with(ExrOptions::Precision precision, std::span<const ExrChannel> channels);

/// Whether each attribute in the headers of an EXR file is as long as it says: OpenEXR makes room
/// for an attribute, and fills it with zeros, before it looks whether the file holds as much. What
/// else may be wrong is left to OpenEXR. False if the file cannot be read.
bool exr_attributes_fit(const std::filesystem::path& file);

/// Decodes an OpenEXR in memory, of several parts the first: red, green and blue, or one channel,
/// and alpha if there is one. Values are as they are in the file. Messages call it `name`. Throws
/// InputError if it is damaged or too large, if it is deep, or if not all of it is stored.
PixelImage read_exr(std::span<const std::byte> encoded, const std::string& name);

/// The same for the channel that `choose` picks from the names of all, in alphabetical order.
PixelImage read_exr_channel(
    std::span<const std::byte> encoded, const std::string& name,
    const std::function<std::string(const std::vector<std::string>& channels)>& choose);

/// The header of an OpenEXR file of one part, stored by scanlines from the top.
struct ExrHeader {
    int width = 0, height = 0;         // of the whole image, the display window
    PixelWindow window;                // of the pixels stored, the data window
    std::vector<ExrChannel> channels;  // sorted by name
    ExrCompression compression = ExrCompression::zip;
    ImageMetadata metadata;
};

/// The entry of the metadata that says what R, G and B are, and its value where they are linear
/// sRGB or ACES2065-1: an EXR then states the primaries and the white in its attribute
/// `chromaticities` as well, and of ACES2065-1 that it is an ACES image container.
inline constexpr const char* k_rgb_space = "uwvdb/rgb_space";
inline constexpr std::string_view k_linear_srgb = "linear sRGB", k_aces = "ACES2065-1";

/// Writes all of an EXR with the film's pixels, on all permitted threads, of whose number its bytes
/// are independent. The film has each channel of `header`, and its window. Throws IoError if
/// OpenEXR refuses, and Interrupted; what cannot be written is for out.commit() to report.
void write_exr_file(OutputFile& out, const Film& film, const ExrHeader& header);

/// The header of a file; empty if it cannot be read or is not one that `write_exr_file` could have
/// written.
std::optional<ExrHeader> read_exr_header(const std::filesystem::path& file);

}  // namespace uw
