#include "core/spool.h"

#include "core/error.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

namespace fettle {
namespace spool_test {

// Whatever goes in comes out, from memory, from the file and across the border between them.
TEST(Spool, GivesBackWhatItTook)
{
    std::mt19937 random(1);
    for (const std::size_t memory : {std::size_t{0}, std::size_t{1000}, std::size_t{1 << 21}, std::size_t{1} << 40}) {
        core::Spool spool(memory);
        std::string all;
        for (int part = 0; part < 40; ++part) {
            std::string bytes(random() % 200000, '\0');
            for (char& byte : bytes) byte = static_cast<char>(random());
            spool.append(bytes);
            all += bytes;
        }
        ASSERT_EQ(spool.size(), all.size());
        for (int trial = 0; trial < 200; ++trial) {
            const std::size_t first = random() % all.size(), count = random() % (all.size() - first + 1);
            std::string got(count, '\0');
            spool.read(first, got.data(), count);
            ASSERT_TRUE(got == all.substr(first, count)) << memory << ' ' << first << ' ' << count;
        }
    }
}

TEST(Spool, NamesTheFileThatItCannotWrite)
{
    const char* before = std::getenv("TMPDIR");
    const std::string kept = before == nullptr ? "" : before;
    setenv("TMPDIR", "/no/where", 1);
    core::Spool spool(10);
    spool.append("in memory");
    std::string message;
    try {
        spool.append("no longer");
    } catch (const core::InputError& error) {
        message = error.what();
    }
    before == nullptr ? unsetenv("TMPDIR") : setenv("TMPDIR", kept.c_str(), 1);
    EXPECT_EQ(message, "/no/where/scratch: cannot make a temporary file: No such file or directory");
}

} // namespace spool_test
} // namespace fettle
