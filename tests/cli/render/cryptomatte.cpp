// ctest labels: analytic
#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

using Cryptomatte = test::CliTest;

/// What the specification says of a pixel: the share of an identifier among six.
float coverage(const test::ImageFile& image, const std::string& name, float id, int x, int y) {
    float sum = 0;
    for (const char* layer : {"00", "01", "02"})
        for (const auto& [of_id, of_share] : {std::pair{".R", ".G"}, std::pair{".B", ".A"}})
            if (image.at(name + layer + of_id, x, y) == id)
                sum += image.at(name + layer + of_share, x, y);
    return sum;
}

/// The identifiers by name in the manifest of a header.
std::map<std::string, float> manifest_of(const test::ImageFile& image, const std::string& name) {
    std::map<std::string, float> ids;
    for (const auto& [key, value] : image.metadata) {
        if (!key.starts_with("cryptomatte/") || !key.ends_with("/name") || value != name) continue;
        const std::string begin = key.substr(0, key.rfind('/') + 1);
        EXPECT_EQ(image.metadata.at(begin + "hash"), "MurmurHash3_32");
        EXPECT_EQ(image.metadata.at(begin + "conversion"), "uint32_to_float32");
        const auto manifest = nlohmann::json::parse(image.metadata.at(begin + "manifest"));
        for (const auto& [surface, hex] : manifest.items()) {
            const auto bits = std::stoul(hex.get<std::string>(), nullptr, 16);
            ids[surface] = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
        }
    }
    return ids;
}

TEST_F(Cryptomatte, CoverageIsTheShareOfThePixelInAnImageEightTimesAsFine) {
    const test::ImageFile fine = render({"--layers", "id", "--size", "264x152", "--samples", "1"});
    const std::string names = fine.metadata.at("uwvdb/id_names");
    const test::ImageFile image = render({"--layers", "crypto_object", "--samples", "64"});
    const auto ids = manifest_of(image, "CryptoObject");
    ASSERT_EQ(ids.size(), 2U);
    const auto numbers = nlohmann::json::parse(names);
    int partial = 0;
    double sum = 0, sum_off = 0;
    for (const auto& [name, id] : ids)
        for (int y = 0; y < 19; ++y)
            for (int x = 0; x < 33; ++x) {
                int inside = 0;
                for (int k = 0; k < 64; ++k) {
                    const auto number =
                        static_cast<int>(fine.at("id.V", 8 * x + k % 8, 8 * y + k / 8));
                    inside += numbers.at(std::to_string(number)) == name ? 1 : 0;
                }
                const double wanted = inside / 64.0;
                const double off = std::abs(
                    static_cast<double>(coverage(image, "CryptoObject", id, x, y)) - wanted);
                sum += wanted;
                if (inside == 0 || inside == 64) {
                    EXPECT_LE(off, 0.1) << name << " " << x << " " << y;
                    continue;
                }
                ++partial;
                sum_off += off;
                EXPECT_LE(off, 0.15) << name << " " << x << " " << y;
            }
    EXPECT_NEAR(sum, 33 * 19, 1e-9);  // the wall or the box everywhere
    EXPECT_GT(partial, 20);
    EXPECT_LT(sum_off / partial, 0.05);
}

TEST_F(Cryptomatte, SharesAddUpUnderEveryIntegratorAndPrecision) {
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--precision", "half"},
                                                 {"--integrator", "path", "--samples", "16"},
                                                 {"--integrator", "reference"}}) {
        std::vector<std::string> arguments{"--layers", "crypto_object,crypto_material", "--size",
                                           "16x9"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::ImageFile image = render(arguments);
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 16; ++x) {
                float sum = 0;
                for (const auto& [name, id] : manifest_of(image, "CryptoObject"))
                    sum += coverage(image, "CryptoObject", id, x, y);
                EXPECT_FLOAT_EQ(sum, 1) << more.back() << " " << x << " " << y;
                EXPECT_EQ(image.at("CryptoMaterial00.R", x, y), 0);  // shapes have none of a file
            }
    }
}

TEST_F(Cryptomatte, IsNoPartOfAllLayers) {
    EXPECT_FALSE(render().channels.contains("CryptoObject00.R"));
}

}  // namespace
}  // namespace uw
