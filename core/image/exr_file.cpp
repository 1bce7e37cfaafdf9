#include "core/image/exr_file.h"

#include <Imath/half.h>
#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfTileDescription.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <exception>
#include <fstream>
#include <functional>
#include <istream>
#include <limits>
#include <new>
#include <span>
#include <streambuf>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/parallel.h"
#include "core/image/exr_stream.h"
#include "core/image/layers.h"

namespace uw {

namespace {

// Half floats below 2^-14 are rounded by up to 2^-25, which is 1.2e-4 of this.
constexpr double k_min_mean = 0x1p-12;
// What is rounded to an infinite half float: this and more. The largest finite one is 65504.
constexpr float k_infinite_half = 65520.0F;
constexpr float k_infinity = std::numeric_limits<float>::infinity();

std::vector<std::size_t> light_channels(const Film& film) {
    std::vector<std::size_t> channels;
    for (std::size_t c = 0; c < film.channel_names().size(); ++c)
        if (is_light(film.channel_names()[c])) channels.push_back(c);
    return channels;
}

/// Whether there is no light beside that of the image itself.
bool has_no_more_light(std::span<const std::string> channel_names) {
    return std::ranges::all_of(channel_names, [](const std::string& name) {
        return !is_light(name) || is_image_channel(name);
    });
}

}  // namespace

HalfLoss half_loss(const Film& film) {
    struct Line {
        std::vector<double> sums;
        std::size_t too_large = 0, pixels = 0;
    };
    const PixelWindow& window = film.window();
    const std::vector<std::size_t> channels = light_channels(film);
    std::vector<Line> lines(static_cast<std::size_t>(window.height()));
    parallel_for(lines.size(), [&](std::size_t i) {
        Line& line = lines[i];
        const int y = window.y0 + static_cast<int>(i);
        for (int x = window.x0; x < window.x1; ++x)
            if (film.pixel(x, y)[k_alpha] > 0) ++line.pixels;
        for (const std::size_t channel : channels) {
            double sum = 0;
            for (int x = window.x0; x < window.x1; ++x) {
                const float value = std::abs(film.pixel(x, y)[channel]);
                if (value >= k_infinite_half && value < k_infinity) ++line.too_large;
                sum += static_cast<double>(value);
            }
            line.sums.push_back(sum);
        }
    });
    HalfLoss loss;
    Line all{std::vector<double>(channels.size())};
    for (const Line& line : lines) {
        for (std::size_t c = 0; c < channels.size(); ++c) all.sums[c] += line.sums[c];
        all.pixels += line.pixels;
        loss.too_large += line.too_large;
    }
    const double least = k_min_mean * static_cast<double>(all.pixels);
    loss.too_dark = std::ranges::any_of(all.sums, [&](double s) { return s > 0 && s < least; });
    return loss;
}

std::vector<ExrChannel> exr_channels(const Film& film, ExrOptions::Precision precision) {
    using enum ExrOptions::Precision;
    bool is_half = precision == half;
    if (precision == automatic && has_no_more_light(film.channel_names()))
        is_half = half_loss(film).is_none();
    std::vector<ExrChannel> channels;
    for (const std::string& name : film.channel_names())
        channels.push_back({name, is_half && is_light(name)});
    std::ranges::sort(channels, {}, &ExrChannel::name);
    return channels;
}

bool is_stored_with(ExrOptions::Precision precision, std::span<const ExrChannel> channels) {
    using enum ExrOptions::Precision;
    std::vector<std::string> names;
    for (const ExrChannel& channel : channels) names.push_back(channel.name);
    const auto matches = [&](bool is_half) {
        return std::ranges::all_of(channels, [&](const ExrChannel& c) {
            return c.is_half == (is_half && is_light(c.name));
        });
    };
    const bool may_be_half =
        precision == half || (precision == automatic && has_no_more_light(names));
    return (may_be_half && matches(true)) || (precision != half && matches(false));
}

namespace {

static_assert(std::endian::native == std::endian::little, "files are read as they lie");

template <class T>
bool take(std::istream& in, T& value) {
    return static_cast<bool>(in.read(reinterpret_cast<char*>(&value), sizeof value));
}

/// Names, of at most 255 characters, end with a zero.
bool take_name(std::istream& in, bool& is_empty) {
    std::array<char, 256> name{};
    in.getline(name.data(), name.size(), '\0');
    is_empty = name[0] == '\0';
    return static_cast<bool>(in) && !in.eof();
}

}  // namespace

namespace {

bool attributes_fit(std::istream& in, std::int64_t bytes) {
    std::uint32_t magic = 0, version = 0;
    if (!take(in, magic) || !take(in, version)) return false;
    constexpr std::uint32_t k_several_parts = 0x1000;
    for (;;) {
        bool is_end = false, is_untyped = false;
        if (!take_name(in, is_end)) return false;
        if (is_end) {  // of this header; a further empty name ends those of several parts
            if ((version & k_several_parts) == 0 || in.peek() == 0) return true;
            continue;
        }
        std::int32_t size = 0;
        if (!take_name(in, is_untyped) || !take(in, size)) return false;
        if (size < 0 || size > bytes - in.tellg()) return false;
        in.seekg(size, std::ios::cur);
    }
}

}  // namespace

bool exr_attributes_fit(const std::filesystem::path& file) {
    std::error_code error;
    const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(file, error));
    std::ifstream in = open_own_file(file);
    return !error && attributes_fit(in, bytes);
}

namespace {

/// Lines that OpenEXR compresses together, on one thread.
constexpr int k_block_lines = 16;
/// Lines handed over together, of which those of half floats are converted first.
constexpr int k_lines_at_once = 128;
/// Values that one thread compresses in a tenth to two tenths of a second. Between two such
/// portions a stop is noticed; smaller ones would have threads wait for each other.
constexpr double k_thread_values = 1.5e6;
/// More effort than the least, at no measurable cost.
constexpr int k_zip_level = 2;

constexpr std::array<std::pair<ExrCompression, Imf::Compression>, 3> k_compressions{
    {{ExrCompression::none, Imf::NO_COMPRESSION},
     {ExrCompression::zips, Imf::ZIPS_COMPRESSION},
     {ExrCompression::zip, Imf::ZIP_COMPRESSION}}};

/// Red, green, blue and white (D65) of IEC 61966-2-1.
const Imf::Chromaticities k_srgb_chromaticities{
    {0.64F, 0.33F}, {0.30F, 0.60F}, {0.15F, 0.06F}, {0.3127F, 0.3290F}};

/// AP0 and the white of ACES (SMPTE ST 2065-1).
constexpr float k_aces_white_x = 0.32168F, k_aces_white_y = 0.33767F;
const Imf::Chromaticities k_aces_chromaticities{
    {0.7347F, 0.2653F}, {0.0F, 1.0F}, {0.0001F, -0.0770F}, {k_aces_white_x, k_aces_white_y}};

}  // namespace

Imf::Header openexr_header(const ExrHeader& header) {
    const PixelWindow& window = header.window;
    Imf::Header result({{0, 0}, {header.width - 1, header.height - 1}},
                       {{window.x0, window.y0}, {window.x1 - 1, window.y1 - 1}});
    for (const auto& [ours, theirs] : k_compressions)
        if (ours == header.compression) result.compression() = theirs;
    result.zipCompressionLevel() = k_zip_level;
    for (const ExrChannel& channel : header.channels)
        result.channels().insert(channel.name,
                                 Imf::Channel(channel.is_half ? Imf::HALF : Imf::FLOAT));
    for (const auto& [name, value] : header.metadata) {
        if (const auto* text = std::get_if<std::string>(&value))
            result.insert(name, Imf::StringAttribute(*text));
        else
            result.insert(name, Imf::FloatAttribute(static_cast<float>(std::get<double>(value))));
    }
    const auto space = header.metadata.find(k_rgb_space);
    const auto is_space = [&](std::string_view name) {
        return space != header.metadata.end() &&
               space->second == ImageMetadata::mapped_type(std::string(name));
    };
    if (is_space(k_linear_srgb)) Imf::addChromaticities(result, k_srgb_chromaticities);
    if (is_space(k_aces)) {
        Imf::addChromaticities(result, k_aces_chromaticities);
        Imf::addAdoptedNeutral(result, {k_aces_white_x, k_aces_white_y});
        result.insert("acesImageContainerFlag", Imf::IntAttribute(1));
    }
    return result;
}

void permit_exr_threads() {
    const int threads = permitted_threads();
    try {
        Imf::setGlobalThreadCount(threads > 1 ? threads : 0);  // 0: the calling thread alone
    } catch (const std::exception&) {
        // The system grants no thread: those that there are, if any, will do.
    }
}

namespace {

/// How many lines of so many values are handed over to so many threads: whole blocks, as many for
/// each.
int lines_at_once(double line_values, int threads) {
    const int round = k_block_lines * threads;
    const double rounds = k_thread_values / (k_block_lines * line_values);
    return round * std::clamp(static_cast<int>(rounds), 1, std::max(k_lines_at_once / round, 1));
}

/// The lines of a film as OpenEXR takes them: floats where they are, half floats converted.
class ExrLines {
  public:
    ExrLines(const Film& film, std::span<const ExrChannel> channels) : film_(film) {
        for (const ExrChannel& channel : channels) {
            const auto found = std::ranges::find(film.channel_names(), channel.name);
            const auto index = static_cast<std::size_t>(found - film.channel_names().begin());
            (channel.is_half ? halves_ : floats_).push_back(index);
        }
    }

    /// The frame buffer of the lines from `begin` on; it is valid until the next call.
    Imf::FrameBuffer from(int begin, int end) {
        convert(begin, end);
        const PixelWindow& window = film_.window();
        Imf::FrameBuffer buffer;
        const auto insert = [&](std::size_t channel, Imf::PixelType type, const void* first,
                                std::size_t pixel_bytes) {
            buffer.insert(
                film_.channel_names()[channel],
                Imf::Slice::Make(type, first, Imath::V2i(window.x0, begin), window.width(),
                                 end - begin, pixel_bytes, pixel_bytes * width()));
        };
        for (const std::size_t channel : floats_)
            insert(channel, Imf::FLOAT, &film_.pixel(window.x0, begin)[channel],
                   sizeof(float) * film_.channel_names().size());
        for (std::size_t i = 0; i < halves_.size(); ++i)
            insert(halves_[i], Imf::HALF, &converted_[i], sizeof(Imath::half) * halves_.size());
        return buffer;
    }

  private:
    std::size_t width() const { return static_cast<std::size_t>(film_.window().width()); }

    void convert(int begin, int end) {
        const std::size_t line_values = width() * halves_.size();
        converted_.resize(static_cast<std::size_t>(end - begin) * line_values);
        parallel_for(static_cast<std::size_t>(end - begin), [&](std::size_t line) {
            Imath::half* out = converted_.data() + line * line_values;
            const int y = begin + static_cast<int>(line);
            for (int x = film_.window().x0; x < film_.window().x1; ++x) {
                const std::span<const float> pixel = film_.pixel(x, y);
                for (const std::size_t channel : halves_) *out++ = Imath::half(pixel[channel]);
            }
        });
    }

    const Film& film_;
    std::vector<std::size_t> floats_, halves_;  // indices in the film
    std::vector<Imath::half> converted_;        // as in the film, without the other channels
};

/// Empty if `header` is not one that `openexr_header` makes.
std::optional<ExrHeader> known_header(const Imf::Header& header) {
    const Imath::Box2i &display = header.displayWindow(), &data = header.dataWindow();
    ExrHeader result{display.max.x + 1, display.max.y + 1, {}, {}, {}, {}};
    result.window = {data.min.x, data.min.y, data.max.x + 1, data.max.y + 1};
    for (auto at = header.channels().begin(); at != header.channels().end(); ++at) {
        const Imf::PixelType type = at.channel().type;
        if (type != Imf::HALF && type != Imf::FLOAT) return std::nullopt;
        result.channels.push_back({at.name(), type == Imf::HALF});
    }
    const auto compression = std::ranges::find(k_compressions, header.compression(),
                                               &decltype(k_compressions)::value_type::second);
    if (compression == k_compressions.end()) return std::nullopt;
    result.compression = compression->first;
    for (auto at = header.begin(); at != header.end(); ++at) {
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&at.attribute()))
            result.metadata[at.name()] = text->value();
        if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&at.attribute()))
            result.metadata[at.name()] = static_cast<double>(number->value());
    }
    return result;
}

}  // namespace

void write_exr_file(OutputFile& out, const Film& film, const ExrHeader& header) {
    permit_exr_threads();
    const int threads = permitted_threads();
    ExrStream stream(out);
    try {
        Imf::OutputFile file(stream, openexr_header(header));
        ExrLines lines(film, header.channels);
        const PixelWindow& window = film.window();
        const int lines_of_portion = lines_at_once(
            1.0 * window.width() * static_cast<double>(header.channels.size()), threads);
        for (int begin = window.y0; begin < window.y1; begin += lines_of_portion) {
            throw_if_stopped();
            const int end = std::min(begin + lines_of_portion, window.y1);
            file.setFrameBuffer(lines.from(begin, end));
            file.writePixels(end - begin);
        }
    } catch (const Iex::BaseExc& error) {
        throw IoError(fmt::format("{}: cannot write: {}", out.path().string(), error.what()));
    }
}

namespace {

/// A file in memory, as the standard library reads it.
class MemoryBuffer : public std::streambuf {
  public:
    explicit MemoryBuffer(std::span<const std::byte> bytes) {
        // The get area is never written to.
        char* const begin = const_cast<char*>(reinterpret_cast<const char*>(bytes.data()));
        setg(begin, begin, begin + bytes.size());
    }

  protected:
    pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode which) override {
        const off_type base = from == std::ios::beg   ? 0
                              : from == std::ios::cur ? gptr() - eback()
                                                      : egptr() - eback();
        return seekpos(base + offset, which);
    }
    pos_type seekpos(pos_type position, std::ios::openmode /*which*/) override {
        if (position < 0 || position > egptr() - eback()) return pos_type(off_type(-1));
        setg(eback(), eback() + static_cast<off_type>(position), egptr());
        return position;
    }
};

/// The same, as OpenEXR reads it.
class ExrMemory : public Imf::IStream {
  public:
    explicit ExrMemory(std::span<const std::byte> bytes) : IStream("image"), bytes_(bytes) {}
    bool read(char into[], int count) override {
        const auto wanted = static_cast<std::size_t>(count);
        if (count < 0 || wanted > bytes_.size() - at_) throw Iex::InputExc("the file is truncated");
        std::copy_n(reinterpret_cast<const char*>(bytes_.data()) + at_, wanted, into);
        at_ += wanted;
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override {
        if (position > bytes_.size()) throw Iex::InputExc("the file is truncated");
        at_ = position;
    }

  private:
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

/// Red, green and blue, or grey, and alpha; else the first channels of those that there are.
std::vector<std::string> channels_to_read(const Imf::ChannelList& all) {
    const auto has = [&](const char* name) { return all.findChannel(name) != nullptr; };
    std::vector<std::string> names;
    if (has("R") && has("G") && has("B")) {
        names = {"R", "G", "B"};
    } else if (has("Y")) {
        names = {"Y"};
    } else {
        for (auto at = all.begin(); at != all.end(); ++at)
            if (std::string_view(at.name()) != "A") names.emplace_back(at.name());
        if (names.empty()) return {"A"};
        names.resize(names.size() < 3 ? 1 : 3);
    }
    if (has("A")) names.emplace_back("A");
    return names;
}

/// Throws InputError for what is not read, before anything is allocated for it.
void check_exr(const Imf::Header& header, std::span<const std::string> channels,
               std::size_t encoded_bytes, const std::string& name) {
    const Imath::Box2i& window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1)
        throw InputError(name + ": the image has no pixels; the file is damaged");
    int count = 0;
    for (auto at = header.channels().begin(); at != header.channels().end(); ++at) ++count;
    check_image_size(width, height, std::max(1, count), encoded_bytes, name);
    if (window != header.displayWindow() || (header.hasType() && Imf::isDeepData(header.type())))
        throw InputError(name + ": not all of the image is stored, or it is deep; save it whole");
    for (const std::string& channel : channels) {
        const Imf::Channel* const found = header.channels().findChannel(channel);
        if (found == nullptr || found->xSampling != 1 || found->ySampling != 1)
            throw InputError(name +
                             ": some of the channels are stored at a lower resolution; save red, "
                             "green and blue instead of luminance and chroma");
    }
    if (!header.hasTileDescription()) return;
    const Imf::TileDescription& tiles = header.tileDescription();
    constexpr std::int64_t k_max_texels = std::int64_t{1} << 22;
    if (std::int64_t{tiles.xSize} * tiles.ySize > std::max(k_max_texels, 4 * width * height))
        throw InputError(name + ": its tiles are larger than the image; the file is damaged");
}

using ChannelChoice = std::function<std::vector<std::string>(const Imf::ChannelList& all)>;

/// Decodes the channels that `choose` picks, which the file has.
PixelImage read_chosen(std::span<const std::byte> encoded, const std::string& name,
                       const ChannelChoice& choose) {
    const auto refuse = [&](std::string_view what) -> InputError {
        return InputError(fmt::format("{}: cannot read the OpenEXR image: {}; save it again", name,
                                      what.substr(0, what.find('\n'))));
    };
    MemoryBuffer buffer(encoded);
    std::istream in(&buffer);
    if (!attributes_fit(in, static_cast<std::int64_t>(encoded.size())))
        throw refuse("the file is truncated or damaged");
    try {
        ExrMemory memory(encoded);
        constexpr int k_no_threads = 0;
        constexpr bool k_restore_offsets = false;
        Imf::MultiPartInputFile input(memory, k_no_threads, k_restore_offsets);
        const Imf::Header& header = input.header(0);
        const std::vector<std::string> channels = choose(header.channels());
        check_exr(header, channels, encoded.size(), name);
        const Imath::Box2i& window = header.dataWindow();
        PixelImage image{window.max.x - window.min.x + 1,
                         window.max.y - window.min.y + 1,
                         static_cast<int>(channels.size()),
                         {},
                         true};
        const auto width = static_cast<std::size_t>(image.width);
        image.pixels.resize(width * static_cast<std::size_t>(image.height) * channels.size());
        const std::size_t step = sizeof(float) * channels.size();
        Imf::FrameBuffer frame;
        for (std::size_t c = 0; c < channels.size(); ++c)
            frame.insert(channels[c],
                         Imf::Slice::Make(Imf::FLOAT, &image.pixels[c], window.min, image.width,
                                          image.height, step, step * width));
        Imf::InputPart part(input, 0);
        part.setFrameBuffer(frame);
        for (int y = window.min.y; y <= window.max.y; y += k_lines_at_once) {
            throw_if_stopped();
            part.readPixels(y, std::min(y + k_lines_at_once - 1, window.max.y));
        }
        return image;
    } catch (const Iex::BaseExc& error) {
        throw refuse(error.what());
    } catch (const std::bad_alloc&) {
        throw refuse("it takes more memory than there is");
    }
}

}  // namespace

PixelImage read_exr(std::span<const std::byte> encoded, const std::string& name) {
    return read_chosen(encoded, name, channels_to_read);
}

PixelImage read_exr_channel(
    std::span<const std::byte> encoded, const std::string& name,
    const std::function<std::string(const std::vector<std::string>& channels)>& choose) {
    return read_chosen(encoded, name, [&](const Imf::ChannelList& all) {
        std::vector<std::string> names;
        for (auto at = all.begin(); at != all.end(); ++at) names.emplace_back(at.name());
        return std::vector<std::string>{choose(names)};
    });
}

std::optional<ExrHeader> read_exr_header(const std::filesystem::path& file) {
    if (!exr_attributes_fit(file)) return std::nullopt;
    try {
        constexpr int k_no_threads = 0;
        constexpr bool k_restore_offsets = false;
        const Imf::MultiPartInputFile input(file.c_str(), k_no_threads, k_restore_offsets);
        if (input.parts() != 1) return std::nullopt;
        return known_header(input.header(0));
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

}  // namespace uw
