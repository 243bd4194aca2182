#include "core/content.h"
#include "core/error.h"
#include "core/file.h"
#include "core/wrong_kind.h"
#include "own_folder.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <thread>
#include <unistd.h>

namespace {

std::function<void()> before_rename; ///< called when a temporary file is there and has not got its name yet

} // namespace

/// Takes the place of the C library's.
extern "C" int rename(const char* from, const char* to) noexcept
{
    if (before_rename) before_rename();
    return static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

namespace fettle {
namespace file_test {

namespace fs = std::filesystem;

class Files : public testing::Test {
  protected:
    static std::size_t files() { return static_cast<std::size_t>(std::distance(fs::directory_iterator("."), {})); }

  private:
    OwnFolder folder_;
};

TEST_F(Files, AppearWholeOrNotAtAll)
{
    const std::string text = "a line\n" + std::string(100000, 'x');
    {
        core::OutputFile file("a");
        file.stream() << "half";
        EXPECT_FALSE(fs::exists("a"));
    }
    EXPECT_EQ(files(), 0u);
    std::ofstream("a") << "old";
    {
        core::OutputFile file("a");
        file.stream() << text;
        EXPECT_EQ(core::read_file("a"), "old");
        file.commit();
    }
    EXPECT_EQ(core::read_file("a"), text);
    EXPECT_EQ(files(), 1u);
}

// JSON is read with lines of any length, and so are binary files.
TEST_F(Files, WithAFirstLineThatNoneOfOursHasAreNotRead)
{
    constexpr std::size_t kLongest = 1 << 16;
    const auto write = [](const std::string& bytes) { std::ofstream("a", std::ios::binary) << bytes; };
    for (const std::string begin : {"x", "\t", "\xef\xbb\xbf#"}) {
        write(begin + std::string(kLongest, 'x'));
        EXPECT_THROW(core::read_file("a"), core::InputError) << begin;
        EXPECT_THROW(core::InputFile("a"), core::InputError) << begin;
    }
    using namespace std::string_literals;
    for (const std::string& begin : {""s, "\n"s, " {"s, "\xef\xbb\xbf["s, "\0"s}) {
        const std::string bytes = begin + std::string(kLongest, 'x');
        write(bytes);
        EXPECT_EQ(core::read_file("a"), bytes);
        EXPECT_EQ(core::InputFile("a").size(), bytes.size());
    }
}

TEST_F(Files, KeepTheirPermissions)
{
    std::ofstream("a") << "old";
    chmod("a", 0640);
    core::OutputFile file("a");
    file.commit();
    struct stat status = {};
    ASSERT_EQ(stat("a", &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST_F(Files, LinksStayAndWhatTheyNameIsReplaced)
{
    fs::create_directory("there");
    std::ofstream("there/b") << "old";
    fs::create_symlink("there/b", "a");
    core::OutputFile file("a");
    file.stream() << "new";
    file.commit();
    EXPECT_TRUE(fs::is_symlink("a"));
    EXPECT_EQ(core::read_file("there/b"), "new");
    EXPECT_EQ(files(), 2u);
}

TEST_F(Files, AreNotThereBeforeTheyAreWhole)
{
    core::OutputFile file("a");
    file.stream() << std::string(3000000, 'x');
    EXPECT_EQ(files(), 0u); // not under another name either: the program may be stopped
    file.commit();
    EXPECT_EQ(files(), 1u);
}

TEST_F(Files, PipesGetAllAtTheEnd)
{
    ASSERT_EQ(mkfifo("pipe", 0600), 0);
    const std::string sent = '\n' + std::string(3000000, 'y');
    std::string got;
    std::thread reader([&got] { got = core::read_file("pipe"); });
    {
        core::OutputFile pipe("pipe");
        pipe.stream() << sent;
        pipe.commit();
    }
    reader.join();
    EXPECT_EQ(got, sent);
}

TEST_F(Files, AreTheSameByWhateverName)
{
    std::ofstream("a") << "x";
    fs::create_symlink("a", "b");
    EXPECT_TRUE(core::same_file("a", "./a"));
    EXPECT_TRUE(core::same_file("a", "b"));
    EXPECT_TRUE(core::same_file("absent", "./absent"));
    EXPECT_TRUE(core::same_file("absent", fs::absolute("absent")));
    EXPECT_TRUE(core::same_file("-", "-"));
    EXPECT_FALSE(core::same_file("a", "absent"));
    EXPECT_FALSE(core::same_file("-", "./-"));
}

TEST_F(Files, FailedWritesAreErrors)
{
    EXPECT_THROW(core::OutputFile("no/where"), core::InputError);
    EXPECT_THROW(core::OutputFile("."), core::InputError);
    EXPECT_THROW(core::OutputFile(""), core::InputError);
    core::OutputFile full("/dev/full");
    full.stream() << "x";
    EXPECT_THROW(full.commit(), core::InputError);
    core::OutputFile nothing("/dev/null");
    nothing.stream() << "x";
    nothing.commit();
}

TEST_F(Files, AreRemovedWhenTheyCannotBeNamed)
{
    core::OutputFile file("a");
    file.stream() << "x";
    fs::create_directory("a");
    EXPECT_THROW(file.commit(), core::InputError);
    EXPECT_TRUE(fs::is_directory("a"));
    EXPECT_EQ(files(), 1u);
}

volatile std::sig_atomic_t signals = 0;

void commit_and_raise(int count, sighandler_t handler)
{
    struct sigaction action = {};
    action.sa_handler = handler;
    action.sa_flags = int(SA_RESETHAND);
    sigaction(SIGTERM, &action, nullptr);
    before_rename = [count] {
        for (int i = 0; i < count; ++i) raise(SIGTERM);
    };
    core::OutputFile file("a");
    file.stream() << "new";
    file.commit();
    before_rename = {};
}

[[noreturn]] void exit_after_signals(int count, sighandler_t handler)
{
    commit_and_raise(count, handler);
    std::_Exit(core::read_file("a") == "new" ? 10 + signals : 1);
}

// A program may want to do something else at the first signal, as fettle-station does; the second ends it.
TEST_F(Files, AreRemovedWhenASignalComesBeforeTheyAreNamed)
{
    const auto count = [](int) { signals = signals + 1; };
    EXPECT_EXIT(exit_after_signals(1, SIG_DFL), testing::KilledBySignal(SIGTERM), "");
    EXPECT_EXIT(exit_after_signals(2, count), testing::KilledBySignal(SIGTERM), "");
    EXPECT_EQ(files(), 0u);
    EXPECT_EXIT(exit_after_signals(2, SIG_IGN), testing::ExitedWithCode(10), "");
    EXPECT_EQ(files(), 1u);
    commit_and_raise(1, count); // the handler is called, and then there is none
    EXPECT_EQ(signals, 1);
    EXPECT_EQ(core::read_file("a"), "new");
    struct sigaction left = {};
    sigaction(SIGTERM, nullptr, &left);
    EXPECT_EQ(left.sa_handler, SIG_DFL);
}

// What was written lies on another disk by then.
TEST_F(Files, AreCopiedWhereTheyCannotBeNamed)
{
    const fs::path other = fs::path("/dev/shm") / fs::current_path().filename();
    struct stat here = {}, there = {};
    if (stat(".", &here) != 0 || stat("/dev/shm", &there) != 0 || here.st_dev == there.st_dev)
        GTEST_SKIP() << "/dev/shm is no other disk";
    fs::create_directory("folder");
    core::OutputFile file("folder/a");
    const std::string text = "a line\n" + std::string(3000000, 'x');
    file.stream() << text;
    fs::rename("folder", "away");
    fs::create_directory(other);
    fs::create_symlink(other, "folder");
    file.commit();
    EXPECT_EQ(core::read_file("folder/a"), text);
    EXPECT_EQ(std::distance(fs::directory_iterator(other), {}), 1);
    EXPECT_TRUE(fs::is_empty("away"));
    fs::remove_all(other);
}

TEST_F(Files, ReadFromWhatIsNoFile)
{
    EXPECT_THROW(core::read_file("absent"), core::InputError);
    EXPECT_THROW(core::read_file("."), core::InputError);
    EXPECT_THROW(core::read_file(""), core::InputError);
    EXPECT_EQ(core::read_file("/dev/null"), "");
    ASSERT_EQ(mkfifo("pipe", 0600), 0);
    const std::string sent = '\n' + std::string(3000000, 'y');
    std::thread writer([&sent] { std::ofstream("pipe") << sent; });
    EXPECT_EQ(core::read_file("pipe"), sent);
    writer.join();
}

std::string part(const core::InputFile& file, std::size_t offset, std::size_t count)
{
    std::string bytes(count, '\0');
    file.read(offset, bytes.data(), count);
    return bytes;
}

TEST_F(Files, AreReadAnywhere)
{
    std::string sent;
    for (int i = 0; sent.size() < 3000000; ++i) sent += std::to_string(i) + "\n";
    std::ofstream("whole") << sent;
    ASSERT_EQ(mkfifo("pipe", 0600), 0);
    for (const std::size_t size : {std::size_t{0}, std::size_t{100}, sent.size()}) { // nothing, held, copied
        std::thread writer([&] { std::ofstream("pipe") << sent.substr(0, size); });
        const core::InputFile pipe("pipe");
        writer.join();
        EXPECT_EQ(pipe.size(), size);
        EXPECT_EQ(part(pipe, 0, size), sent.substr(0, size));
        if (size == 0) continue;
        EXPECT_EQ(part(pipe, size - 50, 50), sent.substr(size - 50, 50));
    }
    const core::InputFile whole("whole");
    EXPECT_EQ(whole.size(), sent.size());
    EXPECT_EQ(part(whole, 2000000, 1000), sent.substr(2000000, 1000));
    fs::resize_file("whole", 1000);
    EXPECT_THROW(part(whole, 2000000, 1000), core::InputError);
    EXPECT_THROW(core::InputFile("absent"), core::InputError);
    EXPECT_THROW(core::InputFile("."), core::InputError);
}

// Known by their first bytes, whatever their case; a binary STL by its size.
TEST(Content, IsNamed)
{
    using namespace std::string_literals;
    const auto name = [](const std::string& bytes) { return core::describe_content(bytes).value_or("text"); };
    EXPECT_EQ(name(""), "empty");
    EXPECT_EQ(name("\x89PNG\r\n\x1a\n"), "a PNG picture");
    EXPECT_EQ(name("%PDF-1.7\n"), "a PDF document");
    EXPECT_EQ(name("\x7f"s + "ELF\2\1\1\0"s), "a program (ELF)");
    EXPECT_EQ(name("\x1f\x8b\b\0"s), "compressed by gzip");
    EXPECT_EQ(name("<!doctype HTML>"), "an HTML page");
    EXPECT_EQ(name("\xff\xfe" + "a\0b\0"s), "text in UTF-16");
    EXPECT_EQ(name("a\0b\0"s), "text in UTF-16");
    EXPECT_EQ(name("\0a\0b"s), "text in UTF-16");
    EXPECT_EQ(name(std::string(50, '\0')), "nothing but zero bytes");
    EXPECT_EQ(name("\nabc\x01\n"), "binary data of no known format");
    std::string stl = "\x89PNG\r\n" + std::string(74, ' ') + "\1\0\0\0"s + std::string(50, '\0');
    EXPECT_EQ(name(stl), "a binary STL mesh");
    EXPECT_EQ(name(stl + "x"), "a PNG picture");
    for (const char* text : {"1 2 3\n", "{}", "# .PCD v0.7\n", "ply\r\n", "v 1 2 3\n", "G0 X1\n", "# .PCD v0.7\n\x01",
                             "\t1\f2\v\x1a", "\xc3\xa4"})
        EXPECT_EQ(name(text), "text") << text;
    EXPECT_NO_THROW(core::refuse_other_content("1 2 3", "a", "points"));
    EXPECT_THROW(core::refuse_other_content("%PDF-", "a", "points"), core::WrongFileType);
}

} // namespace file_test
} // namespace fettle
