#include "media/inspection/vdb_inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>

#include "media/volumes/grid_bricks.h"
#include "media/volumes/vdb_header.h"
#include "media/volumes/vdb_stream.h"

namespace uw {
namespace {

constexpr std::size_t k_slab_bytes = std::size_t{256} << 20;
constexpr double k_unbounded = std::numeric_limits<double>::infinity();

template <class T>
double number_of(const T& value) {
    return static_cast<double>(value);
}
template <class T>
double number_of(const openvdb::math::Vec3<T>& v) {
    return std::sqrt(static_cast<double>(v.x()) * static_cast<double>(v.x()) +
                     static_cast<double>(v.y()) * static_cast<double>(v.y()) +
                     static_cast<double>(v.z()) * static_cast<double>(v.z()));
}

template <class T>
std::string text_of(const T& value) {
    return fmt::format("{:g}", static_cast<double>(value));
}
template <class T>
std::string text_of(const openvdb::math::Vec3<T>& v) {
    return fmt::format("({:g}, {:g}, {:g})", static_cast<double>(v.x()), static_cast<double>(v.y()),
                       static_cast<double>(v.z()));
}

using TakeValue = std::function<void(double number, std::int64_t voxels)>;

/// Calls `take` for all active values of a node and of those below it. OpenVDB's own iterators of
/// whole trees take time that grows with the square of the root's tiles.
template <class Node>
void for_each_value(const Node& node, const TakeValue& take) {
    std::int64_t voxels = 1;
    if constexpr (Node::LEVEL > 0)
        voxels = static_cast<std::int64_t>(Node::ChildNodeType::NUM_VOXELS);
    for (auto value = node.cbeginValueOn(); value; ++value) take(number_of(*value), voxels);
    if constexpr (Node::LEVEL > 0)
        for (auto child = node.cbeginChildOn(); child; ++child) for_each_value(*child, take);
}

void for_each_value(const openvdb::GridBase& grid, const TakeValue& take) {
    grid.apply<ReadableGrids>(
        [&](const auto& typed) { for_each_value(typed.tree().root(), take); });
}

void set_background(const openvdb::GridBase& grid, ValueSummary& summary) {
    grid.apply<ReadableGrids>([&](const auto& typed) {
        summary.background = text_of(typed.background());
        summary.background_value = number_of(typed.background());
    });
}

void add_range(const openvdb::GridBase& grid, ValueSummary& summary, double& sum) {
    for_each_value(grid, [&](double value, std::int64_t voxels) {
        summary.active += voxels;
        if (!std::isfinite(value)) {
            (std::isnan(value) ? summary.nan : summary.infinite) += voxels;
            return;
        }
        summary.finite += voxels;
        if (value < 0) summary.negative += voxels;
        if (value == 0) summary.zero += voxels;
        summary.min = std::min(summary.min, value);
        summary.max = std::max(summary.max, value);
        sum += value * static_cast<double>(voxels);
    });
}

void add_histogram(const openvdb::GridBase& grid, ValueSummary& summary) {
    const double width = summary.max - summary.min;
    for_each_value(grid, [&](double value, std::int64_t voxels) {
        if (!std::isfinite(value)) return;
        const double position =
            width > 0 && std::isfinite(width) ? (value - summary.min) / width : 0;
        const auto bin = static_cast<std::size_t>(position * k_histogram_bins);
        summary.histogram[std::min<std::size_t>(bin, k_histogram_bins - 1)] += voxels;
    });
}

bool is_readable(const std::string& value_type) {
    static constexpr std::array<std::string_view, 7> readable{"float", "double", "int32", "int64",
                                                              "vec3s", "vec3d",  "vec3i"};
    return std::ranges::find(readable, value_type) != readable.end();
}

void read_values(const VdbHeader& header, const SourceLocation& where, GridInspection& grid) {
    if (!is_readable(grid.summary.value_type)) {
        grid.unread = fmt::format("values of type {} are not inspected", grid.summary.value_type);
        return;
    }
    ValueSummary summary;
    summary.min = k_unbounded;
    summary.max = -k_unbounded;
    summary.histogram.assign(k_histogram_bins, 0);
    double sum = 0;
    openvdb::CoordBBox box;
    openvdb::GridBase::Ptr last;
    int slabs = 0;
    read_slabs(header, grid.summary, k_slab_bytes, where, [&](const openvdb::GridBase::Ptr& slab) {
        openvdb::CoordBBox part;
        if (slab->baseTree().evalActiveVoxelBoundingBox(part)) box.expand(part);
        set_background(*slab, summary);
        add_range(*slab, summary, sum);
        ++slabs;
        last = slab;
    });
    if (summary.finite == 0) summary.min = summary.max = 0;
    if (summary.finite > 0) summary.mean = sum / static_cast<double>(summary.finite);
    if (slabs == 1) {
        add_histogram(*last, summary);
    } else {
        last.reset();
        read_slabs(header, grid.summary, k_slab_bytes, where,
                   [&](const openvdb::GridBase::Ptr& slab) { add_histogram(*slab, summary); });
    }
    grid.box.reset();
    if (summary.active > 0)
        grid.box = IndexBox{{box.min().x(), box.min().y(), box.min().z()},
                            {box.max().x(), box.max().y(), box.max().z()}};
    grid.active_voxels = summary.active;
    grid.values = std::move(summary);
}

std::string kind_of(const Affine& map) {
    const Matrix3& m = map.linear();
    const Vector3 size(glm::length(m[0]), glm::length(m[1]), glm::length(m[2]));
    constexpr double k_rounding = 1e-6;
    const double largest = std::max({size.x, size.y, size.z});
    bool axes = true, orthogonal = true;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
            if (a == b) continue;
            axes = axes && std::abs(m[a][b]) <= k_rounding * size[a];
            orthogonal =
                orthogonal && std::abs(glm::dot(m[a], m[b])) <= k_rounding * size[a] * size[b];
        }
    const bool even = std::max({std::abs(size.x - size.y), std::abs(size.y - size.z),
                                std::abs(size.z - size.x)}) <= k_rounding * largest;
    std::string kind = !orthogonal ? "sheared" : !axes ? "rotated" : "";
    if (orthogonal)
        kind += (kind.empty() ? "" : ", ") + std::string(even ? "uniform scale" : "scale");
    if (map.determinant() < 0) kind += ", mirrored";
    return kind;
}

openvdb::Vec3d middle_of(const GridInspection& grid) {
    openvdb::Vec3d middle(0, 0, 0);
    if (!grid.box) return middle;
    for (int a = 0; a < 3; ++a) {
        const auto i = static_cast<std::size_t>(a);
        middle[a] = 0.5 * (static_cast<double>(grid.box->min[i]) + grid.box->max[i]);
    }
    return middle;
}

void inspect_transform(const VdbHeader& header, const Placement& placement,
                       const SourceLocation& where, GridInspection& grid) {
    const auto transform = uw::read_transform(header, grid.summary, where);
    grid.transform = transform->isLinear() ? kind_of(to_affine(*transform)) : "frustum";
    const Affine world_from_file = upright_from_file(placement.up);
    const auto at = [&](const openvdb::Vec3d& p) {
        const openvdb::Vec3d x = transform->indexToWorld(p);
        return world_from_file * Point3{x.x(), x.y(), x.z()};
    };
    const openvdb::Vec3d middle = middle_of(grid);
    for (int a = 0; a < 3; ++a) {
        openvdb::Vec3d before = middle, after = middle;
        before[a] -= 0.5;
        after[a] += 0.5;
        grid.voxel_size[a] = distance(at(after), at(before));
    }
    if (!grid.box) return;
    const double shift = placement.centering == Centering::cell ? 0.5 : 0.0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        openvdb::Vec3d p;
        for (int a = 0; a < 3; ++a) {
            const auto i = static_cast<std::size_t>(a);
            const bool high = (corner >> i & 1U) != 0;
            p[a] = (high ? grid.box->max[i] + 0.5 : grid.box->min[i] - 0.5) + shift;
        }
        grid.world_bounds.extend(at(p));
    }
}

/// The error with which `read` fails, without its location prefix; "" if it succeeds.
template <class Read>
std::string failure_of(const std::string& place, const Read& read) {
    try {
        read_guarded("", read);
        return "";
    } catch (const InputError& error) {
        const std::string what = error.what();
        return what.starts_with(place) ? what.substr(place.size()) : what;
    }
}

/// The box of active voxels stated in the header, unless it is empty.
std::optional<IndexBox> stated_box(const GridSummary& grid) {
    if (!grid.active_box || grid.active_voxels.value_or(1) <= 0) return std::nullopt;
    for (std::size_t a = 0; a < 3; ++a)
        if (grid.active_box->min[a] > grid.active_box->max[a]) return std::nullopt;
    return grid.active_box;
}

}  // namespace

VdbInspection inspect_vdb(const std::filesystem::path& file, const SourceLocation& where,
                          UpAxis up) {
    initialize_openvdb();
    VdbInspection inspection;
    inspection.header = read_vdb_header(file, where);
    const VdbHeader& header = inspection.header;
    VolumeDesc placed;
    placed.up = up;
    inspection.placement = decide_placement(header, placed);
    const std::string place = fmt::format("{}: '{}' ", where, file.string());
    std::string damage;
    bool any = header.grids.empty();
    for (const GridSummary& summary : header.grids) {
        GridInspection grid;
        grid.summary = summary;
        grid.unusable = unusable_because(summary);
        grid.active_voxels = summary.active_voxels;
        grid.box = stated_box(summary);
        const std::string why = failure_of(place, [&] { read_values(header, where, grid); });
        const std::string transform = failure_of(
            place, [&] { inspect_transform(header, inspection.placement, where, grid); });
        for (const std::string& text : {why, transform})
            if (!text.empty() && grid.unread.empty()) grid.unread = text;
        any = any || (why.empty() && transform.empty());
        if (damage.empty()) damage = grid.unread;
        inspection.grids.push_back(std::move(grid));
    }
    if (!any) throw InputError(fmt::format("{}: '{}' {}", where, file.string(), damage));
    return inspection;
}

}  // namespace uw
