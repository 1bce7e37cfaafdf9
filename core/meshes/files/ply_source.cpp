#include "core/meshes/files/ply_source.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <utility>

#include "core/base/error.h"

namespace uw {
namespace {

constexpr std::size_t k_buffer_bytes = std::size_t{1} << 20;
constexpr std::size_t k_max_number_length = 100;

template <typename T>
double number_at(const char* bytes, bool swap) {
    char ordered[sizeof(T)];
    std::memcpy(ordered, bytes, sizeof(T));
    if (swap) std::reverse(ordered, ordered + sizeof(T));
    T value{};
    std::memcpy(&value, ordered, sizeof(T));
    return static_cast<double>(value);
}

double number_at(const char* bytes, PlyType type, bool swap) {
    switch (type) {
        case PlyType::int8:
            return number_at<std::int8_t>(bytes, swap);
        case PlyType::uint8:
            return number_at<std::uint8_t>(bytes, swap);
        case PlyType::int16:
            return number_at<std::int16_t>(bytes, swap);
        case PlyType::uint16:
            return number_at<std::uint16_t>(bytes, swap);
        case PlyType::int32:
            return number_at<std::int32_t>(bytes, swap);
        case PlyType::uint32:
            return number_at<std::uint32_t>(bytes, swap);
        case PlyType::float32:
            return number_at<float>(bytes, swap);
        case PlyType::float64:
            return number_at<double>(bytes, swap);
    }
    return 0;
}

bool is_space(char c) {
    return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

}  // namespace

PlySource::PlySource(std::istream& in, PlyEncoding encoding, std::string name)
    : in_(&in), encoding_(encoding), name_(std::move(name)), buffer_(k_buffer_bytes) {}

/// Keeps the unread bytes and appends to them; false at the end of the file.
bool PlySource::fill() {
    std::memmove(buffer_.data(), buffer_.data() + at_, end_ - at_);
    end_ -= at_;
    at_ = 0;
    in_->read(buffer_.data() + end_, static_cast<std::streamsize>(buffer_.size() - end_));
    const auto got = static_cast<std::size_t>(in_->gcount());
    end_ += got;
    return got > 0;
}

double PlySource::next(PlyType type) {
    if (encoding_ == PlyEncoding::ascii) return next_text();
    const std::size_t size = size_of(type);
    while (end_ - at_ < size) {
        if (!fill()) throw InputError(name_ + ": the PLY file is truncated; export the mesh again");
    }
    const bool file_is_little = encoding_ == PlyEncoding::little_endian;
    const bool swap = file_is_little != (std::endian::native == std::endian::little);
    const double value = number_at(buffer_.data() + at_, type, swap);
    at_ += size;
    return value;
}

double PlySource::next_text() {
    for (;;) {
        while (at_ < end_ && is_space(buffer_[at_])) ++at_;
        if (at_ < end_) break;
        if (!fill()) throw InputError(name_ + ": the PLY file is truncated; export the mesh again");
    }
    if (end_ - at_ < k_max_number_length) fill();
    const char* begin = buffer_.data() + at_;
    const char* end = buffer_.data() + std::min(end_, at_ + k_max_number_length);
    if (*begin == '+') ++begin;
    double value = 0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    const bool whole = stop == buffer_.data() + end_ || (stop < end && is_space(*stop));
    if (error != std::errc{} || !whole) {
        const char* word_end = std::find_if(begin, end, is_space);
        throw InputError(name_ + ": not a number in the PLY file: '" +
                         std::string(begin, std::min(word_end, begin + 20)) + "'");
    }
    at_ = static_cast<std::size_t>(stop - buffer_.data());
    return value;
}

}  // namespace uw
