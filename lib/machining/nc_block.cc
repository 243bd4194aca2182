#include "machining/nc_block.h"

#include "core/error.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace fettle::machining {
namespace {

/// Modal groups: G words of one group exclude each other. G80 is one of its own, as LinuxCNC has it: a G0 to G3 beside
/// it counts. G4 is not modal.
const std::vector<std::vector<double>> kGroups = {
    {0, 1, 2, 3},   {80},     {17, 18, 19}, {20, 21}, {40}, {43, 49}, {54, 55, 56, 57, 58, 59},
    {61, 61.1, 64}, {90, 91}, {91.1},       {94},     {97}, {98, 99}, {4}};
constexpr std::array kMWords = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 30, 48, 49, 60};
constexpr std::string_view kLetters = "FHIJKNPQRSTXYZ"; // besides G and M
constexpr std::string_view kMotionLetters = "NXYZIJKRF";
constexpr std::array kMotionGWords = {0, 1, 2, 3, 17, 18, 19, 90, 91};
constexpr double kMaxNumber = 1e6; // a kilometre: no coordinate of a machine is as large

/// Modal group of a G word, -1: not accepted.
int modal_group(double g)
{
    for (std::size_t k = 0; k < kGroups.size(); ++k)
        if (std::ranges::find(kGroups[k], g) != kGroups[k].end()) return int(k);
    return -1;
}

/// The line in upper case, without its comments.
std::string strip_comments(std::string_view line)
{
    std::string code;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == ';') break;
        if (line[i] == '(') {
            const std::size_t end = line.find_first_of("()", i + 1);
            if (end == std::string_view::npos) throw core::InputError("a comment without its closing bracket");
            if (line[end] == '(') throw core::InputError("a bracket within a comment");
            i = end;
            code += ' ';
            continue;
        }
        code += static_cast<char>(std::toupper(static_cast<unsigned char>(line[i])));
    }
    return code;
}

/// Splits a line into its words.
class WordReader {
  public:
    explicit WordReader(std::string code) : code_(std::move(code)) {}

    /// The next letter; 0 at the end.
    char letter()
    {
        skip_blanks();
        if (at_ == code_.size()) return 0;
        const char c = code_[at_];
        if (!(c >= 'A' && c <= 'Z')) reject_text("expected a word", at_);
        begin_ = at_++;
        if (c == 'O') throw core::InputError("O-words (subprograms, loops) are not read, got " + text_from(begin_));
        return c;
    }
    double number()
    {
        skip_blanks();
        const std::size_t end = std::min(code_.find_first_not_of("+-.0123456789", at_), code_.size());
        if (end == at_) reject_text("expected a number after " + code_.substr(begin_, 1), at_);
        const auto value = core::parse_number(std::string_view(code_).substr(at_, end - at_));
        at_ = end;
        if (!value || !(std::abs(*value) <= kMaxNumber))
            throw core::InputError("expected a number up to 10^6 after " + code_.substr(begin_, 1) + ", got " +
                                   core::in_quotes(word()));
        return *value;
    }
    /// The current word, as written.
    std::string word() const { return code_.substr(begin_, at_ - begin_); }
    [[noreturn]] void reject() const { throw core::InputError(core::in_quotes(word()) + " is not accepted"); }

  private:
    /// The text from a place to the next blank, in quotes; "nothing" at the end of the line.
    std::string text_from(std::size_t begin) const
    {
        const std::size_t end = std::min(code_.find_first_of(" \t\r", begin), code_.size());
        return end > begin ? core::in_quotes(code_.substr(begin, end - begin)) : "nothing";
    }
    [[noreturn]] void reject_text(const std::string& expected, std::size_t begin) const
    {
        const bool computed = begin < code_.size() && std::string_view("#[").find(code_[begin]) != std::string::npos;
        throw core::InputError(expected + ", got " + text_from(begin) +
                               (computed ? ": parameters (#) and expressions ([ ]) are not read" : ""));
    }
    void skip_blanks() { at_ = std::min(code_.find_first_not_of(" \t", at_), code_.size()); }

    std::string code_;
    std::size_t at_ = 0, begin_ = 0;
};

void add_g(NcBlock& block, double value, const WordReader& words)
{
    const int group = modal_group(value);
    if (group < 0) words.reject();
    for (const double other : block.g)
        if (modal_group(other) == group)
            throw core::InputError("G" + core::to_text(other) + " and " + core::in_quotes(words.word()) +
                                   " exclude each other");
    block.g.push_back(value);
}

void add_m(NcBlock& block, double value, const WordReader& words)
{
    const auto word = std::ranges::find(kMWords, value);
    if (word == kMWords.end()) words.reject();
    block.m.push_back(*word);
}

void check_words(const NcBlock& block)
{
    if (block['N'] && (*block['N'] < 0 || *block['N'] != std::floor(*block['N'])))
        throw core::InputError("N: a line's number must be whole, not " + core::to_text(*block['N']));
    if (block['H'] && !block.has(43)) throw core::InputError("H belongs to G43");
    if (block['P'] && !block.has(64) && !block.has(4)) throw core::InputError("P belongs to G64 or G4");
    if (block['Q'] && !block.has(64)) throw core::InputError("Q belongs to G64");
    if (block.has(4) && !block['P']) throw core::InputError("G4 needs P, the time to wait");
    if (block.has(4) && block.has_any("XYZIJKR"))
        throw core::InputError("G4: a line that waits has no coordinates; controls differ on what they would mean");
    if (block['F'] && !(*block['F'] > 0))
        throw core::InputError("F: a feed must be positive, not " + core::to_text(*block['F']));
}

} // namespace

bool NcBlock::has_any(std::string_view letters) const
{
    return std::ranges::any_of(letters, [this](char letter) { return (*this)[letter].has_value(); });
}

bool NcBlock::has(double g_code) const { return std::ranges::find(g, g_code) != g.end(); }

bool NcBlock::changes_tool() const { return std::ranges::find(m, 6) != m.end(); }

bool NcBlock::ends_program() const
{
    return std::ranges::any_of(m, [](int word) { return word == 2 || word == 30; });
}

bool NcBlock::empty() const { return g.empty() && m.empty() && !has_any(kLetters); }

NcBlock parse_nc_block(std::string_view line)
{
    NcBlock block;
    WordReader words(strip_comments(line));
    while (const char letter = words.letter()) {
        const double value = words.number();
        if (letter == 'G') {
            add_g(block, value, words);
        } else if (letter == 'M') {
            add_m(block, value, words);
        } else {
            if (kLetters.find(letter) == std::string_view::npos) words.reject();
            auto& known = block.values[letter - 'A'];
            if (known) throw core::InputError(std::string(1, letter) + " is given twice");
            known = value;
        }
    }
    check_words(block);
    return block;
}

std::string strip_motion_words(std::string_view line)
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
            if (kMotionLetters.find(letter) != std::string_view::npos) continue;
            const double value = core::parse_number(line.substr(begin, end - begin)).value_or(-1);
            if (letter == 'G' && std::ranges::find(kMotionGWords, value) != kMotionGWords.end()) continue;
        }
        const bool blank = line[i] == ' ' || line[i] == '\t';
        if (!blank || (!rest.empty() && rest.back() != ' ')) rest += line.substr(i, end - i);
    }
    while (!rest.empty() && rest.back() == ' ') rest.pop_back();
    return rest;
}

} // namespace fettle::machining
