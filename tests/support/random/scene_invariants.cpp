#include "tests/support/random/scene_invariants.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <ctime>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/light/integrator_table.h"
#include "render/scene_loading.h"
#include "tests/support/random/held_image.h"
#include "tests/support/random/random_scene.h"

namespace uw::test {
namespace {

// The time of all threads.
double cpu_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

InvariantCounts hold_invariants(std::uint64_t first, int count, Scattered scattered) {
    InvariantCounts counts;
    for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(count); ++seed) {
        const std::string text = random_scene(seed);
        const double start = cpu_seconds();
        SCOPED_TRACE(fmt::format("seed {}:\n{}", seed, text));
        try {
            const ImageScene scene(load_scene_text(text, "random.yaml"));
            if (scattered == Scattered::once &&
                scattering_of(scene.desc().render) != RenderDesc::Scattering::single) {
                ++counts.left_out;
                continue;
            }
            hold_image(scene, counts);
            ++counts.rendered;
        } catch (const InputError& error) {
            EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
            ++counts.refused;
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what();
        }
        const double seconds = cpu_seconds() - start;
        if (seconds > counts.slowest_cpu_seconds) {
            counts.slowest_seed = seed;
            counts.slowest_cpu_seconds = seconds;
        }
    }
    return counts;
}

}  // namespace uw::test
