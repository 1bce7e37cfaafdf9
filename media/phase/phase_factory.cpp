#include "media/phase/phase_factory.h"

#include <fmt/format.h>

#include <string_view>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/files/text_file.h"
#include "media/phase/fournier_forand.h"
#include "media/phase/henyey_greenstein.h"
#include "media/phase/molecular_phase.h"
#include "media/phase/tabulated_phase.h"

namespace uw {

namespace {

/// A phase table is a few kilobytes; anything larger is some other file.
constexpr std::size_t k_largest_table_file = std::size_t{4} << 20;

std::shared_ptr<const PhaseFunction> table_phase(const TabulatedPhaseDesc& desc,
                                                 const SourceLocation& where,
                                                 std::vector<std::string>& warnings) {
    const std::string name = desc.file.filename().string();
    const std::string text = read_text_file(
        desc.file, fmt::format("{}: {}", where, printable(desc.file.string(), 300)),
        k_largest_table_file, "phase function table (CSV with columns angle_deg,phase)");
    auto phase = std::make_shared<TabulatedPhase>(read_phase_table(text, name));
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
    Made operator()(const PetzoldDesc& /*desc*/) const {
        return std::make_shared<PetzoldAverage>();
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
