#pragma once

#include "core/descriptor.h"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <string>

namespace fettle::strategy {

/// Buttons for teaching; manual mode ignores them.
enum class Button { none, record, next };

/// State of the operator's joystick.
struct Stick {
    Eigen::Vector2d direction{0, 0}; ///< direction of travel, M; its length is ignored, but 0 means centred
    bool on_part = true;             ///< the wheel is pressed on the part; false: at the safe height
    Button button = Button::none;    ///< pushed at this moment; each push is reported once
    bool end = false;
};

class Keys;

/// The operator's joystick, from one of three sources. A file or a pipe holds lines "TIME X Y", "TIME X Y up", "TIME
/// record", "TIME next" and "TIME end": from that steering time on, s, the stick has this state; it is centred while a
/// button is pushed. A device (Linux, /dev/input/js0) is polled: axes 0 and 1, button 0 held: at the safe height,
/// button 1: end, 2: record, 3: next. On a terminal the keys move the stick (Keys).
class Steering {
  public:
    /// @throws InputError if it cannot be opened
    explicit Steering(const std::string& path);
    ~Steering();

    /// State of the stick at a steering time, which must not decrease. The end of a file is Stick::end.
    /// @throws InputError naming the malformed line
    const Stick& at(double time);
    /// Steering time of the next line, so that the caller can skip to it; nothing for a device or keys.
    std::optional<double> next_change() const { return live_ ? std::nullopt : std::optional(next_time_); }

  private:
    bool next_line(std::string& line);
    void read_next();
    void read_device();

    std::string path_;
    core::FileDescriptor file_;
    std::unique_ptr<Keys> keys_;
    bool live_ = false; ///< a device or keys
    std::string pending_;
    int lines_ = 0;
    Stick now_, next_;
    double next_time_ = 0;
};

} // namespace fettle::strategy
