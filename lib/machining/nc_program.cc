#include "machining/nc_program.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"
#include "machining/nc_arc.h"
#include "machining/nc_block.h"
#include "units/units.h"

#include <array>
#include <cctype>
#include <cmath>

namespace fettle::machining {
namespace {

constexpr double kSecondsPerMinute = 60;
constexpr std::string_view kAxes = "XYZ";

/// The words that choose offsets from the control's tables.
struct Offsets {
    std::string system = "G54"; ///< of the coordinates; G54 holds at the start of a program
    std::string length = "G49"; ///< of the tool; none at the start
};

/// The modal state of a program, and the moves read so far.
class Interpreter {
  public:
    explicit Interpreter(const std::optional<Eigen::Vector3d>& start) : start_(start)
    {
        if (start) at_ = *start;
    }

    void run(const NcBlock& block, std::size_t line)
    {
        if (ended_) throw core::InputError("after the end of the program (M2 or M30)");
        line_ = line;
        set_modes(block);
        set_offsets(block);
        if (block.has_any("XYZ") || block.has_any("IJKR")) move(block);
        ended_ = block.ends_program();
    }

    NcProgram program;

  private:
    void count(const std::string& word) { ++program.non_motion_words[word]; }

    void set_modes(const NcBlock& block)
    {
        if (block.has(80)) motion_ = 80;
        for (const double g : block.g) {
            if (g <= 3)
                motion_ = static_cast<int>(g);
            else if (g >= 17 && g <= 19)
                plane_ = static_cast<int>(g);
            else if (g == 20 || g == 21)
                set_unit(block, units::mm_per(g == 20 ? units::Units::Length::in : units::Units::Length::mm));
            else if (g == 90 || g == 91)
                incremental_ = g == 91;
            else
                count("G" + core::to_text(g));
        }
        if (block.has(94)) feed_ = 0; // LinuxCNC wants F anew, others keep the old one
        for (const int m : block.m) count("M" + std::to_string(m));
        for (const char letter : {'S', 'T'})
            if (block[letter]) count(std::string(1, letter));
        if (block['F']) feed_ = *block['F'] * unit_ / kSecondsPerMinute;
    }

    /// LinuxCNC and NIST's interpreter set the feed before the unit, others after it.
    void set_unit(const NcBlock& block, double unit)
    {
        if (block['F'] && unit != unit_)
            throw core::InputError("F on a line that changes the unit (G20, G21): controls differ on whether it is in "
                                   "the old or the new one; give F a line of its own");
        unit_ = unit;
        is_unit_given_ = true;
    }

    void set_offsets(const NcBlock& block)
    {
        if (block['T']) next_tool_ = "tool " + core::to_text(*block['T']);
        if (block.changes_tool()) {
            tool_ = next_tool_;
            if (has_fed_ && program.tool_change == 0) program.tool_change = line_;
        }
        for (const double g : block.g) {
            if (g >= 54 && g <= 59) offsets_.system = "G" + core::to_text(g);
            if (g == 49) offsets_.length = "G49";
            if (g == 43) offsets_.length = block['H'] ? "G43 H" + core::to_text(*block['H']) : "G43 for " + tool_;
        }
    }

    /// Requires that all moves have the same offsets. A length offset does not matter while Z is not known.
    void check_offsets(const NcBlock& block)
    {
        const auto require_same = [](std::string& known, const std::string& now, const std::string& what) {
            if (known.empty()) known = now;
            if (known != now)
                throw core::InputError("a move with " + what + " " + now + " after moves with " + known +
                                       ": the distance between them is in the control's tables, not in the program");
        };
        require_same(known_offsets_.system, offsets_.system, "the coordinate system");
        if (block['Z'] || std::isfinite(at_.z()))
            require_same(known_offsets_.length, offsets_.length, "the tool length offset");
    }

    void move(const NcBlock& block)
    {
        if (motion_ < 0 || motion_ > 3)
            throw core::InputError("coordinates without a motion mode: none of G0, G1, G2, G3 is active");
        if (motion_ <= 1 && block.has_any("IJKR")) throw core::InputError("I, J, K and R belong to G2 and G3");
        check_offsets(block);
        if (!is_unit_given_ && program.assumed_unit == 0) program.assumed_unit = line_;
        if (start_) add({{.from = at_, .to = at_}}, 0);
        start_.reset();
        const Eigen::Vector3d to = target(block);
        if (motion_ == 0 && !(at_.allFinite() && to.allFinite())) {
            if (to.allFinite()) add({{.from = to, .to = to}}, 0); // the first known position must be free of material
            if (!to.allFinite()) program.unplaced_rapids.push_back({to, line_});
            at_ = to;
            return;
        }
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(at_[axis]))
                throw core::InputError(std::string("a feed move, but ") + kAxes[axis] +
                                       " is not known yet; --start X,Y,Z says where the tip is at first");
        if (motion_ != 0 && feed_ == 0) throw core::InputError("a feed move, but no F yet (or since G94)");
        has_fed_ = has_fed_ || motion_ != 0;
        if (motion_ >= 2) {
            if (block['P']) throw core::InputError("P beside G2 or G3: the number of turns, or of another word?");
            const auto moves = arc_moves(arc_to(to, block));
            if (moves.front().sweep_angle == 0) ++program.chorded_arcs;
            add(moves, feed_);
        } else if (to != at_) {
            add({{.from = at_, .to = to}}, motion_ == 0 ? 0 : feed_);
        }
        at_ = to;
    }

    Eigen::Vector3d target(const NcBlock& block) const
    {
        Eigen::Vector3d to = at_;
        for (int axis = 0; axis < 3; ++axis) {
            const char letter = kAxes[axis];
            if (!block[letter]) continue;
            if (incremental_ && !std::isfinite(at_[axis]))
                throw core::InputError(std::string(1, letter) +
                                       " is relative (G91) to a position that is not known yet");
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
        const auto offset = [&](int k) { return kOffsets[arc.axes[k]]; };
        const std::string plane = "G" + std::to_string(plane_);
        if (block[offset(2)])
            throw core::InputError(std::string(1, offset(2)) + " is not a centre coordinate in the plane of " + plane);
        const bool has_centre = block[offset(0)] || block[offset(1)];
        if (has_centre == block['R'].has_value())
            throw core::InputError(std::string("an arc needs either R or ") + offset(0) + " and " + offset(1) + " in " +
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
            move.source_line = line_;
            program.moves.push_back(move);
        }
    }

    std::optional<Eigen::Vector3d> start_;                       ///< reset by the first move
    Eigen::Vector3d at_ = Eigen::Vector3d::Constant(core::kNaN); ///< mm; NaN: not known
    double feed_ = 0, unit_ = 1;                                 ///< mm/s; mm
    int motion_ = -1, plane_ = 17;
    bool is_unit_given_ = false, incremental_ = false, has_fed_ = false, ended_ = false;
    Offsets offsets_;
    Offsets known_offsets_{"", ""}; ///< of the moves so far; empty: none yet
    std::string tool_ = "the tool in the spindle", next_tool_ = tool_;
    std::size_t line_ = 0;
};

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\r") == std::string_view::npos; }

/// Whether "1 = 3" or "<name> = 3" follows a #; in files of points a comment does.
bool sets_parameter(std::string_view text)
{
    const std::size_t name = text.find_first_not_of(" \t");
    if (name == std::string_view::npos) return false;
    const std::size_t last = text[name] == '<' ? text.find('>', name) : text.find_last_of("0123456789", text.find('='));
    if (last == std::string_view::npos || last < name) return false;
    const bool number = text.substr(name, last + 1 - name).find_first_not_of("0123456789") == std::string_view::npos;
    const std::size_t sign = text.find_first_not_of(" \t", last + 1);
    return (text[name] == '<' || number) && sign != std::string_view::npos && text[sign] == '=';
}

} // namespace

std::string unit_warning(const NcProgram& program)
{
    if (program.assumed_unit == 0) return {};
    return "line " + std::to_string(program.assumed_unit) + " moves before any G20 or G21: its lengths are taken as mm";
}

NcProgram parse_nc_program(std::string_view text, const std::string& source,
                           const std::optional<Eigen::Vector3d>& start)
{
    Interpreter interpreter(start);
    core::Lines lines(core::strip_byte_order_mark(text, source));
    bool begun = false, closed = false; // by %
    while (lines.next()) try {
            std::string_view line = lines.line();
            if (is_blank(line)) continue;
            if (closed) throw core::InputError("after the closing %");
            line.remove_prefix(line.find_first_not_of(" \t"));
            if (line.front() == '%') {
                if (!is_blank(line.substr(1)))
                    throw core::InputError("% must stand alone, got " + core::in_quotes(line));
                closed = begun;
                begun = true;
                continue;
            }
            begun = true;
            if (const NcBlock block = parse_nc_block(line); !block.empty()) interpreter.run(block, lines.number());
        } catch (const core::InputError& error) {
            throw core::InputError(source, lines.location() + ": " + error.what());
        }
    if (interpreter.program.moves.size() < 2) throw core::InputError(source, "the program has no moves");
    return std::move(interpreter.program);
}

bool looks_like_nc_program(std::string_view text)
{
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return false;
    text = text.substr(first, text.find_first_of("\r\n", first) - first);
    if (text.front() == '/') text.remove_prefix(1); // a line that a switch of the control skips
    if (text.starts_with('%') || text.starts_with('(') || text.starts_with(';')) return true;
    if (text.starts_with('#')) return sets_parameter(text.substr(1));
    if (text.empty() || !std::isalpha(static_cast<unsigned char>(text.front()))) return false;
    const std::size_t value = text.find_first_not_of(" \t", 1);
    return value != std::string_view::npos &&
           std::string_view("+-.0123456789[#<").find(text[value]) != std::string::npos;
}

} // namespace fettle::machining
