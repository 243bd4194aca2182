#include "gantry/machine.h"

#include "core/text.h"
#include "units/units.h"
#include "json/document.h"

#include <numbers>

namespace fettle::gantry {
namespace {

using json::Reader;

constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr double kMillimetresPerMetre = 1000; // also N m in N mm, W in N mm/s, kg m² in N mm s²
/// A slower loop could not control the spring's force.
constexpr double kMinServoRate = 1000, kMaxServoRate = 1e5; // Hz

/// Suffix of a key, and the unit of its number: lengths, or angles for the axis C.
struct AxisUnit {
    const char* suffix;
    double unit;
};

/// Checks that the amplifier is strong enough for the speed and the acceleration in the file.
void check_reach(const Reader& reader, const Drive& drive, const AxisUnit& in)
{
    const double start = (drive.mass * drive.acceleration + drive.load) / drive.gain;
    const double run = start + drive.damping * drive.speed / drive.gain;
    if (start > drive.current)
        reader.refuse(std::string("acceleration") + in.suffix,
                      core::to_short_text(drive.acceleration / in.unit) + " takes " +
                          core::to_short_text(start / drive.current) + " times motor.current");
    if (run > drive.voltage)
        reader.refuse(std::string("speed") + in.suffix, core::to_short_text(drive.speed / in.unit) + " takes " +
                                                            core::to_short_text(run) + " V of motor.voltage");
}

Drive drive_in(Reader reader, const AxisUnit& in)
{
    const auto key = [&](const char* name) { return name + std::string(in.suffix); };
    const auto positive = [](Reader& from, const std::string& name, double unit) {
        return from.number(name, core::Range::positive()) * unit;
    };
    Reader motor = reader.object("motor"), screw = reader.object("screw");
    const double torque_constant = positive(motor, "torque_constant", kMillimetresPerMetre); // K_m, N mm/A
    const double resistance = positive(motor, "resistance", 1);                              // R_m, Ω
    const double gear = motor.number_or("gear", 1, core::Range::positive());                 // N
    const double pitch = positive(screw, key("pitch"), in.unit);
    const double per_torque =
        screw.number("efficiency", core::Range{0, 1, false, true}) * kFullTurn / pitch; // η K_b = 1/K
    const double k_b = kFullTurn / pitch;
    const double to_nut = per_torque * k_b;

    Drive drive;
    drive.mass = to_nut * positive(reader, "inertia", kMillimetresPerMetre);
    const double friction = reader.number_or("friction", 0, core::Range::at_least(0)) * kMillimetresPerMetre;
    // The back EMF in volts is K_m N θ̇ with K_m in N m/A, since 1 V is 1 N m/(A s).
    drive.emf = torque_constant / kMillimetresPerMetre * gear * k_b;
    drive.gain = per_torque * gear * torque_constant / resistance;
    drive.damping = to_nut * friction + drive.gain * drive.emf;
    drive.load = per_torque * screw.number_or("torque", 0, core::Range::at_least(0)) * kMillimetresPerMetre;
    drive.voltage = positive(motor, "voltage", 1);
    drive.current = positive(motor, "current", 1) * resistance;
    drive.encoder = pitch / positive(reader, "encoder", 1);
    drive.speed = positive(reader, key("speed"), in.unit);
    drive.acceleration = positive(reader, key("acceleration"), in.unit);
    drive.min_position = reader.number(key("min")) * in.unit;
    drive.max_position =
        reader.number(key("max"), core::Range{drive.min_position / in.unit, core::Range{}.max, false, true}) * in.unit;
    drive.following_error = positive(reader, key("following_error"), in.unit);
    check_reach(reader, drive, in);
    motor.reject_unknown_keys();
    screw.reject_unknown_keys();
    reader.reject_unknown_keys();
    return drive;
}

Head head_in(Reader reader, const units::Units& units)
{
    const double mm = units.mm();
    Head head;
    head.damping = reader.number_or("damping", 0, core::Range::at_least(0)) * units::base_unit_factor(units, {-1, 1});
    head.travel = reader.number("travel", core::Range::positive()) * mm;
    head.stiffness = reader.number("stiffness", core::Range::positive()) * units::base_unit_factor(units, {-1, 1});
    Reader lvdt = reader.object("lvdt");
    head.lvdt = lvdt.number("resolution", core::Range::positive()) * mm;
    head.noise = lvdt.number_or("noise", 0, core::Range::at_least(0)) * mm;
    lvdt.reject_unknown_keys();
    reader.reject_unknown_keys();
    return head;
}

Spindle spindle_in(Reader reader)
{
    Spindle spindle;
    spindle.speed = reader.number("rpm", core::Range::positive()) * kFullTurn / 60;
    spindle.power = reader.number("power", core::Range::positive()) * kMillimetresPerMetre;
    spindle.inertia = reader.number("inertia", core::Range::positive()) * kMillimetresPerMetre;
    spindle.tangential = reader.number("tangential", core::Range::between(0, 1));
    spindle.side = reader.number("side", core::Range::between(0, 1));
    reader.reject_unknown_keys();
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
    const units::Units units{units::parse_length_unit(of_units.choice("length", {"mm", "in"})),
                             units::parse_force_unit(of_units.choice("force", {"N", "lbf"}))};
    of_units.reject_unknown_keys();
    machine.period = 1 / reader.number("servo_rate", core::Range::between(kMinServoRate, kMaxServoRate));
    Reader axes = reader.object("axes");
    for (int k = 0; k < 3; ++k) machine.axes[k] = drive_in(axes.object(std::string(1, "xyz"[k])), {"", units.mm()});
    machine.c = drive_in(axes.object("c"), {"_deg", kFullTurn / 360});
    axes.reject_unknown_keys();
    machine.head = head_in(reader.object("head"), units);
    machine.spindle = spindle_in(reader.object("spindle"));
    reader.reject_unknown_keys();
    return machine;
}

} // namespace fettle::gantry
