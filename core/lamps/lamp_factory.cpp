#include "core/lamps/lamp_factory.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/base/error.h"
#include "core/colour/lamp_spectrum.h"
#include "core/lamps/ies_file.h"

namespace uw {

namespace {

// Lumens in a file are of the bare lamps: the luminaire may keep much for itself, but gives no
// more.
constexpr double k_flux_tolerance = 0.01;
constexpr double k_least_efficiency = 0.1;

std::shared_ptr<const PhotometricWeb> read_web(const LampProfileDesc& profile,
                                               std::vector<std::string>& warnings) {
    const IesFile file = read_ies(profile.file);
    for (const std::string& warning : file.warnings)
        warnings.push_back(profile.where + ": " + warning);
    auto web = std::make_shared<const PhotometricWeb>(file);
    const double flux = web->flux();
    if (file.lumens > 0 && flux > (1 + k_flux_tolerance) * file.lumens)
        warnings.push_back(fmt::format(
            "{}: the candelas of {} add up to {:.4g} lm, more than the {:.4g} lm of its "
            "lamps; check its multiplier and its lumens",
            profile.where, profile.file.filename().string(), flux, file.lumens));
    if (file.lumens > 0 && flux < k_least_efficiency * file.lumens)
        warnings.push_back(
            fmt::format("{}: the candelas of {} add up to {:.4g} lm, {:.2g} % of the {:.4g} lm of "
                        "its lamps; check its multiplier (candelas may be per 1000 lm)",
                        profile.where, profile.file.filename().string(), flux,
                        100 * flux / file.lumens, file.lumens));
    return web;
}

LampSpectrum spectrum_of(const LampDesc& desc, std::vector<std::string>& warnings) {
    if (desc.spectrum) return make_lamp_spectrum(*desc.spectrum);
    LampSpectrum flat = make_lamp_spectrum({});
    warnings.push_back(
        fmt::format("{}: its candelas are taken as those of a flat spectrum, 380 to 780 nm, {:.0f} "
                    "lm/W; give its spectrum, such as spectrum: {{type: led, name: LED-B4}}",
                    desc.where, luminous_efficacy(flat)));
    return flat;
}

// Sets watts per band where the lamp is given by its spectrum, by lumens or by candelas.
void resolve_output(LampDesc& desc, const PhotometricWeb* web, std::span<const double> bands_nm,
                    std::vector<std::string>& warnings) {
    const bool candelas = !desc.intensity && !desc.power && !desc.lumens;
    if (!desc.spectrum && !candelas) return;
    const SourceLocation& where = desc.spectrum ? desc.spectrum->where : desc.where;
    if (bands_nm.size() < 2)
        throw InputError(
            fmt::format("{}: how much of a spectrum falls into the only band is not known, for it "
                        "has no neighbours; give the lamp's intensity or power in that band",
                        where));
    const LampSpectrum spectrum = spectrum_of(desc, warnings);
    const std::vector<BandInterval> intervals = band_intervals(bands_nm);
    const auto per_band = [&](double total) { return band_values(spectrum, total, intervals); };
    const auto watts = [&](double lumens) {
        const double efficacy = luminous_efficacy(spectrum);
        if (!(efficacy > 0))
            throw InputError(fmt::format(
                "{}: nothing of this spectrum is visible (360 to 830 nm), so that lumens and "
                "candelas say nothing of it; give intensity or power in W",
                where));
        return lumens / efficacy;
    };
    if (desc.intensity)
        desc.intensity = per_band(desc.intensity->front());
    else if (desc.power)
        desc.power = per_band(desc.power->front());
    else if (desc.lumens)
        desc.power = per_band(watts(*desc.lumens));
    else
        desc.intensity = per_band(watts(web->peak()));
    const PerBand& values = desc.power ? *desc.power : *desc.intensity;
    if (*std::ranges::max_element(values) <= 0)
        throw InputError(fmt::format(
            "{}: has no light in any band of the scene; check its wavelengths and water.bands",
            where));
}

}  // namespace

Lamp make_lamp(const LampDesc& given, const Affine& world_from_camera,
               std::span<const double> bands_nm, std::vector<std::string>& warnings) {
    LampDesc desc = given;
    std::shared_ptr<const PhotometricWeb> web;
    if (desc.profile.type == LampProfileDesc::Type::ies) web = read_web(desc.profile, warnings);
    resolve_output(desc, web.get(), bands_nm, warnings);
    return {desc, world_from_camera, static_cast<int>(bands_nm.size()), std::move(web)};
}

}  // namespace uw
