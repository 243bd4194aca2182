// A driver's answers, there before the questions, and what the client makes of them.

#include "core/descriptor.h"
#include "core/error.h"
#include "gantry/driver.h"
#include "gantry/serve.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <sys/socket.h>
#include <thread>

namespace fettle {
namespace driver_test {

using Eigen::Vector3d;

const std::string kLimits = "fettle-gantry 1 -500 500 -500 500 -500 500 100 60";
const std::string kHome = "1 0 0 30 0 0 0";

job::Job job()
{
    job::Job job;
    job.source = "job";
    job.force.max = 60;
    return job;
}

/// Speaks to a driver that gives these answers, numbered, one a command, and then closes its output.
/// @return  what the client sent, or its error message
std::string reply_to(const std::vector<std::string>& answers,
                     const std::function<void(gantry::DriverGantry&)>& work = {}, const job::Job& of = job())
{
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) throw std::runtime_error("no sockets");
    core::FileDescriptor ours(ends[0]);
    const core::FileDescriptor theirs(ends[1]);
    std::string lines;
    for (std::size_t i = 0; i < answers.size(); ++i) lines += std::to_string(i + 1) + " ok " + answers[i] + "\n";
    EXPECT_TRUE(core::write_all(theirs, lines));
    ::shutdown(theirs.get(), SHUT_WR);
    try {
        gantry::DriverGantry gantry("driver", std::move(ours), of, 1);
        if (work) work(gantry);
    } catch (const core::InputError& error) {
        return error.what();
    }
    std::string sent(10000, '\0');
    const ssize_t size = ::read(theirs.get(), sent.data(), sent.size());
    sent.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    return sent;
}

std::string reply_after(const std::string& answer, const std::function<void(gantry::DriverGantry&)>& work)
{
    return reply_to({kLimits, "60", kHome, answer}, work);
}

// By hand, after docs/driver.md.
TEST(Driver, IsSpokenToInItsLanguage)
{
    const std::string sent = reply_to(
        {kLimits, "60", kHome, "2 5 6 7 0 0 0", "3 5 7 7 0.5 20 25", "4 5 8 6.5 0.4 19 19", "5 5 8 30 0 0 0",
         "25.3 6 5 8 30 0 0 0", "6.5 7 5 8 30 0 0 0", "none 8 5 8 30 0 0 0", "9 5 8 30 0 0 0", "10 5 8 30 0 0 0"},
        [](gantry::DriverGantry& gantry) {
            EXPECT_EQ(gantry.limits().speed, 100);
            gantry.travel({5, 6, 7});
            EXPECT_EQ(gantry.grind({5, 7, 7}, 20).peak_force, 25);
            EXPECT_EQ(gantry.press({5, 8, 6}, 20, 19).commanded, Vector3d(5, 8, 6.5));
            gantry.lift(30);
            EXPECT_EQ(gantry.touch_off(), 25.3);
            EXPECT_EQ(gantry.probe({5, 8}, 2), 6.5);
            EXPECT_TRUE(std::isnan(gantry.probe({5, 8}, 2)));
            gantry.change_wheel();
            EXPECT_EQ(gantry.status().time, 9);
        });
    EXPECT_EQ(sent,
              "1 connect fettle-gantry 1\n2 limit 60\n3 home 0\n4 travel 5 6 7\n5 move 5 7 7 20\n"
              "6 press 5 8 6 20 19\n7 lift 30\n8 touch_off\n9 probe 5 8 2\n10 probe 5 8 2\n11 change_wheel\n12 quit\n");
}

TEST(Driver, MustDoWhatTheJobNeeds)
{
    EXPECT_NE(reply_to({"fettle-gantry 1 -500 500 many"}).find("makes no sense"), std::string::npos);
    job::Job strong = job();
    strong.force.max = 61;
    EXPECT_EQ(reply_to({kLimits, "61", kHome}, {}, strong), "job: force.max is above the 60 N of the machine");
    const auto grind = [](gantry::DriverGantry& gantry) { gantry.grind({1, 1, 30}, 101); };
    const auto press = [](gantry::DriverGantry& gantry) { gantry.press({1, 1, 30}, 0, 20); };
    const auto far = [](gantry::DriverGantry& gantry) { gantry.grind({501, 1, 30}, 20); };
    EXPECT_EQ(reply_after(kHome, grind), "gantry: a feed of 101 mm/s is not in the machine's range");
    EXPECT_EQ(reply_after(kHome, press), "gantry: a feed of 0 mm/s is not in the machine's range");
    EXPECT_EQ(reply_after(kHome, far), "driver: the machine does not reach 501 1 30 mm");
}

TEST(Driver, RefusesImpossibleAnswers)
{
    const auto grind = [](gantry::DriverGantry& gantry) { gantry.grind({5, 0, 30}, 20); };
    const auto probe = [](gantry::DriverGantry& gantry) { gantry.probe({0, 0}, 2); };
    const auto change = [](gantry::DriverGantry& gantry) { gantry.change_wheel(); };
    const auto part = [](const std::string& message, const std::string& words) {
        return message.find(words) == std::string::npos ? message : words;
    };
    for (const char* forces : {"0.1 -1 2", "-0.1 1 2", "0.1 3 2"}) {
        const std::string message = reply_after("2 5 0 30 " + std::string(forces), grind);
        EXPECT_NE(message.find("reports a force of"), std::string::npos) << message;
    }
    for (const char* z : {"-3.1", "35.1"})
        EXPECT_EQ(part(reply_after(z + std::string(" 2 0 0 30 0 0 0"), probe), "touches at z"), "touches at z") << z;
    EXPECT_EQ(part(reply_after("2 0 5.1 30 0 0 0", change), "stands at 0 5.1 30 after 'change_wheel'"),
              "stands at 0 5.1 30 after 'change_wheel'");
    EXPECT_EQ(part(reply_after("0.5 0 0 30 0 0 0", change), "goes back in time"), "goes back in time");
    EXPECT_EQ(part(reply_after("1.5 0 0 90 0 0 0", change), "jumps by 60 mm in 0.5 s"), "jumps by 60 mm in 0.5 s");
}

// The default head: 35 N/mm, without preload; 0.5 mm are its tolerance.
TEST(Driver, HasToFeelWhatItsSpringFeels)
{
    const auto after = [](const std::string& answer, const std::string& words) {
        const auto grind = [](gantry::DriverGantry& gantry) { gantry.grind({5, 0, 30}, 20); };
        const std::string message = reply_after("2 5 0 30 " + answer, grind);
        return message.find(words) != std::string::npos ? "" : message;
    };
    EXPECT_EQ(after("1 35 35", "quit"), "");
    EXPECT_EQ(after("1 17.6 40", "quit"), ""); // half a millimetre less
    EXPECT_EQ(after("0 17.4 17.4", "quit"), "");
    EXPECT_EQ(after("0.2 61 61", "quit"), ""); // the force that has stopped it
    EXPECT_EQ(after("1 17.4 40", "a force of 17.4 N at a deflection of 1 mm, where the head's spring has 35 N"), "");
    EXPECT_EQ(after("0.51 0 0", "a force of 0 N at a deflection of 0.51 mm"), "");
    EXPECT_EQ(after("0 18 18", "a force of 18 N at a deflection of 0 mm"), "");
    EXPECT_EQ(after("1e30 40 40", "a deflection of 1e+30 mm; the head travels 1000 mm"), "");
    EXPECT_EQ(after("1 35 1e30", "a force of 1e+30 N"), "");
}

TEST(Driver, PreloadIsFeltOnTheStopOrNot)
{
    const gantry::HeadCheck head{.preload = 30, .stiffness = 10, .max_force = 100, .tolerance = 0.1, .travel = 10};
    const auto check = [&](double deflection, double force) {
        gantry::check_head(head, {.deflection = deflection, .force = force, .peak_force = force});
    };
    for (const double force : {0.0, 12.0, 30.0, 31.0}) EXPECT_NO_THROW(check(0, force)) << force;
    EXPECT_THROW(check(0, 31.1), gantry::GantryFault);
    EXPECT_THROW(check(0.2, 30.9), gantry::GantryFault);
    EXPECT_NO_THROW(check(0.2, 31.1));
    EXPECT_NO_THROW(check(0.1, 0)); // what the transducer does not resolve
}

TEST(Driver, IsNotBelievedAboutLimitsWheelsAndTime)
{
    const auto touch = [](gantry::DriverGantry& gantry) { gantry.touch_off(); };
    const auto twice = [](gantry::DriverGantry& gantry) { gantry.touch_off(), gantry.touch_off(); };
    const auto renewed = [](gantry::DriverGantry& gantry) {
        gantry.touch_off(), gantry.change_wheel(), gantry.touch_off();
    };
    const auto grind = [](gantry::DriverGantry& gantry) { gantry.grind({5, 0, 30}, 20); };
    const auto lower = [](gantry::DriverGantry& gantry) { gantry.lift(20); };
    const std::string at = " 0 0 30 0 0 0";
    const auto says = [](const std::string& message, const std::string& words) {
        return message.find(words) != std::string::npos ? "" : message;
    };
    EXPECT_EQ(says(reply_to({kLimits, "1000", kHome}), "guards its moves at 1000 N instead of 60"), "");
    EXPECT_EQ(says(reply_to({kLimits, "sixty", kHome}), "makes no sense"), "");
    EXPECT_EQ(says(reply_to({kLimits, "60", "1e12" + at}), "begins at 1e+12 s"), "");
    EXPECT_EQ(says(reply_after("1e6 2" + at, touch), "measures a wheel of 1e+06 mm; a new one has 25.4 mm"), "");
    EXPECT_EQ(says(reply_to({kLimits, "60", kHome, "20 2" + at, "20.6 3" + at}, twice), "which had 20 mm before"), "");
    EXPECT_EQ(says(reply_to({kLimits, "60", kHome, "20 2" + at, "3" + at, "25 4" + at}, renewed), "quit"), "");
    EXPECT_EQ(says(reply_after("1e12 5 0 30 0 0 0", grind), "jumps ahead in time by 1e+12 s"), "");
    EXPECT_EQ(says(reply_after("2 0 0 506 0 0 0", touch), "makes no sense"), "");
    EXPECT_EQ(says(reply_after("6 0 0 21 0 0 0", lower), "stops 1 mm early after 'lift 20', but reported at most 0 N"),
              "");
    EXPECT_EQ(says(reply_after("6 0 0 21 1 35 60", lower), "quit"), "");
    EXPECT_EQ(says(reply_after("20 9 0 0 506 0 0 0", touch), "stands at 0 0 506, out of its range"), "");
}

/// A machine that takes its time: a millisecond for each millimetre.
class SlowGantry final : public gantry::Gantry {
  public:
    gantry::GantryStatus travel(const Vector3d& to) override { return move(to); }
    gantry::GantryStatus grind(const Vector3d& to, double /*feed*/) override { return move(to); }
    gantry::GantryStatus lift(double z) override { return move({status_.commanded.x(), status_.commanded.y(), z}); }
    double touch_off() override { return 25; }
    void change_wheel() override {}
    double probe(const Eigen::Vector2d& /*xy*/, double /*lowest*/) override { return 0; }
    gantry::GantryStatus status() const override { return status_; }

  private:
    gantry::GantryStatus move(const Vector3d& to)
    {
        while (status_.commanded != to) {
            check_interrupt();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            const Vector3d rest = to - status_.commanded;
            status_.commanded = rest.norm() <= 1 ? to : status_.commanded + rest.normalized();
            status_.time += 0.01;
        }
        return status_;
    }
    gantry::GantryStatus status_{.time = 1, .commanded = {0, 0, 30}};
};

struct Sockets {
    core::FileDescriptor ours, theirs;
    Sockets()
    {
        int ends[2];
        if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) throw std::runtime_error("no sockets");
        ours = core::FileDescriptor(ends[0]);
        theirs = core::FileDescriptor(ends[1]);
    }
};

// A move of 400 ms is stopped after 50: the machine stands where it is, is lifted off, and can be moved again.
TEST(Driver, IsStoppedInTheMiddleOfAMove)
{
    Sockets sockets;
    SlowGantry slow;
    const job::Job of = job();
    const gantry::protocol::Limits limits{Vector3d::Constant(-500), Vector3d::Constant(500), 100, 60};
    std::thread driver([&] { gantry::serve(slow, limits, of, sockets.theirs, sockets.theirs); });
    {
        gantry::DriverGantry gantry("driver", std::move(sockets.ours), of, 1);
        const auto begun = std::chrono::steady_clock::now();
        gantry.set_interrupt([&](const gantry::GantryStatus& /*now*/) {
            return std::chrono::steady_clock::now() - begun > std::chrono::milliseconds(50);
        });
        EXPECT_THROW(gantry.travel({400, 0, 30}), gantry::Interrupted);
        EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(250));
        EXPECT_LT(gantry.status().commanded.x(), 200);
        EXPECT_EQ(gantry.status().commanded.z(), 32); // off the part
        const double x = gantry.status().commanded.x();
        EXPECT_EQ(gantry::retract(gantry, 33).commanded, Vector3d(x, 0, 33)); // no higher than the safe height
        EXPECT_EQ(gantry.grind({x + 1, 0, 33}, 20).commanded.x(), x + 1);
    }
    driver.join();
}

// A driver that does not know `halt` ends its move first, and is asked where it stands.
TEST(Driver, MayNotKnowHowToHalt)
{
    Sockets sockets;
    std::thread driver([&] {
        std::string sent;
        char buffer[1000];
        const auto until = [&](const std::string& line) {
            while (sent.find(line) == std::string::npos) {
                const ssize_t n = ::read(sockets.theirs.get(), buffer, sizeof buffer);
                if (n <= 0) return;
                sent.append(buffer, std::size_t(n));
            }
        };
        const auto answer = [&](const std::string& line) { EXPECT_TRUE(core::write_all(sockets.theirs, line + "\n")); };
        until("1 connect"), answer("1 ok " + kLimits);
        until("2 limit"), answer("2 ok 60");
        until("3 home"), answer("3 ok " + kHome);
        until("4 move"), until("5 halt"), answer("4 ok 2 5 0 30 0 0 0");
        answer("5 error no such command: halt");
        until("6 status"), answer("6 ok 2.5 5 0 30 0 0 0");
        until("7 quit"), answer("7 ok 3 5 0 30 0 0 0");
    });
    {
        gantry::DriverGantry gantry("driver", std::move(sockets.ours), job(), 1);
        int asked = 0;
        gantry.set_interrupt([&](const gantry::GantryStatus& /*now*/) { return ++asked > 3; });
        EXPECT_THROW(gantry.grind({5, 0, 30}, 20), gantry::Interrupted);
        EXPECT_EQ(gantry.status().time, 2.5);
        EXPECT_EQ(asked, 4); // not again before it is armed again
    }
    driver.join();
}

// A driver whose answer to `halt` cannot be true is stopped as after any other such answer.
TEST(Driver, MustHaltAsItSays)
{
    Sockets sockets;
    EXPECT_TRUE(core::write_all(sockets.theirs, "1 ok " + kLimits + "\n2 ok 60\n3 ok " + kHome + "\n"));
    std::string message;
    {
        gantry::DriverGantry gantry("driver", std::move(sockets.ours), job(), 1);
        int asked = 0;
        gantry.set_interrupt([&](const gantry::GantryStatus& /*now*/) {
            if (++asked < 3) return false;
            EXPECT_TRUE(core::write_all(sockets.theirs, "4 ok 2 5 0 30 0 0 0\n5 ok 0.5 5 0 30 0 0 0\n6 ok\n"));
            return true;
        });
        try {
            gantry.grind({5, 0, 30}, 20);
        } catch (const gantry::GantryFault& fault) {
            message = fault.what();
        }
        ::shutdown(sockets.theirs.get(), SHUT_WR);
    }
    EXPECT_EQ(message, "driver 'driver' goes back in time, to 0.5 s; stopped");
    std::string read(1000, '\0');
    read.resize(std::size_t(std::max<ssize_t>(::read(sockets.theirs.get(), read.data(), read.size()), 0)));
    EXPECT_NE(read.find("\n4 move 5 0 30 20\n5 halt\n6 stop\n"), std::string::npos) << read;
}

// A machine whose head stands still says so to a job that needs it turned.
TEST(Driver, MachinesMayNotTurnTheirHeads)
{
    SlowGantry slow;
    gantry::Gantry& machine = slow;
    try {
        machine.turn_to(1);
        ADD_FAILURE() << "it does not turn";
    } catch (const gantry::GantryFault& fault) {
        EXPECT_EQ(std::string(fault.what()), "the machine cannot turn its head");
    }
}

// One that knows `travel_low` is asked for it; one that does not gets `travel`, and is not asked again.
TEST(Driver, MayNotKnowHowToTravelLow)
{
    const std::string sent = reply_to({kLimits, "60", kHome, "2 5 6 7 0 0 0"}, [](gantry::DriverGantry& gantry) {
        EXPECT_EQ(gantry.travel_low({5, 6, 7}, 12, 8).commanded, Vector3d(5, 6, 7));
    });
    EXPECT_NE(sent.find("\n4 travel_low 5 6 7 12 8\n"), std::string::npos) << sent;

    Sockets sockets;
    EXPECT_TRUE(core::write_all(sockets.theirs, "1 ok " + kLimits + "\n2 ok 60\n3 ok " + kHome +
                                                    "\n4 error no such command: travel_low\n5 ok 2 5 6 7 0 0 0\n"
                                                    "6 ok 3 6 6 7 0 0 0\n"));
    {
        gantry::DriverGantry gantry("driver", std::move(sockets.ours), job(), 1);
        EXPECT_EQ(gantry.travel_low({5, 6, 7}, 12, 8).commanded, Vector3d(5, 6, 7));
        EXPECT_EQ(gantry.travel_low({6, 6, 7}, 12, 8).commanded, Vector3d(6, 6, 7));
        ::shutdown(sockets.theirs.get(), SHUT_WR);
    }
    std::string read(1000, '\0');
    read.resize(std::size_t(std::max<ssize_t>(::read(sockets.theirs.get(), read.data(), read.size()), 0)));
    EXPECT_NE(read.find("4 travel_low 5 6 7 12 8\n5 travel 5 6 7\n6 travel 6 6 7\n"), std::string::npos) << read;
}

} // namespace driver_test
} // namespace fettle
