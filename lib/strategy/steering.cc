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

namespace fettle {
namespace {

constexpr std::size_t kLongestLine = 4096;

} // namespace

Steering::Steering(const std::string& path)
    : path_(display_name(path)), file_(path == "-" ? ::dup(STDIN_FILENO) : ::open(path.c_str(), O_RDONLY | O_CLOEXEC))
{
    if (!file_.is_open()) throw InputError(path_, std::string("cannot open: ") + std::strerror(errno));
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
        keys_->tell(time, now_);
    else if (live_)
        read_device();
    else if (pushed)
        read_next(); // now: who writes into a pipe may want to see first what the push did
    while (!live_ && time >= next_time_ && !now_.end && now_.button == Button::none) {
        now_ = next_;
        if (!now_.end && now_.button == Button::none) read_next();
    }
    return now_;
}

bool Steering::next_line(std::string& line)
{
    char some[4096];
    for (;;) {
        if (const std::size_t end = pending_.find('\n'); end != std::string::npos) {
            line = pending_.substr(0, end);
            pending_.erase(0, end + 1);
            ++lines_;
            return true;
        }
        if (pending_.size() > kLongestLine)
            throw InputError(path_, "line " + std::to_string(lines_ + 1) + ": longer than " +
                                        std::to_string(kLongestLine) + " bytes");
        const ssize_t n = read_some(file_, some, sizeof some);
        if (n < 0) throw InputError(path_, std::string("cannot read: ") + std::strerror(errno));
        if (n == 0 && pending_.empty()) return false;
        if (n == 0) some[0] = '\n'; // which the last line may lack
        pending_.append(some, static_cast<std::size_t>(std::max<ssize_t>(n, 1)));
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
    const std::vector<std::string_view> parts = words(line);
    const auto number = [&](std::size_t n) -> double {
        const auto value = n < parts.size() ? parse_number(parts[n]) : std::nullopt;
        if (!value || !(*value > -std::numeric_limits<double>::infinity() && *value < 1e9))
            throw InputError(
                path_, "line " + std::to_string(lines_) + ": " + in_quotes(line) +
                           " is none of \"TIME X Y\", \"TIME X Y up\", \"TIME record\", \"TIME next\", \"TIME end\"");
        return *value;
    };
    const double time = number(0);
    if (time < next_time_)
        throw InputError(path_, "line " + std::to_string(lines_) + ": goes back in time, to " + to_short_text(time));
    next_time_ = time;
    next_ = {};
    if (parts.size() == 2) {
        next_.end = parts[1] == "end";
        next_.button = parts[1] == "record" ? Button::record : parts[1] == "next" ? Button::next : Button::none;
        if (next_.end || next_.button != Button::none) return;
    }
    const double x = number(1), y = number(2); // either may throw, which a row of Eigen's does not survive half-filled
    next_.way = {x, y};
    next_.press = parts.size() == 3;
    if (parts.size() > 3 && !(parts.size() == 4 && parts[3] == "up")) number(parts.size());
}

void Steering::read_device()
{
    js_event event = {};
    while (now_.button == Button::none && ::read(file_.get(), &event, sizeof event) == sizeof event) hear(event, now_);
    if (now_.button == Button::none && errno != EAGAIN) now_.end = true; // it was pulled out
}

} // namespace fettle
