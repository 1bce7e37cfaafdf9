#include "media/water/phase_functions.h"

#include <fmt/format.h>

#include <string_view>
#include <variant>

#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "media/water/fournier_forand.h"
#include "media/water/henyey_greenstein.h"
#include "media/water/molecular_phase.h"
#include "media/water/tabulated_phase.h"

namespace uw {

namespace {

/// A phase table is a few kilobytes; anything larger is some other file.
constexpr std::size_t k_max_table_file = std::size_t{4} << 20;

std::shared_ptr<const PhaseFunction> table_phase(const TabulatedPhaseDesc& desc,
                                                 const SourceLocation& where,
                                                 std::vector<std::string>& warnings) {
    const std::string name = desc.file.filename().string();
    const std::string text =
        read_text_file(desc.file, fmt::format("{}: {}", where, printable(desc.file.string(), 300)),
                       k_max_table_file, "phase function table (CSV with columns angle_deg,phase)");
    auto phase =
        std::make_shared<TabulatedPhase>(CsvTable(text, name).curve("angle_deg", "phase"), name);
    // Published tables integrate to 1 within a few per cent.
    const double integral = phase->table_integral();
    if (integral < 0.9 || integral > 1.1)
        warnings.push_back(
            fmt::format("{}: {} integrates to {:.4g}, not 1; its shape is used, "
                        "scaled to 1",
                        where, name, integral));
    if (phase->extrapolated_fraction() > 0.1)
        warnings.push_back(
            fmt::format("{}: {:.0f} % of the scattering lies outside the angles of "
                        "{}; add smaller and larger angles",
                        where, 100 * phase->extrapolated_fraction(), name));
    return phase;
}

/// One overload for each alternative of PhaseFunctionDesc.
struct MakePhaseFunction {
    using Made = std::shared_ptr<const PhaseFunction>;
    const SourceLocation& where;
    std::vector<std::string>& warnings;

    Made operator()(const HenyeyGreensteinDesc& desc) const {
        return std::make_shared<HenyeyGreenstein>(desc.g);
    }
    Made operator()(const FournierForandDesc& desc) const {
        return std::make_shared<FournierForand>(desc.n, desc.mu);
    }
    /// Petzold's average particle phase function (Mobley, Gentili and Stavn 1993, table 2),
    /// continued below 0.1 degrees as psi^-1.346. With log-log interpolation its table integrates
    /// to 0.9926; here it is normalised to 1.
    Made operator()(const PetzoldDesc& /*desc*/) const {
        return std::make_shared<TabulatedPhase>(
            read_embedded_table("petzold_average_particle_phase.csv")
                .curve("angle_deg", "phase_per_sr"),
            "petzold average particle", -1.346);
    }
    Made operator()(const TabulatedPhaseDesc& desc) const {
        return table_phase(desc, where, warnings);
    }
    Made operator()(const MolecularPhaseDesc& /*desc*/) const {
        return std::make_shared<MolecularPhase>();
    }
};

}  // namespace

std::shared_ptr<const PhaseFunction> make_phase_function(const PhaseDesc& desc,
                                                         std::vector<std::string>& warnings) {
    try {
        return std::visit(MakePhaseFunction{desc.where, warnings}, desc.function);
    } catch (const InputError& error) {
        const std::string_view message = error.what();
        if (message.starts_with(desc.where)) throw;
        throw InputError(fmt::format("{}: {}", desc.where, message));
    }
}

}  // namespace uw
