// What is believed of a removal law: identities, and a law that is found again.

#include "calibrate/law_record.h"
#include "calibrate/law_report.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace fettle;
using calibrate::LawRecord;

namespace law_belief_test {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// F^2 t, wearing by a hundredth of a pass's work each.
LawRecord drawn(int count)
{
    LawRecord record;
    record.pass_work = 5 * 10;
    for (int k = 0; k < count; ++k) {
        removal::RemovalTrial pass{3.0 + k % 7, kNone, kNone, 5.0 + 3 * (k % 5), 50.0 * k, 0};
        pass.volume = 0.1 * pass.force * pass.force * pass.duration * std::exp(-0.01 * k);
        record.passes.push_back(pass);
    }
    return record;
}

TEST(LawBelief, FindsTheLawAgain)
{
    const calibrate::LearntLaw law = calibrate::learn(drawn(60));
    const calibrate::Posterior posterior = law.belief.posterior();
    EXPECT_NEAR(posterior.mean[calibrate::force], 2, 0.01);
    EXPECT_NEAR(posterior.mean[calibrate::duration], 1, 0.01);
    EXPECT_NEAR(posterior.mean[calibrate::wear], 0.01, 1e-3);
    EXPECT_NEAR(posterior.covariance(calibrate::speed, calibrate::speed), 0, 1e-12);
    EXPECT_EQ(calibrate::determination(law, calibrate::force), "measured");
    EXPECT_EQ(calibrate::determination(law, calibrate::speed), "not recorded");
    EXPECT_NEAR(law.belief.weights().sum(), 1, 1e-12);
    for (const calibrate::JudgedPass& pass : law.passes) EXPECT_FALSE(pass.has_change);
}

// In other units of force and time the same is predicted.
TEST(LawBelief, DoesNotDependOnUnits)
{
    LawRecord record = drawn(12), other = record;
    for (removal::RemovalTrial& pass : other.passes) {
        pass.force *= 4.448;
        pass.duration /= 60;
        pass.prior_work *= 7;
    }
    other.pass_work *= 7;
    const auto expected = calibrate::learn(record).passes.back().predicted,
               found = calibrate::learn(other).passes.back().predicted;
    EXPECT_NEAR(found.volume / expected.volume, 1, 1e-9);
    EXPECT_NEAR(found.upper / expected.upper, 1, 1e-9);
    EXPECT_NEAR(found.tail_probability, expected.tail_probability, 1e-9);
}

TEST(LawBelief, TellsABluntWheel)
{
    LawRecord record = drawn(30);
    record.passes.back().volume /= 2;
    const calibrate::LearntLaw law = calibrate::learn(record);
    EXPECT_TRUE(law.passes.back().has_change);
    EXPECT_EQ(calibrate::prediction_quality(law).changes, 1U);
    EXPECT_NE(calibrate::change_message(law.passes.back(), 30).find("blunt"), std::string::npos);
}

// Where one force was recorded its exponent is Preston's still, and another force tells most.
TEST(LawBelief, AsksForAnotherForce)
{
    LawRecord record = drawn(20);
    for (removal::RemovalTrial& pass : record.passes) {
        pass.volume *= 16 / (pass.force * pass.force);
        pass.force = 4;
    }
    const calibrate::LearntLaw law = calibrate::learn(record);
    EXPECT_EQ(calibrate::determination(law, calibrate::force), "assumed");
    const double asked = calibrate::most_informative_pass(law).force;
    EXPECT_TRUE(asked == 6 || asked == 4 / 1.5);
}

TEST(LawBelief, RejectsWhatIsNotPositive)
{
    LawRecord record = drawn(8);
    record.passes[5].volume = 0;
    EXPECT_THROW(calibrate::learn(record), core::InputError);
    record = drawn(8);
    record.passes[5].force = -1;
    EXPECT_THROW(calibrate::learn(record), core::InputError);
    record.passes.clear();
    EXPECT_THROW(calibrate::learn(record), core::InputError);
}

} // namespace law_belief_test
