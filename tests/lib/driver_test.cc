// A driver's answers, there before the questions, and what the client makes of them.

#include "core/descriptor.h"
#include "core/error.h"
#include "gantry/driver.h"

#include <gtest/gtest.h>

#include <functional>
#include <sys/socket.h>

namespace fettle {
namespace {

using Eigen::Vector3d;

const std::string kLimits = "fettle-gantry 1 -500 500 -500 500 -500 500 100 60";
const std::string kHome = "1 0 0 30 0 0 0";

Job job()
{
    Job job;
    job.source = "job";
    job.force.max = 60;
    return job;
}

/// Speaks to a driver that gives these answers, numbered, one a command, and then closes its output.
/// @return  what the client said, or, if it threw, why
std::string told(const std::vector<std::string>& answers, const std::function<void(DriverGantry&)>& work = {},
                 const Job& of = job())
{
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) throw std::runtime_error("no sockets");
    Descriptor ours(ends[0]);
    const Descriptor theirs(ends[1]);
    std::string lines;
    for (std::size_t i = 0; i < answers.size(); ++i) lines += std::to_string(i + 1) + " ok " + answers[i] + "\n";
    EXPECT_TRUE(write_all(theirs, lines));
    ::shutdown(theirs.get(), SHUT_WR);
    try {
        DriverGantry gantry("driver", std::move(ours), of, 1);
        if (work) work(gantry);
    } catch (const InputError& error) {
        return error.what();
    }
    std::string said(10000, '\0');
    const ssize_t size = ::read(theirs.get(), said.data(), said.size());
    said.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    return said;
}

std::string told_when(const std::string& answer, const std::function<void(DriverGantry&)>& work)
{
    return told({kLimits, "60", kHome, answer}, work);
}

// By hand, after docs/driver.md.
TEST(Driver, IsSpokenToInItsLanguage)
{
    const std::string said =
        told({kLimits, "60", kHome, "2 5 6 7 0 0 0", "3 5 7 7 0.5 20 25", "4 5 8 6.5 0.4 19 19", "5 5 8 30 0 0 0",
              "99.5 6 5 8 30 0 0 0", "6.5 7 5 8 30 0 0 0", "none 8 5 8 30 0 0 0", "9 5 8 30 0 0 0", "10 5 8 30 0 0 0"},
             [](DriverGantry& gantry) {
                 EXPECT_EQ(gantry.limits().speed, 100);
                 gantry.travel({5, 6, 7});
                 EXPECT_EQ(gantry.grind({5, 7, 7}, 20).peak_force, 25);
                 EXPECT_EQ(gantry.press({5, 8, 6}, 20, 19).commanded, Vector3d(5, 8, 6.5));
                 gantry.lift(30);
                 EXPECT_EQ(gantry.touch_off(), 99.5);
                 EXPECT_EQ(gantry.probe({5, 8}, 2), 6.5);
                 EXPECT_TRUE(std::isnan(gantry.probe({5, 8}, 2)));
                 gantry.change_wheel();
                 EXPECT_EQ(gantry.status().time, 9);
             });
    EXPECT_EQ(said,
              "1 connect fettle-gantry 1\n2 limit 60\n3 home 0\n4 travel 5 6 7\n5 move 5 7 7 20\n"
              "6 press 5 8 6 20 19\n7 lift 30\n8 touch_off\n9 probe 5 8 2\n10 probe 5 8 2\n11 change_wheel\n12 quit\n");
}

TEST(Driver, MustDoWhatTheJobNeeds)
{
    EXPECT_NE(told({"fettle-gantry 1 -500 500 many"}).find("makes no sense"), std::string::npos);
    Job strong = job();
    strong.force.max = 61;
    EXPECT_EQ(told({kLimits, "61", kHome}, {}, strong), "job: force.max is above the 60 N of the machine");
    const auto grind = [](DriverGantry& gantry) { gantry.grind({1, 1, 30}, 101); };
    const auto press = [](DriverGantry& gantry) { gantry.press({1, 1, 30}, 0, 20); };
    const auto far = [](DriverGantry& gantry) { gantry.grind({501, 1, 30}, 20); };
    EXPECT_EQ(told_when(kHome, grind), "gantry: a feed of 101 mm/s is not in the machine's range");
    EXPECT_EQ(told_when(kHome, press), "gantry: a feed of 0 mm/s is not in the machine's range");
    EXPECT_EQ(told_when(kHome, far), "driver: the machine does not reach 501 1 30 mm");
}

TEST(Driver, IsNotBelievedWhatCannotBe)
{
    const auto grind = [](DriverGantry& gantry) { gantry.grind({5, 0, 30}, 20); };
    const auto probe = [](DriverGantry& gantry) { gantry.probe({0, 0}, 2); };
    const auto change = [](DriverGantry& gantry) { gantry.change_wheel(); };
    const auto part = [](const std::string& message, const std::string& words) {
        return message.find(words) == std::string::npos ? message : words;
    };
    for (const char* forces : {"0.1 -1 2", "-0.1 1 2", "0.1 3 2"}) {
        const std::string message = told_when("2 5 0 30 " + std::string(forces), grind);
        EXPECT_NE(message.find("reports a force of"), std::string::npos) << message;
    }
    for (const char* z : {"-3.1", "35.1"})
        EXPECT_EQ(part(told_when(z + std::string(" 2 0 0 30 0 0 0"), probe), "touches at z"), "touches at z") << z;
    EXPECT_EQ(part(told_when("2 0 5.1 30 0 0 0", change), "stands at 0 5.1 30 after 'change_wheel'"),
              "stands at 0 5.1 30 after 'change_wheel'");
    EXPECT_EQ(part(told_when("0.5 0 0 30 0 0 0", change), "goes back in time"), "goes back in time");
    EXPECT_EQ(part(told_when("1.5 0 0 90 0 0 0", change), "jumps by 60 mm in 0.5 s"), "jumps by 60 mm in 0.5 s");
}

} // namespace
} // namespace fettle
