// The file from which a killed run resumes: what was written is read, and nothing else.

#include "belt/belt_journal_file.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

using namespace fettle;

namespace belt_journal_test {

constexpr Eigen::Index kSurfels = 3, kCells = 2;
constexpr std::size_t kPathLength = 5;
const std::string kDigest(64, 'a');

belt::BeltCheckpoint initial()
{
    belt::BeltCheckpoint checkpoint;
    checkpoint.displacement = Eigen::Vector3d(0.1, 0.2, std::numeric_limits<double>::quiet_NaN());
    checkpoint.state.run.removed.setZero(kSurfels);
    checkpoint.state.error = belt::running_error(checkpoint.displacement, {0, 0.15});
    return checkpoint;
}

/// After two of the five points.
belt::BeltCheckpoint ground()
{
    belt::BeltCheckpoint checkpoint = initial();
    checkpoint.displacement[1] = 0.15;
    belt::BeltState& state = checkpoint.state;
    state.next_point = 2;
    state.run.removed[1] = 0.05;
    state.run.trace = {{1, 1, 10, 0.1, 0.2, 30, 4}, {2, 1, 11, 0.1, 0.2, 31, 5}};
    state.run.errors = {{0, 1, 1, 0.1, 0.1, 0.1}, {0, 2, 0, 0.1, 0.1, 0.1}};
    const removal::RemovalTrial trial{10, std::numeric_limits<double>::quiet_NaN(), 4, 0, 1e5, 3, 0.01};
    state.run.passes = {{trial, 7, 0.9, 1e5, 0.8, {trial}}};
    state.contact.grid = {{1, 2}, kCells, kCells};
    state.contact.pressure = Eigen::Matrix2d::Constant(0.3);
    return checkpoint;
}

belt::BeltCheckpoint decode(const std::string& journal)
{
    return belt::decode_journal(journal, kDigest, initial(), kPathLength, kCells);
}

bool is_refused(const std::string& journal)
{
    try {
        decode(journal);
        return false;
    } catch (const core::InputError&) {
        return true;
    }
}

/// The journal of ground() with another number in some place.
std::string with_number(std::size_t place, double number)
{
    const std::string journal = belt::encode_journal(kDigest, ground());
    std::string numbers = journal.substr(journal.find(kDigest) + kDigest.size() + 1);
    std::memcpy(numbers.data() + place * sizeof number, &number, sizeof number);
    return belt::seal_journal(kDigest, numbers);
}

TEST(BeltJournal, ReadsWhatWasWritten)
{
    const std::string journal = belt::encode_journal(kDigest, ground());
    const belt::BeltCheckpoint found = decode(journal);
    EXPECT_EQ(found.state.next_point, 2u);
    EXPECT_EQ(found.displacement[1], 0.15);
    EXPECT_EQ(found.state.run.trace[1].removed_volume, 5);
    ASSERT_EQ(found.state.run.passes.size(), 1u);
    EXPECT_TRUE(std::isnan(found.state.run.passes[0].trial.speed));
    EXPECT_EQ(found.state.run.passes[0].feed_factor, 0.8);
    ASSERT_EQ(found.state.run.passes[0].parts.size(), 1u);
    EXPECT_EQ(found.state.run.passes[0].parts[0].deviation, 0.01);
    EXPECT_EQ(found.state.contact.pressure, ground().state.contact.pressure);
    EXPECT_EQ(belt::encode_journal(kDigest, found), journal);
    EXPECT_FALSE(is_refused(belt::encode_journal(kDigest, initial())));
}

TEST(BeltJournal, RefusesEveryFlippedBitAndEveryMissingByte)
{
    const std::string journal = belt::encode_journal(kDigest, ground());
    for (std::size_t bit = 0; bit < 8 * journal.size(); ++bit) {
        std::string flipped = journal;
        flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
        EXPECT_TRUE(is_refused(flipped)) << "bit " << bit;
    }
    for (std::size_t size = 0; size < journal.size(); ++size) EXPECT_TRUE(is_refused(journal.substr(0, size)));
    EXPECT_TRUE(is_refused(journal + std::string(sizeof(double), '\0')));
    EXPECT_TRUE(is_refused("fettle-belt journal 1\n" + journal));
}

// Sizes are checked against the size of the file and those of the run before memory is allocated.
TEST(BeltJournal, RefusesSizesOfAnotherRun)
{
    const std::size_t numbers = (belt::encode_journal(kDigest, ground()).size() - 22 - 65 - 65) / sizeof(double);
    ASSERT_FALSE(is_refused(with_number(0, 2)));
    std::size_t refused = 0;
    for (std::size_t place = 0; place < numbers; ++place)
        for (const double number : {-1.0, 0.5, 7.0, 1e9, 1e300, std::numeric_limits<double>::quiet_NaN()})
            refused += is_refused(with_number(place, number)) ? 1 : 0;
    // Each of the sixteen counts and sizes refuses nearly all of them.
    EXPECT_GT(refused, 16u * 5);
    for (const std::size_t place : {0, 1, 2, 6, 7}) EXPECT_TRUE(is_refused(with_number(place, 1e9)));
}

// A change of sign is a change of the highest bit alone: it must not be cancelled by another one.
TEST(BeltJournal, TellsAMirroredPartFromThePart)
{
    belt::Surfels surfels;
    surfels.position = Eigen::Matrix3Xd::Random(3, 4);
    surfels.normal = Eigen::Vector3d::UnitZ().replicate(1, 4);
    surfels.displacement = Eigen::Vector4d::Constant(0.1);
    const std::string digest = belt::run_digest(surfels, {}, {}, {});
    EXPECT_EQ(digest, belt::run_digest(surfels, {}, {}, {}));
    surfels.position.row(0) *= -1;
    EXPECT_NE(digest, belt::run_digest(surfels, {}, {}, {}));
}

} // namespace belt_journal_test
