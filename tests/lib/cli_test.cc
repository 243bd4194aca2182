// Messages on stderr and exit status of a tool whose work ends in a warning, an exception or a verdict.

#include "cli/progress_bar.h"
#include "cli/tool.h"
#include "core/error.h"
#include "core/file.h"
#include "own_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>

namespace fettle {
namespace cli_test {

/// Exit status and stderr of a tool that does this.
std::pair<int, std::string> run(const std::function<cli::Verdict(cli::Tool&)>& body,
                                std::vector<std::string> words = {})
{
    words.insert(words.begin(), "fettle-try");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    testing::internal::CaptureStderr();
    const int status = cli::tool_main(static_cast<int>(argv.size()), argv.data(), "tries", body);
    return {status, testing::internal::GetCapturedStderr()};
}

TEST(ToolMain, ReportsEveryEndInOneLine)
{
    using Result = std::pair<int, std::string>;
    const auto throws = [](const auto& what) {
        return [what](cli::Tool& t) -> cli::Verdict {
            t.parse();
            throw what;
        };
    };
    const auto notes = [](cli::Tool& t) {
        t.parse();
        t.note("a note");
        return cli::Verdict::no;
    };
    EXPECT_EQ(run(throws(core::InputError("file", "is wrong"))), Result(2, "fettle-try: file: is wrong\n"));
    EXPECT_EQ(run(throws(std::logic_error("a\nb"))), Result(2, "fettle-try: internal error: a b\n"));
    EXPECT_EQ(run(throws(std::bad_alloc())), Result(2, "fettle-try: out of memory\n"));
    EXPECT_EQ(run(notes, {"-v"}), Result(1, "fettle-try: a note\n"));
    EXPECT_EQ(run(notes), Result(1, ""));
}

// Also a file that no option names.
TEST(ToolMain, KeepsFilesOfWhatHasEndedWell)
{
    const OwnFolder folder;
    const auto writes = [](bool well) {
        return [well](cli::Tool& t) {
            t.parse();
            t.output_file("file") << (well ? "new" : "half");
            if (!well) throw core::InputError("in the middle");
            return cli::Verdict::yes;
        };
    };
    EXPECT_EQ(run(writes(false)).first, 2);
    EXPECT_FALSE(std::filesystem::exists("file"));
    EXPECT_EQ(run(writes(true)).first, 0);
    EXPECT_EQ(core::read_file("file"), "new");
    EXPECT_EQ(run(writes(false)).first, 2);
    EXPECT_EQ(core::read_file("file"), "new");
}

// Nothing in the first second; then a bar now and then, and a line's end at the end.
TEST(ProgressBar, IsShownWhereWorkIsLong)
{
    testing::internal::CaptureStderr();
    const core::Progress quick = cli::progress_bar("quick"), slow = cli::progress_bar("slow");
    quick(0.5), quick(1);
    slow(0.1);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    std::this_thread::sleep_for(std::chrono::milliseconds(1010));
    testing::internal::CaptureStderr();
    slow(0.25);
    for (int i = 0; i < 1000; ++i) slow(0.3); // within a tenth of a second: nothing new
    slow(1);
    const std::string printed = testing::internal::GetCapturedStderr();
    EXPECT_EQ(printed.find("\rslow [##########" + std::string(30, ' ') + "] 25 %\r"), 0u) << printed;
    const std::string end = "\rslow [" + std::string(40, '#') + "] 100 %\n";
    EXPECT_EQ(printed.substr(printed.size() - end.size()), end);
    EXPECT_LT(std::count(printed.begin(), printed.end(), '\r'), 20);
}

} // namespace cli_test
} // namespace fettle
