#include "strategy/run_identity.h"

#include "core/digest.h"
#include "core/lines.h"
#include "core/text.h"

#include <algorithm>
#include <initializer_list>

namespace fettle::strategy {
namespace {

/// Digits of a part's digest: enough that no two files agree by chance, and few enough for a line.
constexpr std::size_t kPartDigits = 16;

std::string digest(std::string_view bytes) { return core::sha256(bytes).substr(0, kPartDigits); }

/// Digest of numbers, which are written with all their digits.
std::string digest(std::initializer_list<double> numbers)
{
    std::string text;
    for (const double number : numbers) text += core::to_text(number) + ' ';
    return digest(text);
}

std::string digest(const Eigen::Matrix3Xd& points)
{
    std::string text;
    for (const double number : points.reshaped()) text += core::to_text(number) + ' ';
    return digest(text);
}

std::string text_of(const std::optional<Eigen::Isometry3d>& placement)
{
    std::string text;
    if (placement)
        for (const double number : placement->matrix().reshaped()) text += core::to_text(number) + ' ';
    return text;
}

std::string digest(const std::vector<plan::Pass>& passes)
{
    std::string text;
    for (const plan::Pass& pass : passes) {
        text += '\n' + core::to_text(pass.line);
        for (const auto& [from, to] : pass.intervals) text += ' ' + core::to_text(from) + ' ' + core::to_text(to);
    }
    return digest(text);
}

std::string digest(const removal::HeightField& field)
{
    core::Digest sum;
    for (const double number :
         {field.theta, field.origin.x(), field.origin.y(), field.cell, double(field.columns()), double(field.rows())})
        sum.add(core::to_text(number) + ' ');
    const auto* heights = reinterpret_cast<const char*>(field.z.data());
    return sum.text({heights, std::size_t(field.z.size()) * sizeof(double)}).substr(0, kPartDigits);
}

} // namespace

RunIdentity identity_of(const plan::Plan& plan, const removal::HeightField& stock, Layer1 layer_1,
                        const std::optional<KnownRemoval>& known_removal,
                        const std::optional<Eigen::Isometry3d>& T_cell_job)
{
    const job::Job& job = plan.job;
    const job::GrindingWheel& wheel = job.wheel;
    const job::ForceRange& force = job.force;
    RunIdentity identity = {
        {{"job.units", digest(units::to_string(job.units.length) + ' ' + units::to_string(job.units.force))},
         {"job.frame", digest(core::to_text(job.theta) + ' ' + text_of(job.T_part_job))},
         {"job.anomaly", digest(job.anomaly)},
         {"job.tolerance", digest({job.tolerance})},
         {"job.safe_height", digest({job.safe_height})},
         {"job.wheel", digest({wheel.radius, wheel.width, wheel.min_radius})},
         {"job.force", digest({force.min, force.down, force.max, force.stiffness, force.preload})},
         {"job.feed", digest({double(job.feed.axis), job.feed.rate, job.feed.step_over})},
         {"job.removal", digest({job.removal_coefficient})},
         {"surface", digest(surface::to_json(plan.surface).text())},
         {"start", digest({plan.start.x(), plan.start.y(), plan.start.z()})},
         {"step", digest({plan.step})},
         {"passes", digest(plan.passes)},
         {"--stock", digest(stock)},
         {"--layer-1", digest({double(layer_1)})}},
        job.frame()};
    if (T_cell_job) identity.parts.push_back({"--place", digest(text_of(T_cell_job))});
    if (const auto& k = known_removal)
        identity.parts.push_back(
            {"--learn", digest({k->coefficient_sigma, k->removed_volume, k->lost_volume, k->wear_sigma})});
    return identity;
}

std::string to_text(const RunIdentity& identity)
{
    std::string text;
    for (const auto& [name, digest] : identity.parts) text += (text.empty() ? "" : " ") + name + ':' + digest;
    return text;
}

RunIdentity parse_identity(std::string_view text)
{
    RunIdentity identity;
    for (std::string_view word = core::next_word(text); !word.empty(); word = core::next_word(text)) {
        const std::size_t colon = std::min(word.rfind(':'), word.size());
        identity.parts.push_back(
            {std::string(word.substr(0, colon)), std::string(word.substr(std::min(colon + 1, word.size())))});
    }
    return identity;
}

std::vector<std::string> differing_parts(const RunIdentity& a, const RunIdentity& b)
{
    std::vector<std::string> names;
    const auto add_missing = [&names](const RunIdentity& from, const RunIdentity& in) {
        for (const RunIdentity::Part& part : from.parts)
            if (std::ranges::find(in.parts, part) == in.parts.end() &&
                std::ranges::find(names, part.name) == names.end())
                names.push_back(part.name);
    };
    add_missing(a, b);
    add_missing(b, a);
    return names;
}

} // namespace fettle::strategy
