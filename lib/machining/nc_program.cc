#include "machining/nc_program.h"

#include "core/error.h"
#include "core/lines.h"
#include "machining/nc_arc.h"
#include "machining/nc_block.h"
#include "units/units.h"

#include <array>
#include <cctype>
#include <cmath>
#include <limits>

namespace fettle {
namespace {

constexpr double kSecondsPerMinute = 60;
constexpr std::string_view kAxes = "XYZ";

/// What holds from line to line.
class Interpreter {
  public:
    void run(const NcBlock& block, std::size_t line)
    {
        if (ended_) throw InputError("after the end of the program (M30)");
        line_ = line;
        set_modes(block);
        if (block.has_any("XYZ") || block.has_any("IJKR")) move(block);
        for (const int m : block.m) ended_ = ended_ || m == 30;
    }

    NcProgram program;

  private:
    static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

    void count(const std::string& word) { ++program.without_motion[word]; }

    void set_modes(const NcBlock& block)
    {
        for (const int g : block.g) {
            if (g <= 3)
                motion_ = g;
            else if (g >= 17 && g <= 19)
                plane_ = g;
            else if (g == 20 || g == 21)
                unit_ = mm_per(g == 20 ? Units::Length::in : Units::Length::mm);
            else if (g == 90 || g == 91)
                incremental_ = g == 91;
            else
                count("G" + std::to_string(g));
            if (g == 80) motion_ = g;
        }
        for (const int m : block.m) count("M" + std::to_string(m));
        for (const char letter : {'S', 'T'})
            if (block[letter]) count(std::string(1, letter));
        if (block['F']) feed_ = *block['F'] * unit_ / kSecondsPerMinute;
    }

    void move(const NcBlock& block)
    {
        if (motion_ < 0 || motion_ > 3) throw InputError("a place without a motion: none of G0, G1, G2, G3 holds");
        if (motion_ <= 1 && block.has_any("IJKR")) throw InputError("I, J, K and R belong to G2 and G3");
        const Eigen::Vector3d to = target(block);
        if (motion_ == 0 && !(at_.allFinite() && to.allFinite())) {
            if (to.allFinite()) add({placed(to)}, 0); // stands there: it must be free of material
            if (!to.allFinite()) program.unplaced.push_back({to, line_});
            at_ = to;
            return;
        }
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(at_[axis]))
                throw InputError(std::string("a feed move, but ") + kAxes[static_cast<std::size_t>(axis)] +
                                 " is not known yet");
        if (motion_ != 0 && feed_ == 0) throw InputError("a feed move, but no F yet");
        if (motion_ >= 2) {
            const auto moves = moves_along(arc_to(to, block));
            if (moves.front().sweep == 0) ++program.chorded;
            add(moves, feed_);
        } else if (to != at_) {
            CutterMove straight = placed(at_);
            straight.to = to;
            add({straight}, motion_ == 0 ? 0 : feed_);
        }
        at_ = to;
    }

    static CutterMove placed(const Eigen::Vector3d& at)
    {
        CutterMove move;
        move.from = move.to = at;
        return move;
    }

    Eigen::Vector3d target(const NcBlock& block) const
    {
        Eigen::Vector3d to = at_;
        for (int axis = 0; axis < 3; ++axis) {
            const char letter = kAxes[static_cast<std::size_t>(axis)];
            if (!block[letter]) continue;
            if (incremental_ && !std::isfinite(at_[axis]))
                throw InputError(std::string(1, letter) + " is relative (G91) to a place that is not known yet");
            to[axis] = *block[letter] * unit_ + (incremental_ ? at_[axis] : 0);
        }
        return to;
    }

    NcArc arc_to(const Eigen::Vector3d& to, const NcBlock& block) const
    {
        NcArc arc;
        arc.from = at_;
        arc.to = to;
        arc.counter_clockwise = motion_ == 3;
        arc.axes = plane_ == 17 ? std::array{0, 1, 2} : (plane_ == 18 ? std::array{2, 0, 1} : std::array{1, 2, 0});
        constexpr std::string_view kOffsets = "IJK";
        const auto offset = [&](int k) {
            return kOffsets[static_cast<std::size_t>(arc.axes[static_cast<std::size_t>(k)])];
        };
        const std::string plane = "G" + std::to_string(plane_);
        if (block[offset(2)]) throw InputError(std::string(1, offset(2)) + " is no centre in the plane of " + plane);
        const bool centred = block[offset(0)] || block[offset(1)];
        if (centred == block['R'].has_value())
            throw InputError(std::string("an arc needs either R or ") + offset(0) + " and " + offset(1) + " in " +
                             plane);
        if (block['R'])
            arc.radius = *block['R'] * unit_;
        else
            arc.centre_offset = unit_ * Eigen::Vector2d(block[offset(0)].value_or(0), block[offset(1)].value_or(0));
        return arc;
    }

    void add(const std::vector<CutterMove>& moves, double feed)
    {
        for (CutterMove move : moves) {
            move.feed = feed;
            move.place = line_;
            program.moves.push_back(move);
        }
    }

    Eigen::Vector3d at_ = Eigen::Vector3d::Constant(kUnknown); ///< mm
    double feed_ = 0, unit_ = 1;                               ///< mm/s; mm
    int motion_ = -1, plane_ = 17;
    bool incremental_ = false, ended_ = false;
    std::size_t line_ = 0;
};

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r") == std::string_view::npos; }

} // namespace

NcProgram parse_nc_program(std::string_view text, const std::string& source)
{
    Interpreter interpreter;
    Lines lines(without_mark(text, source));
    bool begun = false, closed = false; // by %
    while (lines.next()) try {
            std::string_view line = lines.line();
            if (is_blank(line)) continue;
            if (closed) throw InputError("after the closing %");
            line.remove_prefix(line.find_first_not_of(" \t"));
            if (line.front() == '%') {
                if (!is_blank(line.substr(1))) throw InputError("% stands alone, got " + in_quotes(line));
                closed = begun;
                begun = true;
                continue;
            }
            begun = true;
            if (const NcBlock block = parse_nc_block(line); !block.empty()) interpreter.run(block, lines.number());
        } catch (const InputError& error) {
            throw InputError(source, lines.place() + ": " + error.what());
        }
    if (interpreter.program.moves.size() < 2) throw InputError(source, "a program without a move");
    return std::move(interpreter.program);
}

bool looks_like_nc_program(std::string_view text)
{
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return false;
    text.remove_prefix(first);
    if (text.front() == '%' || text.front() == '(' || text.front() == ';') return true;
    if (!std::isalpha(static_cast<unsigned char>(text.front()))) return false;
    text.remove_prefix(1);
    const std::size_t number = text.find_first_not_of(" \t");
    return number != std::string_view::npos &&
           std::string_view("+-.0123456789").find(text[number]) != std::string_view::npos;
}

} // namespace fettle
