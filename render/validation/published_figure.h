#pragma once

#include <cmath>
#include <functional>
#include <string>

namespace uw {

/// A figure that others have published, and ours for the same.
struct PublishedFigure {
    std::string source;    // "Mobley et al. 1993, problem 2"
    std::string quantity;  // "Ed at depth 5, albedo 0.9"
    double published = 0, ours = 0;
    double error = 0;       // standard error of ours, relative to it; 0: exact
    double spread = 0;      // of those published, relative: of several models or measurements
    double tolerance = 0;   // of ours, relative to the published, beside two standard errors
    bool is_bound = false;  // ours is to be no greater, rather than the same

    /// Its position in plots: the panel, the curve, and the position along the horizontal axis.
    /// None shows it if `panel` is empty.
    struct Place {
        std::string panel, curve, axis;
        double x = 0;
    };
    Place place{};

    /// Ours against the published, relative.
    double difference() const { return ours / published - 1; }
    /// The largest difference, relative, with which it passes.
    double allowed() const { return tolerance + 2 * error; }
    bool passed() const { return (is_bound ? difference() : std::abs(difference())) <= allowed(); }
};

struct PublishedOptions {
    int rays = 65536;  // from each meter (LightMeter)
    /// One part alone: "photographs", "problem 1" and so on, "asymptotic K", "Petzold", "Cycles";
    /// empty: all.
    std::string only;
    std::function<void(const std::string&)> say = [](const std::string&) {};
};

}  // namespace uw
