#include "gantry/machine.h"

#include "core/text.h"
#include "units/units.h"
#include "json/document.h"

#include <numbers>

namespace fettle {
namespace {

using json::Reader;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kMillimetres = 1000; // N m in N mm, W in N mm/s, kg m² in N mm s²
/// Slower loops could not hold the spring's force between two looks at it.
constexpr double kLeastRate = 1000, kMostRate = 1e5; // Hz

/// What is written behind a key, and the unit of its number: lengths, or angles for the axis C.
struct AxisUnit {
    const char* suffix;
    double unit;
};

/// What the amplifier must give for the speed and the acceleration that the file promises.
void check_reach(const Reader& reader, const Drive& drive, const AxisUnit& in)
{
    const double start = (drive.mass * drive.acceleration + drive.load) / drive.gain;
    const double run = start + drive.damping * drive.speed / drive.gain;
    if (start > drive.current)
        reader.refuse(std::string("acceleration") + in.suffix, to_short_text(drive.acceleration / in.unit) + " takes " +
                                                                   to_short_text(start / drive.current) +
                                                                   " times motor.current");
    if (run > drive.voltage)
        reader.refuse(std::string("speed") + in.suffix,
                      to_short_text(drive.speed / in.unit) + " takes " + to_short_text(run) + " V of motor.voltage");
}

Drive drive_in(Reader reader, const AxisUnit& in)
{
    const auto key = [&](const char* name) { return name + std::string(in.suffix); };
    const auto positive = [](Reader& from, const std::string& name, double unit) {
        return from.number(name, Range::positive()) * unit;
    };
    Reader motor = reader.object("motor"), screw = reader.object("screw");
    const double torque_constant = positive(motor, "torque_constant", kMillimetres); // K_m, N mm/A
    const double resistance = positive(motor, "resistance", 1);                      // R_m, Ω
    const double gear = motor.number_or("gear", 1, Range::positive());               // N
    const double pitch = positive(screw, key("pitch"), in.unit);
    const double per_torque = screw.number("efficiency", Range{0, 1, false, true}) * kTurn / pitch; // η K_b = 1/K
    const double k_b = kTurn / pitch;
    const double to_nut = per_torque * k_b;

    Drive drive;
    drive.mass = to_nut * positive(reader, "inertia", kMillimetres);
    const double friction = reader.number_or("friction", 0, Range::at_least(0)) * kMillimetres;
    // Against one volt stand K_m N θ̇: volts are N m/(A s), so one K_m counts in N m.
    drive.emf = torque_constant / kMillimetres * gear * k_b;
    drive.gain = per_torque * gear * torque_constant / resistance;
    drive.damping = to_nut * friction + drive.gain * drive.emf;
    drive.load = per_torque * screw.number_or("torque", 0, Range::at_least(0)) * kMillimetres;
    drive.voltage = positive(motor, "voltage", 1);
    drive.current = positive(motor, "current", 1) * resistance;
    drive.encoder = pitch / positive(reader, "encoder", 1);
    drive.speed = positive(reader, key("speed"), in.unit);
    drive.acceleration = positive(reader, key("acceleration"), in.unit);
    drive.least = reader.number(key("min")) * in.unit;
    drive.most = reader.number(key("max"), Range{drive.least / in.unit, Range{}.most, false, true}) * in.unit;
    drive.following_error = positive(reader, key("following_error"), in.unit);
    check_reach(reader, drive, in);
    motor.done();
    screw.done();
    reader.done();
    return drive;
}

Head head_in(Reader reader, const Units& units)
{
    const double mm = units.mm();
    Head head;
    head.damping = reader.number_or("damping", 0, Range::at_least(0)) * to_base(units, {-1, 1});
    head.travel = reader.number("travel", Range::positive()) * mm;
    head.stiffness = reader.number("stiffness", Range::positive()) * to_base(units, {-1, 1});
    Reader lvdt = reader.object("lvdt");
    head.lvdt = lvdt.number("resolution", Range::positive()) * mm;
    head.noise = lvdt.number_or("noise", 0, Range::at_least(0)) * mm;
    lvdt.done();
    reader.done();
    return head;
}

Spindle spindle_in(Reader reader)
{
    Spindle spindle;
    spindle.speed = reader.number("rpm", Range::positive()) * kTurn / 60;
    spindle.power = reader.number("power", Range::positive()) * kMillimetres;
    spindle.inertia = reader.number("inertia", Range::positive()) * kMillimetres;
    spindle.tangential = reader.number("tangential", Range::between(0, 1));
    spindle.side = reader.number("side", Range::between(0, 1));
    reader.done();
    return spindle;
}

} // namespace

Machine read_machine(const std::string& path)
{
    Reader reader = Reader::open(path);
    Machine machine;
    machine.source = reader.source();
    reader.expect_kind("machine");
    Reader of_units = reader.object("units");
    const Units units{parse_length_unit(of_units.choice("length", {"mm", "in"})),
                      parse_force_unit(of_units.choice("force", {"N", "lbf"}))};
    of_units.done();
    machine.period = 1 / reader.number("servo_rate", Range::between(kLeastRate, kMostRate));
    Reader axes = reader.object("axes");
    for (int k = 0; k < 3; ++k)
        machine.axes[static_cast<std::size_t>(k)] = drive_in(axes.object(std::string(1, "xyz"[k])), {"", units.mm()});
    machine.c = drive_in(axes.object("c"), {"_deg", kTurn / 360});
    axes.done();
    machine.head = head_in(reader.object("head"), units);
    machine.spindle = spindle_in(reader.object("spindle"));
    reader.done();
    return machine;
}

} // namespace fettle
