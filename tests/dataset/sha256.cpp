// ctest labels: unit analytic
#include "dataset/set_files.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

// The examples that NIST gives with FIPS 180-4.
TEST(Sha256, HasTheStandardsDigests) {
    EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256_of(std::string(1'000'000, 'a')),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnTheParts) {
    const std::string text = std::string(200, 'x') + "abc";
    for (std::size_t first = 0; first <= text.size(); ++first) {
        Sha256 sum;
        sum.add(std::string_view(text).substr(0, first));
        sum.add(std::string_view(text).substr(first));
        EXPECT_EQ(sum.digest(), sha256_of(text)) << first;
    }
}

TEST(Sha256, MissingFile) {
    EXPECT_THROW(sha256_of_file("no such file"), IoError);
}

}  // namespace
}  // namespace uw
