#include "strategy/steering.h"

#include "core/error.h"
#include "core/file.h"
#include "core/lines.h"
#include "core/text.h"
#include "strategy/joystick.h"
#include "strategy/keys.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <limits>
#include <poll.h>
#include <sys/stat.h>
#include <utility>

namespace fettle::strategy {
namespace {

constexpr std::size_t kMaxLineLength = 4096;

bool is_joystick(const core::FileDescriptor& file)
{
    struct stat status = {};
    char axes = 0;
    return ::fstat(file.get(), &status) == 0 && S_ISCHR(status.st_mode) && ::ioctl(file.get(), JSIOCGAXES, &axes) == 0;
}

/// The button that a line of steering names; none for other words.
Button parse_button(std::string_view word)
{
    const auto at = std::ranges::find(kButtonWords, word);
    return at == kButtonWords.end() ? Button::none : Button(at - kButtonWords.begin() + 1);
}

} // namespace

Steering::Steering(const std::string& path, const std::string& joystick)
    : path_(core::display_name(path)),
      file_(path == "-" ? ::dup(STDIN_FILENO) : ::open(path.c_str(), O_RDONLY | O_CLOEXEC))
{
    if (!file_.is_open()) throw core::InputError(path_, std::string("cannot open: ") + std::strerror(errno));
    if (is_joystick(file_))
        joystick_ = std::move(file_);
    else if (::isatty(file_.get()) != 0)
        keys_ = std::make_unique<Keys>(file_.get());
    else
        read_next();
    if (!joystick.empty()) {
        if (!keys_) throw core::InputError("--joystick", "goes with the keys of a terminal, not with " + path_);
        joystick_ = core::FileDescriptor(::open(joystick.c_str(), O_RDONLY | O_CLOEXEC));
        if (!joystick_.is_open()) throw core::InputError(joystick, std::string("cannot open: ") + std::strerror(errno));
        if (!is_joystick(joystick_)) throw core::InputError(joystick, "is no joystick");
    }
    if (joystick_.is_open()) ::fcntl(joystick_.get(), F_SETFL, O_NONBLOCK);
    live_ = joystick_.is_open() || keys_;
}

Steering::~Steering() = default;

const Stick& Steering::at(double time)
{
    now_.button = Button::none;
    if (live_)
        update_live(time);
    else if (is_applied_ && !now_.end)
        read_next(); // only now: the writer of a pipe may wait for the effect of a push
    while (!live_ && !is_applied_ && time >= next_time_) {
        now_ = next_;
        is_applied_ = true;
        if (!now_.end && now_.button == Button::none) read_next();
    }
    return now_;
}

/// The joystick, where it is deflected or pushed, and the keys else.
void Steering::update_live(double time)
{
    if (keys_) keys_->update(time, now_);
    if (!joystick_.is_open()) return;
    read_device();
    now_.end = now_.end || device_.end;
    if (!keys_ || device_.direction.norm() > 0) now_.direction = device_.direction;
    if (!keys_) now_.on_part = device_.on_part;
    const auto stop = std::ranges::find(pushed_, Button::stop);
    if (stop != pushed_.end()) pushed_.erase(pushed_.begin(), stop);
    if (now_.button != Button::none || pushed_.empty()) return;
    now_.button = pushed_.front();
    pushed_.pop_front();
}

bool Steering::stop_due(double time)
{
    if (!live_) return line_is_stop(time);
    if (joystick_.is_open()) read_device();
    return device_.end || std::ranges::find(pushed_, Button::stop) != pushed_.end() || (keys_ && keys_->has_stop());
}

/// A line that moves the stick is passed over, and no line is waited for.
bool Steering::line_is_stop(double time)
{
    if (is_applied_ && !now_.end && has_line()) read_next();
    while (!is_applied_ && time >= next_time_ && next_.button == Button::none && !next_.end) {
        now_ = next_;
        is_applied_ = true;
        if (has_line()) read_next();
    }
    return !is_applied_ && next_.button == Button::stop && time >= next_time_;
}

bool Steering::has_line() const
{
    pollfd readable{file_.get(), POLLIN, 0};
    return pending_.find('\n') != std::string::npos || ::poll(&readable, 1, 0) > 0;
}

void Steering::discard()
{
    if (joystick_.is_open()) read_device();
    pushed_.clear();
    if (keys_) keys_->discard();
}

bool Steering::next_line(std::string& line)
{
    char buffer[4096];
    for (;;) {
        if (const std::size_t end = pending_.find('\n'); end != std::string::npos) {
            line = pending_.substr(0, end);
            pending_.erase(0, end + 1);
            ++lines_;
            return true;
        }
        if (pending_.size() > kMaxLineLength)
            throw core::InputError(path_, "line " + std::to_string(lines_ + 1) + ": longer than " +
                                              std::to_string(kMaxLineLength) + " bytes");
        const ssize_t n = core::read_some(file_, buffer, sizeof buffer);
        if (n < 0) throw core::InputError(path_, std::string("cannot read: ") + std::strerror(errno));
        if (n == 0 && pending_.empty()) return false;
        if (n == 0) buffer[0] = '\n'; // the last line may lack it
        pending_.append(buffer, std::max<ssize_t>(n, 1));
    }
}

void Steering::read_next()
{
    std::string line;
    is_applied_ = false;
    if (!next_line(line)) {
        next_ = {};
        next_.end = true;
        return;
    }
    const std::vector<std::string_view> parts = core::words(line);
    const auto number = [&](std::size_t n) -> double {
        const auto value = n < parts.size() ? core::parse_number(parts[n]) : std::nullopt;
        if (!value || !(*value > -std::numeric_limits<double>::infinity() && *value < 1e9))
            throw core::InputError(
                path_, "line " + std::to_string(lines_) + ": " + core::in_quotes(line) +
                           " is none of \"TIME X Y\", \"TIME X Y up\", \"TIME end\", \"TIME BUTTON\" with " +
                           core::join({kButtonWords.begin(), kButtonWords.end()}, ", "));
        return *value;
    };
    const double time = number(0);
    if (time < next_time_)
        throw core::InputError(path_, "line " + std::to_string(lines_) + ": goes back in time, to " +
                                          core::to_short_text(time));
    next_time_ = time;
    next_ = {};
    if (parts.size() == 2) {
        next_.end = parts[1] == "end";
        next_.button = parse_button(parts[1]);
        if (next_.end || next_.button != Button::none) return;
    }
    // Both are read first: number() may throw, and an assignment must not be left half done.
    const double x = number(1), y = number(2);
    next_.direction = {x, y};
    next_.on_part = parts.size() == 3;
    if (parts.size() > 3 && !(parts.size() == 4 && parts[3] == "up")) number(parts.size());
}

void Steering::read_device()
{
    js_event event = {};
    while (::read(joystick_.get(), &event, sizeof event) == sizeof event) {
        apply_event(event, device_);
        if (const Button button = std::exchange(device_.button, Button::none); button != Button::none)
            pushed_.push_back(button);
    }
    if (errno != EAGAIN) device_.end = true; // it was unplugged
}

} // namespace fettle::strategy
