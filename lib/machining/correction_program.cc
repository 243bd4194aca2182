#include "core/lines.h"
#include "machining/correction.h"
#include "machining/nc_block.h"
#include "machining/nc_writer.h"

#include <algorithm>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace fettle {
namespace {

/// Writes a program's lines anew, one after the other, with the moves that they have now.
class Rewriting {
  public:
    Rewriting(std::ostream& out, const ToolPath& path, const std::vector<CutterMove>& moves)
        : out_(out), writer_(out), path_(path), moves_(moves)
    {
    }

    void line(std::string_view line, std::size_t number)
    {
        const bool mark = line.find('%') == line.find_first_not_of(" \t\r");
        const NcBlock block = mark ? NcBlock{} : parse_nc_block(line);
        if (block.has(20) || block.has(21)) writer_.set_inches(block.has(20));
        const bool ends = std::find(block.m.begin(), block.m.end(), 30) != block.m.end();
        if (ends) move(number);
        say(without_moves(line), line.empty());
        if (!ends) move(number);
    }

  private:
    void say(const std::string& rest, bool empty)
    {
        const bool blank = rest.find_first_not_of(" \t\r") == std::string::npos;
        if (blank && !empty) return;
        out_ << rest << '\n';
        writer_.forget_motion();
    }

    void move(std::size_t number)
    {
        const auto& unplaced = path_.program.unplaced;
        const bool any = (next_ < moves_.size() && moves_[next_].place == number) ||
                         (unplaced_ < unplaced.size() && unplaced[unplaced_].place == number);
        if (any && !begun_) out_ << "G90 G17\n";
        begun_ = begun_ || any;
        for (; unplaced_ < unplaced.size() && unplaced[unplaced_].place == number; ++unplaced_)
            writer_.go(unplaced[unplaced_].to, 0);
        for (; next_ < moves_.size() && moves_[next_].place == number; ++next_) writer_.go(moves_[next_]);
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
    Rewriting rewriting(out, path, corrected.moves);
    Lines lines(without_mark(path.text, ""));
    while (lines.next()) rewriting.line(lines.line(), lines.number());
}

} // namespace fettle
