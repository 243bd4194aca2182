#include "gantry/simulated_head.h"

#include "core/error.h"
#include "gantry/virtual_gantry.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <utility>
#include <vector>

namespace fettle {
namespace {

const std::string kMagic = "fettle-head 1\n";

/// As on the quasi-static gantry the wheel meets the stock anew after two cells, so that the ridges between are low.
constexpr double kStep = 2; // cells
/// The force while it goes down is known to k times this.
constexpr double kDrop = 0.01; // mm
/// Pressed on one place, or on the way to the next, the force is no older than that.
constexpr double kLatest = 0.01; // s

std::vector<double> numbers_of(const HeadAndStock& h)
{
    return {static_cast<double>(h.stock.columns()),
            static_cast<double>(h.stock.rows()),
            h.stock.theta,
            h.stock.origin.x(),
            h.stock.origin.y(),
            h.stock.cell,
            h.spring.preload,
            h.spring.stiffness,
            h.removal,
            h.radius,
            h.width,
            h.tip_radius,
            h.grind_ratio};
}

char* bytes(double* numbers) { return reinterpret_cast<char*>(numbers); }
std::streamsize size_of(Eigen::Index numbers) { return numbers * static_cast<std::streamsize>(sizeof(double)); }

} // namespace

HeadAndStock head_and_stock(HeightField stock, const Job& job)
{
    return {
        std::move(stock),     {job.force.preload, job.force.stiffness}, job.removal, job.wheel.radius, job.wheel.width,
        job.probe.tip_radius, VirtualOptions().grinding_ratio};
}

void write_head(std::ostream& out, const HeadAndStock& head)
{
    std::vector<double> numbers = numbers_of(head);
    out << kMagic;
    out.write(bytes(numbers.data()), size_of(static_cast<Eigen::Index>(numbers.size())));
    out.write(reinterpret_cast<const char*>(head.stock.z.data()), size_of(head.stock.z.size()));
}

// By itself, not by core/file.h: the realtime module reads it, too, and is linked to as little as possible.
HeadAndStock read_head(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in) throw InputError(path, std::string("cannot open: ") + std::strerror(errno));
    std::ostringstream whole;
    whole << in.rdbuf();
    const std::string all = whole.str();
    HeadAndStock head;
    std::vector<double> numbers = numbers_of(head);
    const std::size_t begin = kMagic.size() + numbers.size() * sizeof(double);
    if (!all.starts_with(kMagic)) throw InputError(path, "is no stock of a simulated head");
    if (all.size() < begin) throw InputError(path, "is cut short");
    std::memcpy(numbers.data(), all.data() + kMagic.size(), begin - kMagic.size());
    const double* n = numbers.data();
    // What is there bounds what is allocated, whatever is claimed.
    const double cells = n[0] * n[1], there = static_cast<double>((all.size() - begin) / sizeof(double));
    const bool is_whole = n[0] >= 1 && n[1] >= 1 && n[0] == std::floor(n[0]) && n[1] == std::floor(n[1]);
    if (!is_whole || !std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }) ||
        !(n[5] > 0))
        throw InputError(path, "is no stock of a simulated head");
    if (cells > there) throw InputError(path, "is cut short");
    if (cells < there || (all.size() - begin) % sizeof(double) != 0)
        throw InputError(path, "goes on after its last cell");
    head.stock.z.resize(static_cast<Eigen::Index>(n[0]), static_cast<Eigen::Index>(n[1]));
    head.stock.theta = n[2];
    head.stock.origin = {n[3], n[4]};
    head.stock.cell = n[5];
    head.spring = {n[6], n[7]};
    head.removal = n[8];
    head.radius = n[9];
    head.width = n[10];
    head.tip_radius = n[11];
    head.grind_ratio = n[12];
    std::memcpy(head.stock.z.data(), all.data() + begin, all.size() - begin);
    return head;
}

SimulatedHead::SimulatedHead(HeadAndStock head)
    : head_(std::move(head)), wheel_(head_.stock, head_.width), radius_(head_.radius),
      met_at_(Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()))
{
    const double cosine = std::cos(head_.stock.theta), sine = std::sin(head_.stock.theta);
    R_working_machine_ << cosine, sine, -sine, cosine;
}

// dV_wheel = 2πR w dR, as VirtualGantry::wear() has it.
void SimulatedHead::step(const Eigen::Vector3d& drives, double period, Tool tool, const Plate& plate)
{
    const Eigen::Vector2d xy = R_working_machine_ * drives.head<2>();
    pending_ += period;
    const double z_stop = tool == Tool::probe ? drives.z() : drives.z() + head_.radius - radius_;
    if ((drives - plate.centre).head<2>().norm() < plate.radius) return rest_on(plate.centre.z(), z_stop);
    if (tool == Tool::probe) return rest_on(height_under_ball(head_.stock, xy, head_.tip_radius), z_stop);
    if (!due(xy, drives.z())) return;
    wheel_.place(xy, radius_, z_stop);
    const double c_dt = head_.removal * std::exchange(pending_, 0);
    const Balance balance = press(wheel_, head_.spring, z_stop, c_dt, z_stop + deflection_);
    if (balance.volume > 0) wheel_.cut(balance.z_tip);
    deflection_ = balance.z_tip - z_stop;
    force_ = balance.force;
    met_at_ = xy;
    met_z_ = drives.z();
    radius_ -= balance.volume / head_.grind_ratio / (2 * std::numbers::pi * radius_ * head_.width);
}

/// A wheel that moves along its axis meets the stock column by column with its face: see QuasiStaticGantry::sub_steps.
bool SimulatedHead::due(const Eigen::Vector2d& xy, double z) const
{
    const double step = kStep * head_.stock.cell;
    const Eigen::Vector2d way = xy - met_at_;
    if (!way.allFinite() || std::abs(z - met_z_) >= kDrop) return true;
    if (std::abs(way.x()) <= std::abs(way.y())) return way.norm() >= step || pending_ >= kLatest;
    const double face = std::copysign(head_.width / 2, way.x()) - head_.stock.origin.x();
    const auto columns = [&](double x) { return std::floor((x + face) / step); };
    return columns(xy.x()) != columns(met_at_.x());
}

void SimulatedHead::rest_on(double surface, double z_stop)
{
    pending_ = 0;
    deflection_ = surface > z_stop ? surface - z_stop : 0; // NaN: nothing there
    force_ = deflection_ > 0 ? head_.spring.force(deflection_) : 0;
}

} // namespace fettle
