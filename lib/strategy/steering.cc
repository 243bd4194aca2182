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
#include <sys/stat.h>

namespace fettle::strategy {
namespace {

constexpr std::size_t kMaxLineLength = 4096;

} // namespace

Steering::Steering(const std::string& path)
    : path_(core::display_name(path)),
      file_(path == "-" ? ::dup(STDIN_FILENO) : ::open(path.c_str(), O_RDONLY | O_CLOEXEC))
{
    if (!file_.is_open()) throw core::InputError(path_, std::string("cannot open: ") + std::strerror(errno));
    struct stat status = {};
    char axes = 0;
    live_ =
        ::fstat(file_.get(), &status) == 0 && S_ISCHR(status.st_mode) && ::ioctl(file_.get(), JSIOCGAXES, &axes) == 0;
    if (live_)
        ::fcntl(file_.get(), F_SETFL, O_NONBLOCK);
    else if (::isatty(file_.get()) != 0)
        keys_ = std::make_unique<Keys>(file_.get());
    else
        read_next();
    live_ = live_ || keys_;
}

Steering::~Steering() = default;

const Stick& Steering::at(double time)
{
    const bool pushed = now_.button != Button::none;
    now_.button = Button::none;
    if (keys_)
        keys_->update(time, now_);
    else if (live_)
        read_device();
    else if (pushed)
        read_next(); // only now: the writer of a pipe may wait for the effect of the push
    while (!live_ && time >= next_time_ && !now_.end && now_.button == Button::none) {
        now_ = next_;
        if (!now_.end && now_.button == Button::none) read_next();
    }
    return now_;
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
                           " is none of \"TIME X Y\", \"TIME X Y up\", \"TIME record\", \"TIME next\", \"TIME end\"");
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
        next_.button = parts[1] == "record" ? Button::record : parts[1] == "next" ? Button::next : Button::none;
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
    while (now_.button == Button::none && ::read(file_.get(), &event, sizeof event) == sizeof event)
        apply_event(event, now_);
    if (now_.button == Button::none && errno != EAGAIN) now_.end = true; // it was unplugged
}

} // namespace fettle::strategy
