#pragma once

#include "core/descriptor.h"

#include <Eigen/Core>

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <string>

namespace fettle::strategy {

/// What the operator pushes (Wang 2007, 6.1.1). Teaching takes `record` and `next`, a session (station/session.h) all
/// of them, manual mode by itself none.
enum class Button {
    none,
    record,     ///< touch the part here, and keep the point
    next,       ///< this step is complete
    back,       ///< take back the last point, or go back a step
    start,      ///< begin, or go on
    stop,       ///< stop the machine
    automatic,  ///< the mode
    manual,     ///< the mode
    turn_left,  ///< turn the head by a degree, counter-clockwise
    turn_right, ///< clockwise
};
/// The words for the buttons in a file of steering, but for Button::none; in their order.
inline constexpr std::array<const char*, 9> kButtonWords = {"record",    "next",   "back",      "start",     "stop",
                                                            "automatic", "manual", "turn_left", "turn_right"};

/// State of the operator's joystick.
struct Stick {
    Eigen::Vector2d direction{0, 0}; ///< direction of travel, M; its length is ignored, but 0 means centred
    bool on_part = true;             ///< the wheel is pressed on the part; false: at the safe height
    Button button = Button::none;    ///< pushed at this moment; each push is reported once
    bool end = false;
};

class Keys;

/// The operator's joystick, from one of three sources, or from a terminal and a joystick at once. A file or a pipe
/// holds lines "TIME X Y", "TIME X Y up", "TIME BUTTON" (kButtonWords) and "TIME end": from that steering time on, s,
/// the stick has this state; it is centred while a button is pushed. A device (Linux, /dev/input/js0) is polled
/// (joystick.h). On a terminal the keys move the stick (Keys).
class Steering {
  public:
    /// @param joystick  a device that steers beside the terminal `path`; empty: none
    /// @throws InputError if one cannot be opened, or if `joystick` is no joystick
    explicit Steering(const std::string& path, const std::string& joystick = "");
    ~Steering();

    /// State of the stick at a steering time, which must not decrease. The end of a file is Stick::end.
    /// @throws InputError naming the malformed line
    const Stick& at(double time);
    /// Steering time of the next line, so that the caller can skip to it; nothing for a device or keys.
    std::optional<double> next_change() const { return live_ ? std::nullopt : std::optional(next_time_); }
    /// Looks ahead while the machine moves: has the operator pushed `stop` by this steering time, or ended the steering
    /// by device or keys?
    bool stop_due(double time);
    /// Forgets what was pushed on a device or keys and has not been reported yet, but for the end.
    void discard();

  private:
    bool next_line(std::string& line);
    void read_next();
    bool line_is_stop(double time);
    bool has_line() const;
    void update_live(double time);
    void read_device();

    std::string path_;
    core::FileDescriptor file_, joystick_;
    std::unique_ptr<Keys> keys_;
    bool live_ = false; ///< a device or keys
    std::string pending_;
    int lines_ = 0;
    Stick now_, next_;
    bool is_applied_ = false;   ///< now_ is next_, and the line after it has not been read
    Stick device_;              ///< state of the joystick
    std::deque<Button> pushed_; ///< on the joystick, not reported yet
    double next_time_ = 0;
};

} // namespace fettle::strategy
