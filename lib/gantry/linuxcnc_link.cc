#include "gantry/linuxcnc_link.h"

#include "core/error.h"
#include "gantry/gantry.h"

#include <emc.hh>
#include <emc_nml.hh>
#include <hal.h>
#include <inifile.hh>
#include <nml_oi.hh>
#include <rcs.hh>
#include <rcs_print.hh>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <pthread.h>
#include <thread>
#include <unistd.h>

namespace fettle::gantry {
namespace {

using Clock = std::chrono::steady_clock;

/// Half a period of the servo thread.
constexpr std::chrono::microseconds kPollPeriod{500};
/// Period of the heartbeat, a sixteenth of the guard's timeout: a single late beat does not trip it.
constexpr std::chrono::milliseconds kBeatPeriod{5};
/// Timeouts for the start of LinuxCNC and commands without motion, and for commands with motion, s.
constexpr double kCommandTimeout = 10, kMotionTimeout = 60;

bool wait_for(double seconds, const std::function<bool()>& condition)
{
    const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    while (!condition()) {
        if (Clock::now() > end) return false;
        std::this_thread::sleep_for(kPollPeriod);
    }
    return true;
}

/// Finds a signal of HAL by its name.
volatile hal_data_u& signal(const char* name, hal_type_t type)
{
    hal_type_t found = HAL_TYPE_UNSPECIFIED;
    hal_data_u* data = nullptr;
    bool written = false;
    if (hal_get_signal_value_by_name(name, &found, &data, &written) != 0 || found != type || data == nullptr)
        throw GantryFault(std::string("LinuxCNC has no signal '") + name +
                          "': see samples/machines/linuxcnc/guard.hal");
    return *data;
}

template <hal_type_t type, auto member, class Value>
struct Signal {
    volatile hal_data_u& data;
    explicit Signal(const char* name) : data(signal(name, type)) {}
    operator Value() const { return data.*member; }
    void set(Value value) { data.*member = value; }
};
using Number = Signal<HAL_FLOAT, &hal_data_u::f, double>;
using Flag = Signal<HAL_BIT, &hal_data_u::b, bool>;
using Count = Signal<HAL_U32, &hal_data_u::u, hal_u32_t>;

/// A component of HAL without pins.
struct Component {
    int id = hal_init(("fettle-" + std::to_string(::getpid())).c_str());
    Component()
    {
        if (id < 0) throw GantryFault("LinuxCNC's HAL cannot be reached");
        hal_ready(id);
    }
    ~Component() { hal_exit(id); }
};

struct Head {
    Number x{"x-at"}, y{"y-at"}, z{"z-at"}, deflection{"deflection"}, force{"force"}, max_force{"client-fmax"};
    Number desired{"client-wanted"}, lowest{"client-lowest"};
    Flag held{"held"}, lost{"lost"}, tripped{"tripped"}, off{"off"};
    Count beat{"client-beat"};
    Flag watch{"client-watch"}, hold{"client-hold"}, touch{"client-touch"}, tip{"client-tip"};
    Flag press{"client-press"};
};

std::string message_in(NML& errors, NMLTYPE type)
{
    const NMLmsg* message = errors.get_address();
    if (type == EMC_OPERATOR_ERROR_TYPE) return static_cast<const EMC_OPERATOR_ERROR*>(message)->error;
    if (type == NML_ERROR_TYPE) return static_cast<const NML_ERROR*>(message)->error;
    return "";
}

} // namespace

struct LinuxcncLink::Wires {
    std::string source;
    mutable IniFile ini;
    std::unique_ptr<RCS_CMD_CHANNEL> commands;
    std::unique_ptr<RCS_STAT_CHANNEL> status;
    std::unique_ptr<NML> errors;
    std::unique_ptr<Component> component;
    std::unique_ptr<Head> head;
    std::atomic<bool> ended{false};
    std::thread heartbeat;
    int last_serial = 0;

    const EMC_STAT& read_status()
    {
        status->peek();
        return *static_cast<EMC_STAT*>(status->get_address());
    }

    void connect(const std::string& nml)
    {
        const char* const kNmlName = "xemc";          // of any client in the NML file
        set_rcs_print_destination(RCS_PRINT_TO_NULL); // its default is stdout
        const bool up = wait_for(kCommandTimeout, [&] {
            const char* file = nml.c_str();
            if (!commands) commands = std::make_unique<RCS_CMD_CHANNEL>(emcFormat, "emcCommand", kNmlName, file);
            if (!commands->valid()) commands.reset();
            if (!status) status = std::make_unique<RCS_STAT_CHANNEL>(emcFormat, "emcStatus", kNmlName, file);
            if (!status->valid() || status->peek() != EMC_STAT_TYPE) status.reset();
            if (!errors) errors = std::make_unique<NML>(nmlErrorFormat, "emcError", kNmlName, file);
            if (!errors->valid()) errors.reset();
            return commands && status && errors;
        });
        if (!up) throw GantryFault("LinuxCNC does not answer by " + nml);
        component = std::make_unique<Component>();
        head = std::make_unique<Head>();
    }

    void send(RCS_CMD_MSG& message, const char* what)
    {
        if (commands->write(&message) != 0) throw GantryFault("LinuxCNC takes no commands");
        last_serial = message.serial_number;
        if (!wait_for(kCommandTimeout, [&] { return read_status().echo_serial_number - last_serial >= 0; }))
            throw GantryFault(std::string("LinuxCNC does not take '") + what + "'");
    }

    void execute(RCS_CMD_MSG& message, const char* what)
    {
        send(message, what);
        if (!wait_for(kCommandTimeout, [&] { return read_status().status != RCS_EXEC; }))
            throw GantryFault(std::string("LinuxCNC does not end '") + what + "'");
        check_errors();
    }

    void check_errors()
    {
        for (NMLTYPE type = errors->read(); type > 0; type = errors->read())
            if (const std::string text = message_in(*errors, type); !text.empty())
                throw GantryFault("LinuxCNC reports: " + text.substr(0, text.find('\n')));
    }

    /// Executes a command whose only parameter is `member`.
    template <class Message, class Value>
    void set(Value Message::*member, Value value, const char* what)
    {
        Message message;
        message.*member = value;
        execute(message, what);
    }

    bool homed()
    {
        const EMC_STAT& now = read_status();
        for (int j = 0; j < now.motion.traj.joints; ++j)
            if (!now.motion.joint[j].homed) return false;
        return true;
    }

    void beat()
    {
        // Realtime priority, if permitted: a late beat stops the machine.
        const sched_param priority{.sched_priority = 1};
        pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
        while (!ended) {
            head->beat.set(head->beat + 1);
            std::this_thread::sleep_for(kBeatPeriod);
        }
    }
};

LinuxcncLink::LinuxcncLink(const std::string& ini) : wires_(std::make_unique<Wires>())
{
    wires_->source = ini;
    if (!wires_->ini.Open(ini.c_str())) throw core::InputError(ini, "cannot be read");
    const char* const nml = wires_->ini.Find("NML_FILE", "EMC");
    if (nml == nullptr) throw core::InputError(ini, "[EMC]NML_FILE is missing");
    wires_->connect(std::filesystem::path(ini).parent_path() / nml); // nml may be absolute
}

LinuxcncLink::~LinuxcncLink()
{
    Head& head = *wires_->head;
    for (Flag* flag : {&head.press, &head.watch, &head.hold}) flag->set(false);
    wires_->ended = true;
    if (wires_->heartbeat.joinable()) wires_->heartbeat.join();
}

double LinuxcncLink::setting(const std::string& section, const std::string& key) const
{
    double value = 0;
    if (wires_->ini.Find(&value, key.c_str(), section.c_str()) != IniFile::ERR_NONE)
        throw core::InputError(wires_->source, "[" + section + "]" + key + " is missing, or no number");
    return value;
}

void LinuxcncLink::enable()
{
    Head& head = *wires_->head;
    // An earlier client may have left them set.
    for (Flag* flag : {&head.press, &head.watch, &head.hold, &head.touch, &head.tip}) flag->set(false);
    wires_->heartbeat = std::thread([this] { wires_->beat(); });
    if (!wait_for(kCommandTimeout, [&] { return !head.lost && !head.off; }))
        throw GantryFault("the guard does not release the machine");
    while (wires_->errors->read() > 0) continue; // errors of earlier clients
    wires_->set(&EMC_TASK_SET_STATE::state, EMC_TASK_STATE_ESTOP_RESET, "machine on");
    wires_->set(&EMC_TASK_SET_STATE::state, EMC_TASK_STATE_ON, "machine on");
    if (!wires_->homed()) {
        wires_->set(&EMC_TASK_SET_MODE::mode, EMC_TASK_MODE_MANUAL, "mode");
        EMC_JOINT_HOME all;
        all.joint = -1;
        wires_->send(all, "home");
        if (!wait_for(kMotionTimeout, [&] { return wires_->homed(); }))
            throw GantryFault("LinuxCNC does not end homing");
    }
    wires_->set(&EMC_TASK_SET_MODE::mode, EMC_TASK_MODE_MDI, "mode");
    head.watch.set(true);
}

/// A line that is queued behind another one waits until all motion has ended; a line that is sent when none is queued
/// does not.
void LinuxcncLink::send_gcode(const std::string& line)
{
    const bool free = wait_for(kMotionTimeout, [&] {
        done(); // for faults
        const EMC_STAT& now = wires_->read_status();
        return now.task.queuedMDIcommands == 0 && now.task.execState == EMC_TASK_EXEC_DONE;
    });
    if (!free) throw GantryFault("LinuxCNC does not come to '" + line + "'");
    EMC_TASK_PLAN_EXECUTE message;
    std::snprintf(message.command, sizeof message.command, "%s", line.c_str());
    wires_->send(message, line.c_str());
}

void LinuxcncLink::abort()
{
    EMC_TASK_ABORT message;
    wires_->execute(message, "abort");
}

bool LinuxcncLink::done()
{
    const EMC_STAT& now = wires_->read_status();
    if (wires_->head->tripped) throw GantryFault("the force has passed the machine's hard limit; it is off");
    if (wires_->head->lost) throw GantryFault("the guard has missed the heartbeat; the machine is off");
    wires_->check_errors();
    if (now.task.state != EMC_TASK_STATE_ON) throw GantryFault("LinuxCNC's machine is off");
    return now.echo_serial_number == wires_->last_serial && now.status == RCS_DONE;
}

double LinuxcncLink::touched() const
{
    const EMC_TRAJ_STAT& now = wires_->read_status().motion.traj;
    return now.probe_tripped ? now.probedPosition.tran.z : std::numeric_limits<double>::quiet_NaN();
}

Eigen::Vector3d LinuxcncLink::drives() const
{
    const Head& head = *wires_->head;
    return {double(head.x), double(head.y), double(head.z)};
}

double LinuxcncLink::deflection() const { return wires_->head->deflection; }
double LinuxcncLink::force() const { return wires_->head->force; }
bool LinuxcncLink::held() const { return wires_->head->held; }
void LinuxcncLink::set_max_force(double force) { wires_->head->max_force.set(force); }
void LinuxcncLink::set_hold(bool armed) { wires_->head->hold.set(armed); }
void LinuxcncLink::set_touch(bool armed) { wires_->head->touch.set(armed); }
void LinuxcncLink::set_tip(bool probe) { wires_->head->tip.set(probe); }

void LinuxcncLink::set_press(bool armed, double deflection, double lowest)
{
    if (armed) {
        wires_->head->desired.set(deflection);
        wires_->head->lowest.set(lowest);
    }
    wires_->head->press.set(armed);
}

} // namespace fettle::gantry
