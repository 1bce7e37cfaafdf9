#include "core/light/photometric_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <system_error>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"

namespace uw {

namespace {

constexpr std::size_t k_max_file = std::size_t{4} << 20;
constexpr std::size_t k_max_candelas = 1'100'000;  // a quarter of a degree in both angles

std::string upper_case(std::string_view text) {
    std::string upper(text);
    std::ranges::transform(upper, upper.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return upper;
}

/// Reads the lines and numbers of the text in sequence.
class IesText {
  public:
    IesText(std::string_view text, std::string name) : rest_(text), name_(std::move(name)) {}

    const std::string& name() const { return name_; }
    std::size_t bytes_left() const { return rest_.size(); }
    [[noreturn]] void fail(std::string_view what) const {
        throw InputError(fmt::format("{}:{}: {}", name_, line_, what));
    }

    bool at_end() const { return rest_.empty(); }
    std::string_view line() {
        ++line_;
        return trimmed(take_line(rest_));
    }

    /// Whether another number follows; numbers are separated by blanks, commas and line ends.
    bool has_number() {
        constexpr std::string_view k_between = " \t\r\n,\x1A";  // ^Z ends DOS files
        while (!rest_.empty() && k_between.find(rest_.front()) != std::string_view::npos) {
            if (rest_.front() == '\n') ++line_;
            rest_.remove_prefix(1);
        }
        return !rest_.empty();
    }

    double number(std::string_view what) {
        if (!has_number())
            fail(fmt::format("ends before {}; the file is truncated: download or copy it again",
                             what));
        const std::string_view token = rest_.substr(0, rest_.find_first_of(" \t\r\n,\x1A"));
        double value = 0;
        if (parse_number(token, value) != NumberText::number || std::abs(value) > k_max_magnitude)
            fail(fmt::format("expected a number for {}, found '{}'; write numbers like 12.5", what,
                             printable(token)));
        rest_.remove_prefix(token.size());
        return value;
    }

    double non_negative(std::string_view what) {
        const double value = number(what);
        if (value < 0) fail(fmt::format("{} must not be negative, found {}", what, value));
        return value;
    }

    /// A count of numbers to follow: at most what the rest of the text can hold.
    std::size_t count(std::string_view what) {
        const double value = number(what);
        const double most = 0.5 * static_cast<double>(rest_.size()) + 1;
        if (!(value >= 1) || value != std::floor(value) || value > most)
            fail(fmt::format("{} must be a whole number from 1 to what the file can hold, found {}",
                             what, value));
        return static_cast<std::size_t>(value);
    }

    std::vector<double> ascending(std::size_t count, double most, std::string_view what) {
        std::vector<double> angles;
        while (angles.size() < count) {
            const double angle = number(what);
            if (angle < 0 || angle > most)
                fail(fmt::format("{} must be from 0 to {} degrees, found {}", what, most, angle));
            if (!angles.empty() && angle <= angles.back())
                fail(fmt::format("{} must ascend, found {} after {}", what, angle, angles.back()));
            angles.push_back(angle);
        }
        return angles;
    }

  private:
    static constexpr double k_max_magnitude = 1e12;

    std::string_view rest_;
    std::string name_;
    int line_ = 1;
};

/// The year in "IESNA:LM-63-2002" or "IESNA91"; the first standard had no such line.
int year_of(std::string_view first_line) {
    const std::string upper = upper_case(first_line);
    if (upper.starts_with("IESNA91")) return 1991;
    if (!upper.starts_with("IESNA")) return 1986;
    for (const int year : {1991, 1995, 2002, 2019})
        if (upper.find(std::to_string(year)) != std::string::npos) return year;
    return 2002;
}

/// The text after TILT=, in upper case; reads up to and including its line.
std::string read_header(IesText& text, IesFile& file) {
    const std::string_view first = text.line();
    file.year = year_of(first);
    std::string_view line = first;
    for (;;) {
        const std::string upper = upper_case(line);
        if (upper.starts_with("TILT=")) return upper.substr(5);
        if (text.at_end())
            text.fail(
                "there is no line 'TILT=': this is not an IES file (LM-63); convert EULUMDAT "
                "(.ldt) and other formats first");
        line = text.line();
    }
}

void read_tilt(IesText& text, std::string_view tilt, IesFile& file) {
    if (trimmed(tilt) == "NONE") return;
    file.warnings.push_back(fmt::format(
        "{}: its TILT factors, by which a lamp dims in other orientations, are not applied",
        text.name()));
    if (trimmed(tilt) != "INCLUDE") return;
    text.number("the lamp's orientation");
    const std::size_t pairs = text.count("the number of TILT angles");
    text.ascending(pairs, 180, "TILT angles");
    for (std::size_t i = 0; i < pairs; ++i) text.non_negative("a TILT factor");
}

/// Reads the ten numbers of the first line and three of the second; returns the factor on all
/// candelas.
double read_factors(IesText& text, IesFile& file, std::size_t& polar, std::size_t& planes) {
    const double lamps = text.non_negative("the number of lamps");
    const double lumens = text.number("the lumens per lamp");
    // -1: absolute photometry, the candelas are the luminaire's own.
    file.lumens = lumens < 0 ? -1 : lamps * lumens;
    double factor = text.non_negative("the multiplier of the candelas");
    polar = text.count("the number of vertical angles");
    planes = text.count("the number of horizontal angles");
    const double type = text.number("the photometric type");
    if (type == 2 || type == 3)
        text.fail(
            fmt::format("its photometry is of type {}; only type C is supported: convert it to "
                        "type C, or ask the manufacturer for a type C file",
                        type == 2 ? 'B' : 'A'));
    if (type != 1)
        text.fail(fmt::format("the photometric type must be 1 (type C), found {}", type));
    for (const char* const what : {"the type of units", "the width", "the length", "the height"})
        text.number(what);
    factor *= text.non_negative("the ballast factor");
    const double second = text.non_negative("the number after the ballast factor");
    // The ballast-lamp factor of the older standards; reserved for future use in later ones.
    if (file.year <= 1991) factor *= second;
    text.number("the input watts");
    return factor;
}

void check_ranges(const IesText& text, IesFile& file) {
    const double first = file.polar.front(), last = file.polar.back();
    if (file.polar.size() < 2)
        text.fail("has only one vertical angle; a distribution needs two or more");
    if ((first > 0 && first != 90) || (last != 90 && last != 180))
        file.warnings.push_back(
            fmt::format("{}: its vertical angles go from {} to {}, but usually they go from 0 or "
                        "90 to 90 or 180; the lamp is dark outside them",
                        text.name(), first, last));
    if (file.planes.size() == 1) return;
    const double begin = file.planes.front(), end = file.planes.back();
    const double widest_gap = 2 * (file.planes[1] - begin);
    const bool known =
        (begin == 0 && (end == 90 || end == 180 || end == 360)) || (begin == 90 && end == 270);
    // Some files omit 360 degrees, which equals 0 degrees.
    if (!known && (begin != 0 || end <= 180 || 360 - end > widest_gap))
        text.fail(
            fmt::format("its horizontal angles go from {} to {}; in type C they go from 0 to 0, "
                        "90, 180 or 360, or from 90 to 270",
                        begin, end));
}

}  // namespace

IesFile parse_ies(std::string_view content, const std::string& name) {
    constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";
    if (content.starts_with(k_byte_order_mark)) content.remove_prefix(k_byte_order_mark.size());
    IesText text(content, printable(name, 300));
    IesFile file;
    read_tilt(text, read_header(text, file), file);
    std::size_t polar = 0, planes = 0;
    const double factor = read_factors(text, file, polar, planes);
    if (polar > std::min(k_max_candelas, text.bytes_left() / 2 + 1) / planes)
        text.fail(
            fmt::format("{} x {} angles need more candelas than this file can hold (at most {}); "
                        "check both counts",
                        polar, planes, k_max_candelas));
    file.polar = text.ascending(polar, 180, "vertical angles");
    file.planes = text.ascending(planes, 360, "horizontal angles");
    check_ranges(text, file);
    file.candelas.reserve(polar * planes);
    for (std::size_t i = 0; i < polar * planes; ++i)
        file.candelas.push_back(factor * text.non_negative("a candela value"));
    if (*std::ranges::max_element(file.candelas) <= 0)
        text.fail("all candelas are 0: this luminaire is dark; check the file and its multiplier");
    if (text.has_number())
        file.warnings.push_back(text.name() +
                                ": continues after the candelas it announces; the rest is ignored");
    return file;
}

IesFile read_ies(const std::filesystem::path& file) {
    const std::string text =
        read_text_file(file, printable(file.string(), 300), k_max_file, "IES file (LM-63)");
    return parse_ies(text, file.filename().string());
}

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_radians = k_pi / 180;

// Permitted deviation of the intensity between two breaks from a parabola, relative to its maximum
// there; intensities below the second fraction of the peak may deviate further.
constexpr double k_follow = 1e-3;
constexpr double k_dim = 1e-4;
constexpr double k_widest = 15 * k_radians;
constexpr std::size_t k_max_at_once = 64;

// A position between two of a table's angles.
struct Place {
    std::size_t i = 0;  // the one before it
    double t = 0;       // 0..1 to the next
};

Place find_place(const std::vector<double>& angles, double angle) {
    const auto above = std::upper_bound(angles.begin(), angles.end(), angle);
    const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
        above - angles.begin() - 1, 0, static_cast<std::ptrdiff_t>(angles.size()) - 2));
    return {i, (angle - angles[i]) / (angles[i + 1] - angles[i])};
}

// One row or column of the table: intensities over `angles`.
using Line = std::function<double(std::size_t)>;

// Whether a parabola through both ends and the midpoint of [first, last] approximates `line` there.
bool follows(const std::vector<double>& angles, const Line& line, std::size_t first,
             std::size_t last, double dim) {
    const auto at = [&](double angle) {
        const Place p = find_place(angles, angle);
        return line(p.i) + p.t * (line(p.i + 1) - line(p.i));
    };
    const double begin = angles[first], length = angles[last] - begin;
    const double f0 = line(first), f1 = at(begin + 0.5 * length), f2 = line(last);
    double most = dim;
    for (std::size_t i = first; i <= last; ++i) most = std::max(most, line(i));
    for (std::size_t i = first + 1; i < last; ++i) {
        // A parabola would miss where the light begins or ends.
        if ((line(i) > 0) != (line(i - 1) > 0) || (line(i) > 0) != (line(i + 1) > 0)) return false;
        const double t = (angles[i] - begin) / length;
        const double parabola =
            f0 * (1 - t) * (1 - 2 * t) + 4 * f1 * t * (1 - t) - f2 * t * (1 - 2 * t);
        if (std::abs(parabola - line(i)) > k_follow * most) return false;
    }
    return true;
}

// A greedy minimal subset of `angles` between which all lines are approximated.
std::vector<double> breaks_of(const std::vector<double>& angles, const std::vector<Line>& lines,
                              double dim) {
    std::vector<double> breaks{angles.front()};
    std::size_t first = 0;
    while (first + 1 < angles.size()) {
        std::size_t last = first + 1;
        while (last + 1 < angles.size() && last - first < k_max_at_once &&
               angles[last + 1] - angles[first] <= k_widest &&
               std::ranges::all_of(lines, [&](const Line& line) {
                   return follows(angles, line, first, last + 1, dim);
               }))
            ++last;
        breaks.push_back(angles[last]);
        first = last;
    }
    return breaks;
}

// A plane of the full circle and the file's plane with the same intensities.
struct UnfoldedPlane {
    double degrees = 0;
    std::size_t source = 0;
};

std::vector<UnfoldedPlane> unfolded(const std::vector<double>& planes) {
    const double first = planes.front(), last = planes.back();
    std::vector<UnfoldedPlane> all;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const double at = planes[i];
        all.push_back({at, i});
        if (last == 90) {
            all.push_back({180 - at, i});
            all.push_back({180 + at, i});
            all.push_back({360 - at, i});
        } else if (first == 90) {
            if (at <= 180) all.push_back({180 - at, i});
            if (at >= 180) all.push_back({540 - at, i});
        } else if (last == 180) {
            all.push_back({360 - at, i});
        }
    }
    std::ranges::stable_sort(all, {}, &UnfoldedPlane::degrees);
    constexpr double k_same = 1e-9;
    const auto same = [](const UnfoldedPlane& a, const UnfoldedPlane& b) {
        return b.degrees - a.degrees < k_same;
    };
    all.erase(std::unique(all.begin(), all.end(), same), all.end());
    if (all.back().degrees - all.front().degrees < 360 - k_same)
        all.push_back({all.front().degrees + 360, all.front().source});
    return all;
}

}  // namespace

PhotometricWeb::PhotometricWeb(const IesFile& file) {
    for (const double degrees : file.polar) polar_.push_back(degrees * k_radians);
    if (file.planes.size() == 1)
        candelas_ = file.candelas;
    else
        unfold(file);
    peak_ = *std::ranges::max_element(candelas_);
    const std::size_t planes = candelas_.size() / polar_.size();
    std::size_t lit = 0;
    for (std::size_t p = 0; p < planes; ++p)
        for (std::size_t i = 0; i < polar_.size(); ++i)
            if (value(p, i) > 0) lit = std::max(lit, i);
    dark_angle_ = polar_[std::min(lit + 1, polar_.size() - 1)];
    find_breaks();
}

void PhotometricWeb::unfold(const IesFile& file) {
    const auto rows = static_cast<std::ptrdiff_t>(polar_.size());
    for (const UnfoldedPlane& plane : unfolded(file.planes)) {
        const auto begin = file.candelas.begin() + static_cast<std::ptrdiff_t>(plane.source) * rows;
        candelas_.insert(candelas_.end(), begin, begin + rows);
        azimuth_.push_back(plane.degrees * k_radians);
    }
}

void PhotometricWeb::find_breaks() {
    const double dim = k_dim * peak_;
    const std::size_t planes = candelas_.size() / polar_.size();
    std::vector<Line> over_polar, over_azimuth;
    for (std::size_t p = 0; p < planes; ++p)
        over_polar.emplace_back([this, p](std::size_t i) { return value(p, i); });
    polar_breaks_ = breaks_of(polar_, over_polar, dim);
    if (is_rotational()) return;
    for (std::size_t i = 0; i < polar_.size(); ++i)
        over_azimuth.emplace_back([this, i](std::size_t p) { return value(p, i); });
    azimuth_breaks_ = breaks_of(azimuth_, over_azimuth, dim);
    azimuth_breaks_.pop_back();  // equals the first
}

double PhotometricWeb::candelas(double polar, double azimuth) const {
    if (!(polar >= polar_.front() && polar <= polar_.back())) return 0;
    const Place p = find_place(polar_, polar);
    const auto on_plane = [&](std::size_t plane) {
        return value(plane, p.i) + p.t * (value(plane, p.i + 1) - value(plane, p.i));
    };
    if (is_rotational()) return on_plane(0);
    const Place a = find_place(azimuth_, azimuth < azimuth_.front() ? azimuth + 2 * k_pi : azimuth);
    return on_plane(a.i) + a.t * (on_plane(a.i + 1) - on_plane(a.i));
}

double PhotometricWeb::flux() const {
    // Between two polar angles the intensity is m + n theta, integrated with sin(theta) in closed
    // form. Between planes it is linear, so their mean is used.
    const auto zone = [&](std::size_t plane) {
        double sum = 0;
        for (std::size_t i = 0; i + 1 < polar_.size(); ++i) {
            const double slope =
                (value(plane, i + 1) - value(plane, i)) / (polar_[i + 1] - polar_[i]);
            sum += value(plane, i) * std::cos(polar_[i]) -
                   value(plane, i + 1) * std::cos(polar_[i + 1]) +
                   slope * (std::sin(polar_[i + 1]) - std::sin(polar_[i]));
        }
        return sum;
    };
    if (is_rotational()) return 2 * k_pi * zone(0);
    double sum = 0;
    for (std::size_t p = 0; p + 1 < azimuth_.size(); ++p)
        sum += 0.5 * (azimuth_[p + 1] - azimuth_[p]) * (zone(p) + zone(p + 1));
    return sum;
}

}  // namespace uw
