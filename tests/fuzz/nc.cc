// Machine programs. The moves that were read are written as a program that reads as moves to the same places.

#include "fuzz.h"
#include "machining/nc_block.h"
#include "machining/nc_program.h"
#include "machining/nc_writer.h"

#include <sstream>

using namespace fettle;

namespace {

/// Of a writer that says five decimals of a mm.
constexpr double kRounding = 1e-5;

void check_round_trip(const NcProgram& program)
{
    std::ostringstream out;
    NcWriter writer(out);
    out << "G21 G90 G17\n";
    writer.go(program.moves.front().from, 0);
    const auto begun = out.tellp();
    for (const CutterMove& move : program.moves) writer.go(move);
    if (out.tellp() == begun) return; // all of them shorter than five decimals tell
    NcProgram again;
    const bool is_read = fuzz::is_read([&] { again = parse_nc_program(out.str(), "written"); });
    fuzz::require(is_read, "what was written is read");
    fuzz::require((again.moves.back().to - program.moves.back().to).cwiseAbs().maxCoeff() <= kRounding,
                  "it ends where it did");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    const std::string_view text = fuzz::text_of(data, size);
    looks_like_nc_program(text);
    NcProgram program;
    if (!fuzz::is_read([&] { program = parse_nc_program(text, "file"); })) return 0;
    for (const CutterMove& move : program.moves)
        fuzz::require(move.from.allFinite() && move.to.allFinite(), "moves have places");
    constexpr std::size_t kSmall = 20000; // moves that are soon written
    if (!program.moves.empty() && program.moves.size() < kSmall) check_round_trip(program);
    fuzz::is_read([&] { parse_nc_block(without_moves(text.substr(0, text.find('\n')))); });
    return 0;
}
