#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace uw {

/// One of the files of assets/published, compiled in: figures that others have published or
/// measured, with their source in the first lines.
struct PublishedTable {
    std::string_view name;
    std::string_view text;
};
const std::vector<PublishedTable>& published_tables();

/// A figure that others have published, and ours for the same.
struct PublishedFigure {
    std::string source;    // "Mobley et al. 1993, problem 2"
    std::string quantity;  // "Ed at optical depth 5, albedo 0.9"
    double published = 0, ours = 0;
    double error = 0;       // standard error of ours, relative to it; 0: exact
    double spread = 0;      // of those published, relative: of several models or measurements
    double tolerance = 0;   // of ours, relative to the published, beside two standard errors
    bool is_bound = false;  // ours is to be no greater, rather than the same

    /// Ours against the published, relative.
    double difference() const { return ours / published - 1; }
    bool passed() const;
};

struct PublishedOptions {
    int rays = 65536;  // from each meter (LightMeter)
    /// Problems by these names alone, such as "problem 2"; empty: all.
    std::string only;
    std::function<void(const std::string&)> say = [](const std::string&) {};
};

/// Computes what others have published: the canonical problems of ocean optics, and where real
/// cameras behind ports have seen corners of boards. Throws Interrupted.
std::vector<PublishedFigure> compare_with_published(const PublishedOptions& options);

}  // namespace uw
