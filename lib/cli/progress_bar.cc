#include "cli/progress_bar.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>

namespace fettle::cli {

core::Progress progress_bar(const std::string& label)
{
    using Clock = std::chrono::steady_clock;
    struct Bar {
        Clock::time_point next = Clock::now() + std::chrono::seconds(1);
        bool shown = false;
    };
    return [label, bar = std::make_shared<Bar>()](double fraction) {
        if (Clock::now() < bar->next && !(bar->shown && fraction >= 1)) return;
        if (fraction >= 1 && !bar->shown) return;
        bar->shown = true;
        bar->next = Clock::now() + std::chrono::milliseconds(100);
        constexpr int kWidth = 40;
        const int done = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * kWidth);
        std::cerr << '\r' << label << " [" << std::string(done, '#') << std::string(kWidth - done, ' ') << "] "
                  << static_cast<int>(100 * fraction) << " %" << (fraction >= 1 ? "\n" : "") << std::flush;
    };
}

} // namespace fettle::cli
