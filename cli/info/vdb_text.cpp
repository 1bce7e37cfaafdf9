#include "cli/info/vdb_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/frame_list.h"

namespace uw {

namespace {

std::string describe_bounds(const Bounds& b) {
    return fmt::format("x {:.4g}..{:.4g}, y {:.4g}..{:.4g}, z {:.4g}..{:.4g} m", b.min.x, b.max.x,
                       b.min.y, b.max.y, b.min.z, b.max.z);
}

/// One character per bin, by the logarithm of its count: a blank for none, then . to @.
std::string histogram(const ValueSummary& values) {
    constexpr std::string_view k_shades = ".:-=+*#%@";
    const std::int64_t most = *std::ranges::max_element(values.histogram);
    std::string bars;
    for (const std::int64_t count : values.histogram) {
        if (count == 0) {
            bars += ' ';
            continue;
        }
        const double share =
            std::log1p(static_cast<double>(count)) / std::log1p(static_cast<double>(most));
        const auto shade = static_cast<std::size_t>(share * static_cast<double>(k_shades.size()));
        bars += k_shades[std::min(shade, k_shades.size() - 1)];
    }
    return bars;
}

std::string describe_values(const ValueSummary& v, bool lengths) {
    std::string text;
    if (v.finite > 0)
        text += fmt::format("  {}: min {:.4g}, mean {:.4g}, max {:.4g}\n",
                            lengths ? "lengths" : "values", v.min, v.mean, v.max);
    if (v.finite > 0 && v.max > v.min)
        text += fmt::format("  histogram, by the logarithm of the count: {:.4g} |{}| {:.4g}\n",
                            v.min, histogram(v), v.max);
    text += fmt::format("  background {}; NaN {}, infinite {}, negative {}, zero {}\n",
                        v.background, v.nan, v.infinite, v.negative, v.zero);
    return text;
}

std::string describe_grid(const GridInspection& grid) {
    const GridSummary& s = grid.summary;
    std::string text = fmt::format(
        "\ngrid '{}': {}, {}, saved as {}, compression {}\n", s.name, s.value_type,
        s.grid_class == "unknown" ? "no class" : s.grid_class, precision_of(s), compression_of(s));
    const Vector3& h = grid.voxel_size;
    if (!grid.transform.empty())
        text += fmt::format("  {:.4g} x {:.4g} x {:.4g} m per voxel, transform: {}\n", h.x, h.y,
                            h.z, grid.transform);
    if (grid.active_voxels) text += fmt::format("  {} active voxels\n", *grid.active_voxels);
    if (!grid.world_bounds.empty())
        text += "  world bounds " + describe_bounds(grid.world_bounds) + "\n";
    if (grid.values) text += describe_values(*grid.values, s.value_type.starts_with("vec"));
    if (!grid.unread.empty()) text += "  values not read: " + grid.unread + "\n";
    return text;
}

std::string describe_sequence(const SequenceReport& sequence) {
    if (sequence.pattern.empty()) return "";
    std::string text = fmt::format(
        "sequence {}: {} {} there: {}\n", sequence.pattern, sequence.found.size(),
        sequence.found.size() == 1 ? "frame is" : "frames are", format_frame_list(sequence.found));
    if (!sequence.missing.empty())
        text += "missing between them: " + format_frame_list(sequence.missing) + "\n";
    if (!sequence.empty.empty())
        text += "frames that hold nothing to map: " + format_frame_list(sequence.empty) + "\n";
    return text + fmt::format("frame {}:\n", sequence.frame);
}

}  // namespace

std::string compression_of(const GridSummary& grid) {
    std::string text;
    if ((grid.compression & 1U) != 0) text = "zip";
    if ((grid.compression & 4U) != 0) text = "blosc";
    if (text.empty()) text = "none";
    if ((grid.compression & 2U) != 0) text += ", active values only";
    return text;
}

std::string precision_of(const GridSummary& grid) {
    if (!grid.quantised.empty()) return grid.quantised;
    return grid.half ? "half" : grid.value_type;
}

std::string vdb_text(const VdbReport& report) {
    const VdbHeader& header = report.inspection.header;
    std::string text = describe_sequence(report.sequence);
    const std::string file = header.file.filename().string();
    if (header.is_nano)
        text += fmt::format("{}: NanoVDB, library {}.{}\n", file, header.library_major,
                            header.library_minor);
    else
        text += fmt::format("{}: VDB version {}, library {}.{}, creator {}\n", file, header.version,
                            header.library_major, header.library_minor,
                            header.creator.empty() ? "not named" : "'" + header.creator + "'");
    if (header.grids.empty()) text += "no grids\n";
    for (const GridInspection& grid : report.inspection.grids) text += describe_grid(grid);
    text += "\nAdvice\n";
    const VdbAdvice& advice = report.advice;
    for (const std::string& line : advice.lines) text += "- " + line + "\n";
    if (advice.volumes.empty()) return text;
    text +=
        "\nA scene that shows it, as --scene prints it alone; or paste its parts into your "
        "own:\n\n";
    return text + advice.scene;
}

}  // namespace uw
