#include "gantry/simulated_head.h"

#include "core/error.h"
#include "gantry/virtual_gantry.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <utility>
#include <vector>

namespace fettle::gantry {
namespace {

const std::string kMagic = "fettle-head 1\n";

/// Distance of two contact updates, as on the quasi-static gantry: the ridges between them are low.
constexpr double kSubstepCells = 2;
/// Largest motion of Z without a contact update: the error of the force is k times this.
constexpr double kMaxDescent = 0.01; // mm
/// Longest time between two contact updates.
constexpr double kMaxContactInterval = 0.01; // s

/// The numbers of a file's header after the number of columns and of rows.
template <class Head>
auto parameters_of(Head& h)
{
    return std::array{&h.stock.theta,    &h.stock.origin.x(), &h.stock.origin.y(), &h.stock.cell,
                      &h.spring.preload, &h.spring.stiffness, &h.removal,          &h.radius,
                      &h.width,          &h.tip_radius,       &h.grinding_ratio};
}

void write_numbers(std::ostream& out, const double* numbers, std::size_t count)
{
    out.write(reinterpret_cast<const char*>(numbers), std::streamsize(count * sizeof(double)));
}

} // namespace

HeadAndStock head_and_stock(removal::HeightField stock, const job::Job& job)
{
    return {std::move(stock),
            {job.force.preload, job.force.stiffness},
            job.removal_coefficient,
            job.wheel.radius,
            job.wheel.width,
            job.probe.tip_radius,
            job.wheel.grinding_ratio.value_or(kUsualGrindingRatio)};
}

void write_head(std::ostream& out, const HeadAndStock& head)
{
    std::vector<double> header = {double(head.stock.columns()), double(head.stock.rows())};
    for (const double* parameter : parameters_of(head)) header.push_back(*parameter);
    out << kMagic;
    write_numbers(out, header.data(), header.size());
    write_numbers(out, head.stock.z.data(), head.stock.z.size());
}

// This does not use core/file.h: the realtime module reads the file, too, and is linked with as little as possible.
HeadAndStock read_head(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in) throw core::InputError(path, std::string("cannot open: ") + std::strerror(errno));
    std::ostringstream content;
    content << in.rdbuf();
    const std::string all = content.str();
    HeadAndStock head;
    const auto parameters = parameters_of(head);
    std::vector<double> n(2 + parameters.size());
    const std::size_t begin = kMagic.size() + n.size() * sizeof(double);
    if (!all.starts_with(kMagic)) throw core::InputError(path, "is no stock of a simulated head");
    if (all.size() < begin) throw core::InputError(path, "is cut short");
    std::memcpy(n.data(), all.data() + kMagic.size(), begin - kMagic.size());
    // The file's size bounds the allocation, whatever its header says.
    const double cells = n[0] * n[1], available = double((all.size() - begin) / sizeof(double));
    const bool is_grid = n[0] >= 1 && n[1] >= 1 && n[0] == std::floor(n[0]) && n[1] == std::floor(n[1]);
    if (!is_grid || !std::ranges::all_of(n, [](double x) { return std::isfinite(x); }) || !(n[5] > 0))
        throw core::InputError(path, "is no stock of a simulated head");
    if (cells > available) throw core::InputError(path, "is cut short");
    if (cells < available || (all.size() - begin) % sizeof(double) != 0)
        throw core::InputError(path, "goes on after its last cell");
    head.stock.z.resize(Eigen::Index(n[0]), Eigen::Index(n[1]));
    for (std::size_t k = 0; k < parameters.size(); ++k) *parameters[k] = n[k + 2];
    std::memcpy(head.stock.z.data(), all.data() + begin, all.size() - begin);
    return head;
}

SimulatedHead::SimulatedHead(HeadAndStock head)
    : head_(std::move(head)), wheel_(head_.stock, head_.width), radius_(head_.radius),
      contact_xy_(Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()))
{
    const double cosine = std::cos(head_.stock.theta), sine = std::sin(head_.stock.theta);
    R_working_machine_ << cosine, sine, -sine, cosine;
}

// Wear of the wheel: dV_wheel = 2πR w dR, as in VirtualGantry::wear().
void SimulatedHead::step(const Eigen::Vector3d& drives, double period, Tool tool, const Plate& plate)
{
    const Eigen::Vector2d xy = R_working_machine_ * drives.head<2>();
    pending_time_ += period;
    const double z_stop = tool == Tool::probe ? drives.z() : drives.z() + head_.radius - radius_;
    if ((drives - plate.centre).head<2>().norm() < plate.radius) return rest_on(plate.centre.z(), z_stop);
    if (tool == Tool::probe) return rest_on(removal::height_under_ball(head_.stock, xy, head_.tip_radius), z_stop);
    if (!contact_update_due(xy, drives.z())) return;
    wheel_.place(xy, radius_, z_stop);
    const double c_dt = head_.removal * std::exchange(pending_time_, 0);
    const removal::Balance balance = removal::press(wheel_, head_.spring, z_stop, c_dt, z_stop + deflection_);
    if (balance.volume > 0) wheel_.cut(balance.z_tip);
    deflection_ = balance.z_tip - z_stop;
    force_ = balance.force;
    contact_xy_ = xy;
    contact_z_ = drives.z();
    radius_ -= balance.volume / head_.grinding_ratio / (2 * std::numbers::pi * radius_ * head_.width);
}

/// The side face of a wheel that moves along its axis meets the stock column by column: see
/// QuasiStaticGantry::sub_steps.
bool SimulatedHead::contact_update_due(const Eigen::Vector2d& xy, double z) const
{
    const double step = kSubstepCells * head_.stock.cell;
    const Eigen::Vector2d motion = xy - contact_xy_;
    if (!motion.allFinite() || std::abs(z - contact_z_) >= kMaxDescent) return true;
    if (std::abs(motion.x()) <= std::abs(motion.y()))
        return motion.norm() >= step || pending_time_ >= kMaxContactInterval;
    const double face = std::copysign(head_.width / 2, motion.x()) - head_.stock.origin.x();
    const auto columns = [&](double x) { return std::floor((x + face) / step); };
    return columns(xy.x()) != columns(contact_xy_.x());
}

void SimulatedHead::rest_on(double surface, double z_stop)
{
    pending_time_ = 0;
    deflection_ = surface > z_stop ? surface - z_stop : 0; // false for NaN, no surface
    force_ = deflection_ > 0 ? head_.spring.force(deflection_) : 0;
}

} // namespace fettle::gantry
