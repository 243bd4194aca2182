// Runs the tests of one file: a test program holds several, and is linked under the name of each (Makefile). By another
// name, or with a filter, it runs what GoogleTest makes of it.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace {

// The tests of the file STEM.cc, as a filter of GoogleTest: full names with colons between them.
std::string tests_of(const std::string& stem)
{
    std::string filter;
    const testing::UnitTest& all = *testing::UnitTest::GetInstance();
    for (int s = 0; s < all.total_test_suite_count(); ++s) {
        const testing::TestSuite& suite = *all.GetTestSuite(s);
        for (int t = 0; t < suite.total_test_count(); ++t) {
            const testing::TestInfo& test = *suite.GetTestInfo(t);
            if (std::filesystem::path(test.file()).stem() == stem)
                filter += std::string(suite.name()) + '.' + test.name() + ':';
        }
    }
    return filter;
}

} // namespace

int main(int argc, char** argv)
{
    testing::InitGoogleTest(&argc, argv);
    if (GTEST_FLAG_GET(filter) == "*")
        if (const std::string filter = tests_of(std::filesystem::path(argv[0]).stem().string()); !filter.empty())
            GTEST_FLAG_SET(filter, filter);
    return RUN_ALL_TESTS();
}
