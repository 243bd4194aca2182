// Machine programs. The moves that were read are written as a program that reads as moves to the same places.

#include "fuzz.h"
#include "machining/nc_block.h"
#include "machining/nc_program.h"
#include "machining/nc_writer.h"

#include <sstream>

using namespace fettle;

namespace {

/// Rounding error of a writer with five decimals of a mm.
constexpr double kRounding = 1e-5;

void check_round_trip(const machining::NcProgram& program)
{
    std::ostringstream out;
    machining::NcWriter writer(out);
    out << "G21 G90 G17\n";
    writer.move_to(program.moves.front().from, 0);
    const auto begun = out.tellp();
    for (const machining::CutterMove& move : program.moves) writer.move_to(move);
    if (out.tellp() == begun) return; // all of them shorter than five decimals show
    machining::NcProgram again;
    const bool is_read = fuzz::is_read([&] { again = machining::parse_nc_program(out.str(), "written"); });
    fuzz::require(is_read, "what was written is read");
    fuzz::require((again.moves.back().to - program.moves.back().to).cwiseAbs().maxCoeff() <= kRounding,
                  "it ends where it did");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view text = fuzz::text_of(data, size);
    machining::looks_like_nc_program(text);
    machining::NcProgram program;
    if (!fuzz::is_read([&] { program = machining::parse_nc_program(text, "file"); })) return 0;
    for (const machining::CutterMove& move : program.moves)
        fuzz::require(move.from.allFinite() && move.to.allFinite(), "moves have places");
    constexpr std::size_t kSmall = 20000; // moves that are soon written
    if (!program.moves.empty() && program.moves.size() < kSmall) check_round_trip(program);
    fuzz::is_read([&] { machining::parse_nc_block(machining::strip_motion_words(text.substr(0, text.find('\n')))); });
    return 0;
}
