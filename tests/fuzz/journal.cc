// The numbers of a belt run's journal, under a digest that fits. What was read is consistent, and is written the same.

#include "belt/belt_journal_file.h"
#include "fuzz.h"

using namespace fettle;

namespace {

constexpr std::size_t kPathLength = 4;
constexpr Eigen::Index kCells = 2;

belt::BeltCheckpoint initial()
{
    belt::BeltCheckpoint checkpoint;
    checkpoint.displacement.setConstant(3, 0.1);
    checkpoint.state.run.removed.setZero(3);
    checkpoint.state.error = belt::running_error(checkpoint.displacement, {0, 1});
    return checkpoint;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const std::string digest(64, 'a');
    const std::string journal = belt::seal_journal(digest, fuzz::text_of(data, size));
    belt::BeltCheckpoint found;
    if (!fuzz::is_read([&] { found = belt::decode_journal(journal, digest, initial(), kPathLength, kCells); }))
        return 0;
    fuzz::require(found.displacement.size() == 3 && found.state.run.trace.size() == found.state.next_point,
                  "it is a checkpoint of this run");
    fuzz::require(belt::encode_journal(digest, found) == journal, "it is written the same");
    return 0;
}
