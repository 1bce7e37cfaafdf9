#include "core/lamps/lamp_profile.h"

namespace uw {

namespace {

template <class... Profiles>
constexpr bool all_are_profiles(const std::variant<Profiles...>* /*type*/) {
    return (IsALampProfile<Profiles> && ...);
}
static_assert(all_are_profiles(static_cast<const LampProfile*>(nullptr)));
static_assert(std::variant_size_v<LampProfile> == std::variant_size_v<LampProfileDesc>);

}  // namespace

LampProfile make_lamp_profile(const LampProfileDesc& desc, const LampPlacement& placement,
                              std::vector<std::string>& warnings) {
    const auto make = [&](const auto& described) -> LampProfile {
        return make_profile(described, placement, warnings);
    };
    return std::visit(make, desc);
}

}  // namespace uw
