#include "strategy/keys.h"

#include <unistd.h>

namespace fettle {
namespace {

/// Longer than between two repeats of a key that is held (30 in a second are usual).
constexpr double kHeld = 0.1;      // s
constexpr double kRounding = 1e-9; // of sums of time, s
constexpr std::string_view kArrow = "\033[";

Eigen::Vector2d way_of(char arrow)
{
    switch (arrow) {
    case 'A':
        return {0, 1};
    case 'B':
        return {0, -1};
    case 'C':
        return {1, 0};
    case 'D':
        return {-1, 0};
    default:
        return {0, 0};
    }
}

} // namespace

Keys::Keys(int terminal) : terminal_(terminal)
{
    ::tcgetattr(terminal_, &before_);
    termios now = before_;
    now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    now.c_cc[VMIN] = now.c_cc[VTIME] = 0; // a read does not wait
    ::tcsetattr(terminal_, TCSANOW, &now);
}

Keys::~Keys() { ::tcsetattr(terminal_, TCSANOW, &before_); }

void Keys::tell(double time, Stick& stick)
{
    read_waiting(stick);
    if (time >= rest_at_ - kRounding) stick.way.setZero();
    while (!waiting_.empty() && stick.button == Button::none && !stick.end) {
        const char key = waiting_[0];
        const bool escape = key == kArrow[0];
        if (escape && waiting_.size() < kArrow.size() + 1) return; // the rest is on its way
        if ((key == 'r' || key == 'n' || key == 'q') && stick.way.norm() > 0) return;
        if (key == ' ') stick.way.setZero();
        if (key == 'u') stick.press = !stick.press;
        if (escape && waiting_.starts_with(kArrow)) {
            stick.way = way_of(waiting_[kArrow.size()]);
            rest_at_ = time + kHeld;
        }
        stick.button = key == 'r' ? Button::record : key == 'n' ? Button::next : Button::none;
        stick.end = key == 'q';
        waiting_.erase(0, escape ? kArrow.size() + 1 : 1);
    }
}

void Keys::read_waiting(Stick& stick)
{
    char some[64];
    ssize_t n = 0;
    while ((n = ::read(terminal_, some, sizeof some)) > 0) waiting_.append(some, static_cast<std::size_t>(n));
    if (n < 0) stick.end = true; // the terminal is gone
}

} // namespace fettle
