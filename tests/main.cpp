#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

/// The filter that selects the tests in the source file `file` ("core/base/text.cpp"); "" if there
/// are none.
std::string tests_of(const std::string& file) {
    const std::string path = "tests/" + file;  // as the compiler was told to name it
    const testing::UnitTest& all = *testing::UnitTest::GetInstance();
    std::string filter;
    for (int s = 0; s < all.total_test_suite_count(); ++s) {
        const testing::TestSuite& suite = *all.GetTestSuite(s);
        for (int t = 0; t < suite.total_test_count(); ++t) {
            const testing::TestInfo& test = *suite.GetTestInfo(t);
            if (test.file() != path) continue;
            filter += filter.empty() ? "" : ":";
            filter += suite.name();
            filter += '.';
            filter += test.name();
        }
    }
    return filter;
}

}  // namespace

/// Runs what GoogleTest's options say; with --tests-of=core/base/text.cpp, the tests in that file,
/// of which there must be some.
int main(int argc, char** argv) {
    // Pictures are sRGB, whatever view whoever runs the tests has (core/image/colour_view.h).
    unsetenv("OCIO");
    testing::InitGoogleTest(&argc, argv);
    constexpr std::string_view option = "--tests-of=";
    for (int n = 1; n < argc; ++n) {
        const std::string_view argument = argv[n];
        if (!argument.starts_with(option)) {
            std::fprintf(stderr, "unknown argument '%s'\n", argv[n]);
            return 2;
        }
        const std::string file(argument.substr(option.size()));
        const std::string filter = tests_of(file);
        if (filter.empty()) {
            std::fprintf(stderr, "no tests in '%s'\n", file.c_str());
            return 2;
        }
        testing::GTEST_FLAG(filter) = filter;
    }
    return RUN_ALL_TESTS();
}
