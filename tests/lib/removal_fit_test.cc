// Removal laws from trials: drawn from a law, and measured.

#include "core/error.h"
#include "removal/removal_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace fettle;

namespace removal_fit_test {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<removal::RemovalTrial> drawn(const removal::RemovalLaw& law, int count)
{
    std::vector<removal::RemovalTrial> trials;
    for (int k = 0; k < count; ++k) {
        removal::RemovalTrial trial{3.0 + k % 7,       100.0 + 10 * (k % 4),    kNone,
                                    5.0 + 3 * (k % 5), 1e4 * ((k * 7) % count), 0};
        trial.volume = removal::removed_volume(law, trial);
        trials.push_back(trial);
    }
    return trials;
}

TEST(RemovalFit, FindsTheLawAgain)
{
    removal::RemovalLaw law;
    law.log_coefficient = -12;
    law.force_exponent = 1.2;
    law.speed_exponent = 1.7;
    law.duration_exponent = 1.4;
    law.threshold = 1.9;
    law.wear_rate = 1 / 2e5;
    const removal::RemovalLaw found = removal::fit_removal(drawn(law, 24), {true, true, true});
    EXPECT_NEAR(found.threshold, 1.9, 1e-6);
    EXPECT_NEAR(found.force_exponent, 1.2, 1e-6);
    EXPECT_NEAR(found.speed_exponent, 1.7, 1e-6);
    EXPECT_EQ(found.feed_exponent, 0);
    EXPECT_NEAR(found.duration_exponent, 1.4, 1e-6);
    EXPECT_NEAR(found.wear_rate * 2e5, 1, 1e-6);
    EXPECT_NEAR(removal::score_removal(drawn(law, 24), {true, true, true}).leave_one_out_r2, 1, 1e-9);
}

// One trial of Preston's law left out: its miss is its own distance from the mean of the others' logarithms.
TEST(RemovalFit, LeavesOut)
{
    std::vector<removal::RemovalTrial> trials;
    for (const double volume : {1.0, 2.0, 8.0}) trials.push_back({1, kNone, 1, kNone, 0, volume});
    const removal::RemovalScore score = removal::score_removal(trials, {false, false, false});
    const double step = std::log(2.0), mean = 4 * step / 3;
    EXPECT_NEAR(score.r2, 0, 1e-12);
    EXPECT_NEAR(score.leave_one_out_r2, 1 - 2.25, 1e-12); // each miss is 3/2 of that from the mean of all
    EXPECT_NEAR(score.worst_factor, std::exp(1.5 * (3 * step - mean)), 1e-9);
}

// A belt that cut better with time is not taken to sharpen.
TEST(RemovalFit, WearsOnly)
{
    removal::RemovalLaw law;
    law.wear_rate = -1 / 2e5;
    EXPECT_EQ(removal::fit_removal(drawn(law, 20), {true, true, false}).wear_rate, 0);
}

TEST(RemovalFit, Refuses)
{
    const std::vector<removal::RemovalTrial> trials = drawn({}, 4);
    EXPECT_THROW(removal::fit_removal(trials, {true, true, false}), core::InputError); // 5 unknowns
    std::vector<removal::RemovalTrial> bad = drawn({}, 10);
    bad[3].volume = 0;
    EXPECT_THROW(removal::fit_removal(bad, {true, false, false}), core::InputError);
}

} // namespace removal_fit_test
