#pragma once

#include "core/descriptor.h"

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <string>

namespace fettle {

/// Buttons for teaching; manual mode knows none.
enum class Button { none, record, next };

/// What the operator's hand says.
struct Stick {
    Eigen::Vector2d way{0, 0};    ///< where to, M; only its direction counts. 0: nowhere
    bool press = true;            ///< on the part; else at the safe height
    Button button = Button::none; ///< pushed at this moment; told once
    bool end = false;
};

class Keys;

/// The operator's joystick. A file or a pipe holds lines "TIME X Y", "TIME X Y up", "TIME record", "TIME next" and
/// "TIME end": from that time of steering on, s, the stick stands there; it rests while a button is pushed. A device
/// (Linux, /dev/input/js0) is asked as it stands: axes 0 and 1, button 0 held: at the safe height, button 1: end, 2:
/// record, 3: next. Of a terminal the keys are the stick (Keys).
class Steering {
  public:
    /// @throws InputError if it cannot be opened
    explicit Steering(const std::string& path);
    ~Steering();

    /// @throws InputError naming the line that is none; the end of the file is the end
    const Stick& at(double time);
    /// Of lines: when the next one is due; then nobody has to wait for it.
    std::optional<double> next_change() const { return live_ ? std::nullopt : std::optional(next_time_); }

  private:
    bool next_line(std::string& line);
    void read_next();
    void read_device();

    std::string path_;
    Descriptor file_;
    std::unique_ptr<Keys> keys_;
    bool live_ = false; ///< a device or keys
    std::string pending_;
    int lines_ = 0;
    Stick now_, next_;
    double next_time_ = 0;
};

} // namespace fettle
