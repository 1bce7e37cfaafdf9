#include "core/integrators/integrator_table.h"

#include <algorithm>
#include <array>

#include "core/integrators/planes_integrator.h"
#include "core/integrators/reference_integrator.h"
#include "core/integrators/volume_integrator.h"

namespace uw {

namespace {

struct Entry {
    RenderDesc::Integrator integrator;
    const IntegratorKind* kind;
};

// The same size as the list of names: omitting an integrator is a compile-time error.
constexpr std::array<Entry, k_integrator_names.size()> k_integrators{
    {{RenderDesc::Integrator::volume, &VolumeIntegrator::k_kind},
     {RenderDesc::Integrator::planes, &PlanesIntegrator::k_kind},
     {RenderDesc::Integrator::reference, &ReferenceIntegrator::k_kind}}};

static_assert(std::ranges::all_of(k_integrator_names, [](const auto& named) {
    return std::ranges::any_of(k_integrators, [&](const Entry& entry) {
        return entry.integrator == named.second && entry.kind != nullptr;
    });
}));

}  // namespace

const IntegratorKind& integrator_kind(RenderDesc::Integrator integrator) {
    return *std::ranges::find(k_integrators, integrator, &Entry::integrator)->kind;
}

}  // namespace uw
