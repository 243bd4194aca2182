#include "machining/nc_block.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace fettle {
namespace {

/// G words of one group exclude each other.
const std::vector<std::vector<int>> kGroups = {{0, 1, 2, 3, 80},         {17, 18, 19}, {20, 21}, {40}, {43, 49},
                                               {54, 55, 56, 57, 58, 59}, {64},         {90, 91}, {94}};
constexpr std::string_view kLetters = "FHIJKNPRSTXYZ"; // besides G and M
constexpr std::string_view kOfMoves = "NXYZIJKRF";
constexpr std::array kMotions = {0, 1, 2, 3, 17, 18, 19, 90, 91};
constexpr double kGreatest = 1e6; // no coordinate is a kilometre away, no number as large

int group_of(int g)
{
    for (std::size_t k = 0; k < kGroups.size(); ++k)
        if (std::find(kGroups[k].begin(), kGroups[k].end(), g) != kGroups[k].end()) return static_cast<int>(k);
    return -1;
}

/// What is left of a line without its comments.
std::string without_comments(std::string_view line)
{
    std::string code;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == ';') break;
        if (line[i] == '(') {
            const std::size_t end = line.find_first_of("()", i + 1);
            if (end == std::string_view::npos) throw InputError("a comment without its closing bracket");
            if (line[end] == '(') throw InputError("a bracket within a comment");
            i = end;
            code += ' ';
            continue;
        }
        code += static_cast<char>(std::toupper(static_cast<unsigned char>(line[i])));
    }
    return code;
}

class Words {
  public:
    explicit Words(std::string code) : code_(std::move(code)) {}

    /// The next letter; 0 at the end.
    char letter()
    {
        skip_blanks();
        if (at_ == code_.size()) return 0;
        const char c = code_[at_];
        if (!(c >= 'A' && c <= 'Z')) throw InputError("expected a word, got " + in_quotes(code_.substr(at_)));
        begin_ = at_++;
        return c;
    }
    double number()
    {
        skip_blanks();
        const std::size_t end = std::min(code_.find_first_not_of("+-.0123456789", at_), code_.size());
        const auto value = parse_number(std::string_view(code_).substr(at_, end - at_));
        at_ = end;
        if (!value || !(std::abs(*value) <= kGreatest))
            throw InputError("expected a number up to 10^6 after " + code_.substr(begin_, 1) + ", got " +
                             in_quotes(word()));
        return *value;
    }
    /// As it stands in the line.
    std::string word() const { return code_.substr(begin_, at_ - begin_); }
    [[noreturn]] void refuse() const { throw InputError(in_quotes(word()) + " is not accepted"); }

  private:
    void skip_blanks() { at_ = std::min(code_.find_first_not_of(" \t", at_), code_.size()); }

    std::string code_;
    std::size_t at_ = 0, begin_ = 0;
};

void add_g(NcBlock& block, double value, const Words& words)
{
    const int g = static_cast<int>(value), group = group_of(g);
    if (g != value || group < 0) words.refuse();
    for (const int other : block.g)
        if (group_of(other) == group)
            throw InputError("G" + std::to_string(other) + " and " + in_quotes(words.word()) + " exclude each other");
    block.g.push_back(g);
}

void add_m(NcBlock& block, double value, const Words& words)
{
    const int m = static_cast<int>(value);
    if (m != value || !((m >= 3 && m <= 9) || m == 30)) words.refuse();
    block.m.push_back(m);
}

void require_sense(const NcBlock& block)
{
    if (block['N'] && (*block['N'] < 0 || *block['N'] != std::floor(*block['N'])))
        throw InputError("N: a line's number must be whole, not " + to_text(*block['N']));
    if (block['H'] && !block.has(43)) throw InputError("H belongs to G43");
    if (block['P'] && !block.has(64)) throw InputError("P belongs to G64");
    if (block['F'] && !(*block['F'] > 0)) throw InputError("F: a feed must be positive, not " + to_text(*block['F']));
}

} // namespace

bool NcBlock::has_any(std::string_view letters) const
{
    return std::any_of(letters.begin(), letters.end(), [this](char letter) { return (*this)[letter].has_value(); });
}

bool NcBlock::has(int g_code) const { return std::find(g.begin(), g.end(), g_code) != g.end(); }

bool NcBlock::empty() const { return g.empty() && m.empty() && !has_any(kLetters); }

NcBlock parse_nc_block(std::string_view line)
{
    NcBlock block;
    Words words(without_comments(line));
    while (const char letter = words.letter()) {
        const double value = words.number();
        if (letter == 'G') {
            add_g(block, value, words);
        } else if (letter == 'M') {
            add_m(block, value, words);
        } else {
            if (kLetters.find(letter) == std::string_view::npos) words.refuse();
            auto& known = block.values[static_cast<std::size_t>(letter - 'A')];
            if (known) throw InputError(std::string(1, letter) + " is given twice");
            known = value;
        }
    }
    require_sense(block);
    return block;
}

std::string without_moves(std::string_view line)
{
    constexpr std::string_view kNumbers = "+-.0123456789";
    std::string rest;
    for (std::size_t i = 0, end = 0; i < line.size(); i = end) {
        end = i + 1;
        if (line[i] == ';') end = line.size();
        if (line[i] == '(') end = line.find(')', i) + 1;
        const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(line[i])));
        if (letter >= 'A' && letter <= 'Z') {
            const std::size_t begin = std::min(line.find_first_not_of(" \t", i + 1), line.size());
            end = std::min(line.find_first_not_of(kNumbers, begin), line.size());
            if (kOfMoves.find(letter) != std::string_view::npos) continue;
            const double value = parse_number(line.substr(begin, end - begin)).value_or(-1);
            if (letter == 'G' && std::find(kMotions.begin(), kMotions.end(), value) != kMotions.end()) continue;
        }
        const bool blank = line[i] == ' ' || line[i] == '\t';
        if (!blank || (!rest.empty() && rest.back() != ' ')) rest += line.substr(i, end - i);
    }
    while (!rest.empty() && rest.back() == ' ') rest.pop_back();
    return rest;
}

} // namespace fettle
