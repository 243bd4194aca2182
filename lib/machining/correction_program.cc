#include "core/lines.h"
#include "machining/correction.h"
#include "machining/nc_block.h"
#include "machining/nc_writer.h"

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace fettle::machining {
namespace {

/// Copies a program line by line, with each line's moves replaced by the corrected ones.
class ProgramRewriter {
  public:
    ProgramRewriter(std::ostream& out, const ToolPath& path, const std::vector<CutterMove>& moves)
        : out_(out), writer_(out), path_(path), moves_(moves)
    {
    }

    void rewrite(std::string_view line, std::size_t number)
    {
        const bool mark = line.find('%') == line.find_first_not_of(" \t\r");
        const NcBlock block = mark ? NcBlock{} : parse_nc_block(line);
        if (block.has(20) || block.has(21)) writer_.set_inches(block.has(20));
        const bool ends = block.ends_program();
        if (ends) write_moves(number);
        copy(strip_motion_words(line), line.empty());
        if (!ends) write_moves(number);
    }

  private:
    void copy(const std::string& rest, bool empty)
    {
        const bool blank = rest.find_first_not_of(" \t\r") == std::string::npos;
        if (blank && !empty) return;
        out_ << rest << '\n';
        writer_.reset_motion_mode();
    }

    void write_moves(std::size_t number)
    {
        const auto& unplaced = path_.program.unplaced_rapids;
        const bool any = (next_ < moves_.size() && moves_[next_].source_line == number) ||
                         (unplaced_ < unplaced.size() && unplaced[unplaced_].source_line == number);
        if (any && !begun_) out_ << "G90 G17\n";
        begun_ = begun_ || any;
        for (; unplaced_ < unplaced.size() && unplaced[unplaced_].source_line == number; ++unplaced_)
            writer_.move_to(unplaced[unplaced_].to, 0);
        for (; next_ < moves_.size() && moves_[next_].source_line == number; ++next_) writer_.move_to(moves_[next_]);
    }

    std::ostream& out_;
    NcWriter writer_;
    const ToolPath& path_;
    const std::vector<CutterMove>& moves_;
    std::size_t next_ = 0, unplaced_ = 0;
    bool begun_ = false;
};

} // namespace

void write_corrected(std::ostream& out, const ToolPath& path, const CorrectedPath& corrected)
{
    ProgramRewriter rewriter(out, path, corrected.moves);
    core::Lines lines(core::strip_byte_order_mark(path.text, ""));
    while (lines.next()) rewriter.rewrite(lines.line(), lines.number());
}

json::Value to_json(const CorrectedPath& corrected)
{
    return json::Value()
        .set("moves", corrected.moves.size())
        .set("shifted", corrected.shifted)
        .set("held", corrected.blocked)
        .set("in_air", corrected.in_air)
        .set("unknown", corrected.unknown)
        .set("greatest_shift", corrected.max_shift);
}

} // namespace fettle::machining
