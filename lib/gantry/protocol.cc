#include "gantry/protocol.h"

#include "core/text.h"

#include <cmath>
#include <initializer_list>

namespace fettle::gantry::protocol {
namespace {

std::string join(std::initializer_list<double> numbers)
{
    std::string text;
    for (const double number : numbers) text += (text.empty() ? "" : " ") + core::to_text(number);
    return text;
}

/// Rounding of the text of a unit quaternion, with six digits.
constexpr double kQuaternionTolerance = 1e-5;
/// A malformed line is quoted up to this length.
constexpr std::size_t kMaxQuotedLength = 60;

[[noreturn]] void refuse(std::string_view text)
{
    std::string shown;
    for (const char c : text.substr(0, kMaxQuotedLength)) shown += c >= ' ' && c < 127 ? c : '?';
    throw GantryFault("makes no sense: '" + shown + "'");
}

std::vector<double> parse_numbers(std::string_view text, std::size_t count)
{
    std::vector<double> numbers;
    for (std::string_view rest = text; !rest.empty();) {
        const auto number = core::parse_number(next_word(rest));
        if (!number) refuse(text);
        if (!std::isfinite(*number))
            throw GantryFault("says " + core::to_text(*number) + ": '" + std::string(text) + "'");
        numbers.push_back(*number);
    }
    if (numbers.size() != count) refuse(text);
    return numbers;
}

} // namespace

std::string_view next_word(std::string_view& line)
{
    const std::size_t end = std::min(line.find(' '), line.size());
    const std::string_view word = line.substr(0, end);
    line.remove_prefix(std::min(end + 1, line.size()));
    return word;
}

std::string to_words(const Eigen::Vector3d& p) { return join({p.x(), p.y(), p.z()}); }

std::string to_words(const Eigen::Isometry3d& pose)
{
    const Eigen::Vector3d p = pose.translation();
    const Eigen::Quaterniond q(pose.linear());
    return join({p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()});
}

std::string to_line(const Limits& l)
{
    return join({l.min.x(), l.max.x(), l.min.y(), l.max.y(), l.min.z(), l.max.z(), l.speed, l.force});
}

std::string to_line(const GantryStatus& s)
{
    return join({s.time, s.commanded.x(), s.commanded.y(), s.commanded.z(), s.deflection, s.force, s.peak_force});
}

Limits parse_limits(std::string_view text)
{
    const std::vector<double> n = parse_numbers(text, 8);
    return {{n[0], n[2], n[4]}, {n[1], n[3], n[5]}, n[6], n[7]};
}

GantryStatus parse_status(std::string_view text)
{
    const std::vector<double> n = parse_numbers(text, 7);
    return {n[0], {n[1], n[2], n[3]}, n[4], n[5], n[6]};
}

Eigen::Isometry3d parse_pose(std::string_view text)
{
    const std::vector<double> n = parse_numbers(text, 7);
    const Eigen::Quaterniond q(n[3], n[4], n[5], n[6]);
    if (!(std::abs(q.norm() - 1) <= kQuaternionTolerance))
        throw GantryFault("turns by a quaternion of length " + core::to_text(q.norm()) + ": '" + std::string(text) +
                          "'");
    Eigen::Isometry3d pose(q.normalized());
    pose.pretranslate(Eigen::Vector3d(n[0], n[1], n[2]));
    return pose;
}

double parse_finite_number(std::string_view text) { return parse_numbers(text, 1).front(); }

} // namespace fettle::gantry::protocol
