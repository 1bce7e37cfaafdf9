#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/paths/path_scene.h"
#include "tests/support/paths/term_sums.h"
#include "tests/support/phase_test_values.h"

/// Exact radiance and fluence around a point lamp in endless uniform water (tests/data/multiple),
/// and their estimates.
namespace uw::test {

/// A lamp is a sphere of a millimetre inside which nothing is scattered, those of the tables are
/// points. Therefore all is a hundred times as large as in the tables and the water as much
/// clearer, so that the sphere is one of 10 um: radiance and fluence are 1e-4 of the tables'.
inline constexpr double k_enlarged = 100;
inline constexpr double k_to_table = k_enlarged * k_enlarged;

/// A row of a table.
struct TableRow {
    double albedo = 0, r = 0, psi_degrees = 0;
    std::vector<double> orders;  // from 1
    double total = 0;            // fluence: with order 0
};

inline std::vector<TableRow> read_path_table(const std::string& file, bool is_fluence) {
    const CsvTable table = phase_test_table("multiple/" + file);
    std::vector<TableRow> rows(table.row_count());
    const auto fill = [&](const std::string& column, const auto& put) {
        const std::vector<double> values = table.numbers(column);
        for (std::size_t i = 0; i < rows.size(); ++i) put(rows[i], values[i]);
    };
    fill("r_m", [](TableRow& row, double x) { row.r = x; });
    fill("total", [](TableRow& row, double x) { row.total = x; });
    if (is_fluence)
        fill("albedo", [](TableRow& row, double x) { row.albedo = x; });
    else
        fill("psi_deg", [](TableRow& row, double x) { row.psi_degrees = x; });
    for (int n = 1; n <= 5; ++n)
        fill((is_fluence ? "order" : "L") + std::to_string(n),
             [](TableRow& row, double x) { row.orders.push_back(x); });
    return rows;
}

/// c = 1/m of the table; a lamp of 1 W/sr at the origin.
inline PathScene table_scene(const std::vector<double>& albedos, double g) {
    std::vector<BandOptics> bands;
    for (const double albedo : albedos)
        bands.push_back({(1 - albedo) / k_enlarged, albedo / k_enlarged});
    PathScene scene(bands, g);
    scene.add_lamp({0, 0, 0}, 1);
    return scene;
}

/// The ray from a point at distance r that makes `psi` with the direction to the lamp.
inline Ray table_ray(double r, double psi) {
    return {{0, 0, -r * k_enlarged}, {std::sin(psi), 0, std::cos(psi)}};
}

/// How many paths estimate a row: batches of `directions` (for fluence) times `paths`.
struct TableEffort {
    std::size_t batches = 32;
    std::uint32_t paths = 1 << 12;
    int directions = 64;
};

/// Compares the radiance of one row, by order and in total.
inline void compare_radiance(const TableRow& row, const TableEffort& effort, std::uint64_t seed,
                             Deviations& deviations) {
    const PathScene scene = table_scene({0.8}, 0.9);
    const PathTracer tracer(scene.lit());
    const double psi = row.psi_degrees * (std::numbers::pi / 180);
    const auto batches =
        run_batches(effort.batches, 1, seed, [&](std::uint64_t batch_seed, TermSums& sums) {
            trace_ray(tracer, *scene.surfaces, table_ray(row.r, psi), batch_seed, effort.paths,
                      sums, k_to_table);
        });
    const std::string where =
        "r " + std::to_string(row.r) + " psi " + std::to_string(row.psi_degrees);
    for (int n = 1; n <= 4; ++n)
        deviations.add(where + " L" + std::to_string(n),
                       means_of(batches, [&](const TermSums& s) { return s.order(0, n); }),
                       row.orders[static_cast<std::size_t>(n - 1)]);
    deviations.add(where + " total",
                   means_of(batches, [](const TermSums& s) { return s.total(0); }), row.total);
}

/// 4 pi r^2 fluence / power by quadrature over psi = pi t^2, which resolves the directions around
/// that of the lamp, at `directions` points with a random offset for each batch. In band b compares
/// with rows[b].
inline void compare_fluence(const std::vector<TableRow>& rows, double g, const TableEffort& effort,
                            std::uint64_t seed, Deviations& deviations) {
    constexpr double pi = std::numbers::pi;
    std::vector<double> albedos;
    for (const TableRow& row : rows) albedos.push_back(row.albedo);
    const PathScene scene = table_scene(albedos, g);
    const PathTracer tracer(scene.lit());
    const double r = rows.front().r;
    const auto make_batch = [&](std::uint64_t batch_seed, TermSums& sums) {
        const double offset = PathRandom(PathRandom::seed_of(batch_seed, 10), 0).next();
        for (int i = 0; i < effort.directions; ++i) {
            const double t = (i + offset) / effort.directions, psi = pi * t * t;
            const double solid_angle = 4 * pi * pi * t * std::sin(psi) / effort.directions;
            trace_ray(tracer, *scene.surfaces, table_ray(r, psi),
                      PathRandom::seed_of(batch_seed, 11, static_cast<std::uint64_t>(i)),
                      effort.paths, sums, solid_angle * r * r * k_to_table);
        }
    };
    const auto batches = run_batches(effort.batches, rows.size(), seed, make_batch);
    for (std::size_t b = 0; b < rows.size(); ++b) {
        const std::string where =
            "albedo " + std::to_string(rows[b].albedo) + " r " + std::to_string(r);
        for (int n = 1; n <= 5; ++n)
            deviations.add(where + " order " + std::to_string(n),
                           means_of(batches, [&](const TermSums& s) { return s.order(b, n); }),
                           rows[b].orders[static_cast<std::size_t>(n - 1)]);
        // Unscattered light is no path: I e^(-c r) / r^2.
        deviations.add(
            where + " total",
            means_of(batches, [&](const TermSums& s) { return s.total(b) + std::exp(-r); }),
            rows[b].total);
    }
}

}  // namespace uw::test
