#include "plan/gcode.h"

#include "core/fixed_text.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

namespace fettle::plan {

namespace {

// Five decimals are finer than any drive.
std::string fixed(double value) { return core::to_fixed_text(value, 5); }

std::string words(const Eigen::Vector3d& point, double mm)
{
    return "X" + fixed(point.x() / mm) + " Y" + fixed(point.y() / mm) + " Z" + fixed(point.z() / mm);
}

// Largest distance of the points between `from` and `to` from the straight move.
double deviation(const std::vector<Eigen::Vector3d>& points, int from, int to)
{
    const Eigen::Vector3d direction = (points[to] - points[from]).normalized();
    double max = 0;
    for (int i = from + 1; i < to; ++i) {
        const Eigen::Vector3d d = points[i] - points[from];
        max = std::max(max, (d - d.dot(direction) * direction).norm());
    }
    return max;
}

// Greedy polyline simplification: indices of the ends of the straight moves from the first to the last point.
std::vector<int> move_ends(const std::vector<Eigen::Vector3d>& points, double chord_error)
{
    const int last = int(points.size()) - 1;
    std::vector<int> ends;
    for (int from = 0; from < last;) {
        int to = from + 1;
        while (to < last && deviation(points, from, to + 1) <= chord_error) ++to;
        ends.push_back(to);
        from = to;
    }
    return ends;
}

// Units, modes and feed have lines of their own: an F in one line with G20 or G21 would still be in the old unit.
void write_header(std::ostream& out, const Plan& plan, GcodeDialect dialect, double chord_error)
{
    const job::Job& job = plan.job;
    const double mm = job.units.mm();
    const std::string theta = fixed(job.theta * 180 / std::numbers::pi);
    out << "(fettle-plan: layer 1, tool points: the wheel's lowest line at mid-width)\n"
        << "(wheel radius " << fixed(job.wheel.radius / mm) << ", width " << fixed(job.wheel.width / mm)
        << ", chord error " << fixed(chord_error / mm) << ")\n"
        << "(machine frame: no offset in G54)\n"
        << (job.units.length == units::Units::Length::in ? "G20\n" : "G21\n") << "G17 G40 G49 G54 G80 G90 G94\n";
    if (dialect == GcodeDialect::linuxcnc) out << "G64 P" << fixed(chord_error / mm) << "\n";
    out << "F" << fixed(job.feed.rate * 60 / mm) << "\n"
        << "G0 Z" << fixed(job.safe_height / mm) << "\n";
    if (dialect == GcodeDialect::linuxcnc)
        out << "G0 C" << theta << "\n";
    else if (job.theta != 0)
        out << "(turn the wheel's axis to " << theta << " degrees from X, then resume)\nM0\n";
}

} // namespace

void write_gcode(std::ostream& out, const Plan& plan, const ToolPath& path, GcodeDialect dialect, double chord_error)
{
    const double mm = plan.job.units.mm();
    const std::string safe = fixed(plan.job.safe_height / mm);
    write_header(out, plan, dialect, chord_error);
    bool forwards = true;
    for (const ToolPass& pass : path.passes()) {
        const int intervals = int(pass.starts.size());
        for (int k = 0; k < intervals; ++k) {
            const int i = forwards ? k : intervals - 1 - k;
            const int first = pass.starts[i];
            const int last = (i + 1 < intervals ? pass.starts[i + 1] : int(pass.points.size())) - 1;
            std::vector<Eigen::Vector3d> points(pass.points.begin() + first, pass.points.begin() + last + 1);
            if (!forwards) std::ranges::reverse(points);
            out << "G0 X" << fixed(points[0].x() / mm) << " Y" << fixed(points[0].y() / mm) << "\n"
                << "G1 Z" << fixed(points[0].z() / mm) << "\n";
            for (const int end : move_ends(points, chord_error)) out << "G1 " << words(points[end], mm) << "\n";
            out << "G0 Z" << safe << "\n";
        }
        forwards = !forwards;
    }
    out << "M30\n";
}

} // namespace fettle::plan
