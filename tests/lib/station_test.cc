// The operator's session without a terminal and without a machine: events in, screen and commands out.

#include "own_folder.h"

#include "core/constants.h"
#include "core/error.h"
#include "core/file.h"
#include "station/checkpoint.h"
#include "station/folder.h"
#include "station/forecast.h"
#include "station/screen.h"
#include "station/session.h"
#include "station/sketch.h"
#include "json/document.h"

#include <gtest/gtest.h>

#include <fstream>
#include <ostream>

namespace fettle {
namespace station_test {

using station::Command;
using station::Mode;
using station::Session;
using station::Stage;
using strategy::Button;

job::Job settings()
{
    job::Job job;
    job.surface = job::SurfaceType::freeform;
    job.safe_height = 30;
    job.anomaly.resize(3, 3);
    job.anomaly << 0, 10, 5, 0, 0, 8, 1, 1, 1;
    job.sampling.resize(3, 4);
    job.sampling << -20, 30, 30, -20, -20, -20, 30, 30, 1, 1, 1, 1;
    return job;
}

Command push(Session& session, Button button)
{
    strategy::Stick stick;
    stick.button = button;
    return session.input(stick);
}

// Does what the station does: executes a command and hands its result to the session.
void show(Session& session, const std::vector<Eigen::Vector3d>& points)
{
    for (const Eigen::Vector3d& point : points) {
        EXPECT_EQ(push(session, Button::record), Command::record);
        session.add_point(point);
    }
}

const std::vector<Eigen::Vector3d> kAnomaly = {{0, 0, 5}, {12, 0, 5}, {12, 12, 5}, {0, 12, 5}};
const std::vector<Eigen::Vector3d> kSampling = {{-9, -9, 5}, {21, -9, 5}, {21, 21, 5}, {-9, 21, 5}};

Session at_review()
{
    Session session(station::begin_record(settings()));
    show(session, kAnomaly);
    push(session, Button::next);
    show(session, kSampling);
    push(session, Button::next);
    EXPECT_EQ(push(session, Button::start), Command::touch);
    session.planned();
    return session;
}

TEST(Session, LeadsFromTheFirstPointToTheEnd)
{
    Session session(station::begin_record(settings()));
    EXPECT_EQ(session.record().stage, Stage::anomaly);
    strategy::Stick stick;
    EXPECT_EQ(session.input(stick), Command::none);
    stick.direction = {0, 1};
    EXPECT_EQ(session.input(stick), Command::move);
    EXPECT_EQ(push(session, Button::start), Command::none); // there is nothing to start yet
    show(session, kAnomaly);
    push(session, Button::next);
    EXPECT_EQ(session.record().stage, Stage::sampling);
    show(session, kSampling);
    push(session, Button::next);
    EXPECT_EQ(session.record().stage, Stage::touch);
    EXPECT_EQ(session.record().job.anomaly.cols(), 4);
    EXPECT_NEAR(session.record().job.sampling(0, 1), 21, 1e-12);
    EXPECT_EQ(push(session, Button::manual), Command::none); // nothing is known of the surface yet
    EXPECT_EQ(session.record().mode, Mode::automatic);
    EXPECT_EQ(push(session, Button::start), Command::touch);
    session.add_touch({-5, 0, 5});
    session.planned();
    EXPECT_EQ(session.record().stage, Stage::review);
    EXPECT_EQ(push(session, Button::start), Command::grind);
    session.begin(Stage::grind);
    strategy::GrindRun run;
    run.stopped = true;
    run.failure = "stopped by the operator";
    session.ground(run);
    EXPECT_EQ(session.record().stage, Stage::stopped);
    EXPECT_EQ(session.message(), "stopped by the operator");
    push(session, Button::manual);
    EXPECT_EQ(push(session, Button::start), Command::steer);
    session.begin(Stage::manual);
    session.steered({});
    EXPECT_EQ(session.record().manual_runs, 1);
    push(session, Button::automatic);
    EXPECT_EQ(push(session, Button::start), Command::grind);
    run.finished = true;
    session.ground(run);
    EXPECT_EQ(session.record().stage, Stage::done);
    EXPECT_EQ(push(session, Button::start), Command::none); // all is ground
    push(session, Button::manual);
    EXPECT_EQ(push(session, Button::start), Command::steer);
    stick.end = true;
    EXPECT_EQ(session.input(stick), Command::end);
}

TEST(Session, TakesPointsBackAndRefusesBoundariesThatAreNone)
{
    Session session(station::begin_record(settings()));
    show(session, {kAnomaly[0], kAnomaly[1]});
    push(session, Button::next);
    EXPECT_EQ(session.record().stage, Stage::anomaly);
    EXPECT_NE(session.message().find("at least three points"), std::string::npos);
    push(session, Button::back);
    EXPECT_EQ(session.record().anomaly.size(), 1u);
    show(session, {kAnomaly[2], kAnomaly[1], kAnomaly[3]}); // crossed
    push(session, Button::next);
    show(session, kSampling);
    push(session, Button::next);
    EXPECT_EQ(session.record().stage, Stage::sampling);
    EXPECT_NE(session.message().find("the boundaries: anomaly"), std::string::npos) << session.message();
    for (std::size_t i = 0; i < kSampling.size(); ++i) push(session, Button::back);
    EXPECT_EQ(session.record().stage, Stage::sampling);
    push(session, Button::back);
    EXPECT_EQ(session.record().stage, Stage::anomaly);
    EXPECT_EQ(session.record().anomaly.size(), 4u);
    // Above the safe height there is no way across.
    session.add_point({1, 1, 31});
    EXPECT_EQ(session.record().anomaly.size(), 4u);
    EXPECT_NE(session.message().find("safe_height 30 is not above the touch at z 31"), std::string::npos);
}

TEST(Session, KeepsTheBoundariesOfTheJobWhereNoneAreShown)
{
    Session session(station::begin_record(settings()));
    push(session, Button::next);
    push(session, Button::next);
    EXPECT_EQ(session.record().stage, Stage::touch);
    EXPECT_EQ(session.record().job.anomaly.cols(), 3);
    // A new anomaly does not keep the old area around it.
    Session other(station::begin_record(settings()));
    show(other, kAnomaly);
    push(other, Button::next);
    push(other, Button::next);
    EXPECT_EQ(other.record().stage, Stage::sampling);
    EXPECT_NE(other.message().find("sampling"), std::string::npos) << other.message();
}

TEST(Session, TouchesAgainWhenTheFitIsNotTrusted)
{
    Session session = at_review();
    session.add_touch({-5, 0, 5});
    push(session, Button::back);
    EXPECT_EQ(session.record().stage, Stage::touch);
    EXPECT_TRUE(session.record().touches.empty());
    push(session, Button::back);
    EXPECT_EQ(session.record().stage, Stage::sampling);
    EXPECT_EQ(session.record().sampling.size(), 4u);
}

// Whatever stage a program was killed in, the next one has all that was recorded, and no machine that moves by itself.
TEST(Session, GoesOnFromItsFile)
{
    Session session = at_review();
    session.turn(0.25);
    session.add_touch({-5, 0, 5.125});
    session.add_touch({-6, 0, core::kNaN});
    session.add_stop({1, 1.125, 1.5});
    session.begin(Stage::manual);
    const std::string text = to_json(session.record()).text();
    const Session next(station::parse_record(json::Reader::parse(text, "session.json")));
    const station::Record &a = session.record(), &b = next.record();
    EXPECT_EQ(b.stage, Stage::stopped);
    EXPECT_NE(next.message().find("while the machine was at work"), std::string::npos);
    EXPECT_NEAR(b.job.theta, a.job.theta, 1e-14);
    EXPECT_EQ(b.job.anomaly, a.job.anomaly);
    EXPECT_EQ(b.anomaly, a.anomaly);
    EXPECT_EQ(b.sampling, a.sampling);
    ASSERT_EQ(b.touches.size(), 2u);
    EXPECT_EQ(b.touches[0], a.touches[0]);
    EXPECT_TRUE(std::isnan(b.touches[1].z()));
    EXPECT_EQ(b.manual_runs, 1);
    EXPECT_EQ(b.stops.at(0).free, 1.125);
    for (std::size_t i = 0; i < station::kStageWords.size(); ++i) {
        station::Record record = a;
        record.stage = Stage(i);
        const station::Record read = station::parse_record(json::Reader::parse(to_json(record).text(), "s"));
        EXPECT_EQ(to_json(read).text(), to_json(record).text());
    }
}

TEST(Session, RefusesARecordThatIsNone)
{
    const std::string text = to_json(at_review().record()).text();
    const auto refuses = [&](const std::string& what, const std::string& with, const std::string& message) {
        std::string bad = text;
        bad.replace(bad.find(what), what.size(), with);
        try {
            station::parse_record(json::Reader::parse(bad, "s.json"));
            ADD_FAILURE() << message;
        } catch (const core::InputError& error) {
            EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
        }
    };
    refuses("\"session\"", "\"plan\"", "kind");
    refuses("\"review\"", "\"asleep\"", "stage");
    refuses("\"manual_runs\": 0", "\"manual_runs\": -1", "manual_runs");
    refuses("\"touches\"", "\"touchs\"", "touch");
}

TEST(Screen, FitsATerminalAndSaysWhatTheKeysDo)
{
    Session session(station::begin_record(settings()));
    station::Live live;
    const auto text = [&](const std::vector<std::string>& lines) {
        std::string all;
        for (const std::string& line : lines) {
            EXPECT_LE(line.size(), station::kScreenColumns);
            all += line + "\n";
        }
        EXPECT_EQ(lines.size(), station::kScreenRows);
        return all;
    };
    EXPECT_NE(text(draw_screen(session, nullptr, live)).find("no machine yet"), std::string::npos);
    live.has_machine = true;
    live.machine.commanded = {3, 4, 30};
    show(session, kAnomaly);
    const std::string shown = text(draw_screen(session, nullptr, live));
    EXPECT_NE(shown.find("show the anomaly"), std::string::npos);
    EXPECT_NE(shown.find("points: 4 around the anomaly"), std::string::npos);
    EXPECT_NE(shown.find("r: record"), std::string::npos);
    EXPECT_NE(shown.find("x 3  y 4  z 30 mm"), std::string::npos) << shown;
}

TEST(Sketch, ShowsWhatIsWhereInPlanView)
{
    station::Record record = station::begin_record(settings());
    record.stage = Stage::touch;
    record.touches = {{-10, 25, 5}, {25, -10, core::kNaN}};
    const std::vector<std::string> lines = station::sketch({record, nullptr, Eigen::Vector2d(5, 5)}, 41, 21);
    ASSERT_EQ(lines.size(), 21u);
    const auto at = [&](double x, double y) { // 50 mm over 40 characters and 20 lines, from (-20, 30)
        const std::string& line = lines[std::size_t(std::lround((30 - y) / 2.5))];
        const auto column = std::size_t(std::lround((x + 20) / 1.25));
        return column < line.size() ? line[column] : ' ';
    };
    EXPECT_EQ(at(-20, -20), '.');
    EXPECT_EQ(at(30, 30), '.');
    EXPECT_EQ(at(0, 0), '#');
    EXPECT_EQ(at(5, 0), '#');
    EXPECT_EQ(at(5, 5), '+');
    EXPECT_EQ(at(-10, 25), 'o');
    EXPECT_EQ(at(25, -10), 'x');
    EXPECT_EQ(at(-10, -10), ' ');
}

// By hand: four passes of 100 mm at 10 mm/s.
TEST(Forecast, TakesThePaceOfWhatIsDoneAndAtLeastTheFeed)
{
    plan::Plan plan;
    plan.job.feed.rate = 10;
    for (int i = 0; i < 4; ++i) plan.passes.push_back({double(i), {{0, 60}, {60, 100}}});
    station::Forecast forecast(plan);
    EXPECT_DOUBLE_EQ(forecast.time_left(), 40);
    const auto row = [&](double time, int layer, int pass, strategy::Event event = strategy::Event::none) {
        strategy::TraceRow at;
        at.time = time, at.layer = layer, at.pass = pass, at.event = event;
        forecast.follow(at);
    };
    row(10, 1, 1, strategy::Event::start);
    row(15, 1, 2); // half as long as at the feed
    EXPECT_DOUBLE_EQ(forecast.time_left(), 30);
    row(110, 3, 4); // above layer 1 a pass is not done
    row(110, 1, 3);
    EXPECT_DOUBLE_EQ(forecast.time_left(), 100);
    row(200, 1, 1, strategy::Event::covering_done);
    EXPECT_DOUBLE_EQ(forecast.time_left(), 40);
}

TEST(Folder, IsUsedByOneSession)
{
    const OwnFolder own;
    const station::Folder folder("session");
    EXPECT_THROW(station::Folder("session"), core::InputError);
    EXPECT_THROW(station::Folder("missing/session"), core::InputError);
    std::ofstream("file") << "";
    EXPECT_THROW(station::Folder("file"), core::InputError);
    EXPECT_FALSE(folder.has("a"));
    folder.save("a", [](std::ostream& out) { out << "text"; });
    EXPECT_EQ(core::read_file(folder.file("a")), "text");
}

TEST(Checkpoint, NeedsATraceThatSaysItsRun)
{
    const OwnFolder own;
    EXPECT_THROW(station::Checkpoint("nowhere.pcd"), core::InputError);
    const strategy::TraceFile journal("trace.pcd", {}, cloud::PcdEncoding::binary, {{.time = 1}});
    const std::string bytes = core::read_file("trace.pcd");
    std::ofstream("plain.pcd") << bytes.substr(bytes.find("VERSION")); // without its comments
    try {
        strategy::read_recorded_trace("plain.pcd", {}, {.rows = 1, .digest = "0123456789abcdef"});
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_STREQ(error.what(), "plain.pcd: does not say which run wrote it");
    }
}

// After a power failure the header of a trace may be newer than its rows: zeros where rows were not written yet.
TEST(Checkpoint, KeepsWhatIsOnTheDisk)
{
    const OwnFolder own;
    const units::Units units;
    const strategy::RunIdentity identity{{{"job", "0123456789abcdef"}}};
    strategy::TraceFile journal("trace.pcd", units, cloud::PcdEncoding::binary, {}, identity);
    const auto append = [&](int from, int to) {
        for (int i = from; i < to; ++i) {
            strategy::TraceRow row;
            row.time = i;
            journal.begin_row(row);
            journal.complete_row(row);
        }
    };
    {
        station::Checkpoint checkpoint("trace.pcd");
        append(0, 500);
        checkpoint.follow(journal);
    } // its thread has ended
    append(500, 1000);
    EXPECT_EQ(station::read_trace_or_checkpoint("trace.pcd", units).rows.size(), 1000u);
    std::string bytes = core::read_file("trace.pcd");
    const std::size_t lost = bytes.size() / 4;
    bytes.replace(bytes.size() - lost, lost, lost, '\0');
    std::ofstream("trace.pcd") << bytes;
    EXPECT_THROW(strategy::read_recorded_trace("trace.pcd", units), core::InputError);
    const strategy::RecordedTrace kept = station::read_trace_or_checkpoint("trace.pcd", units);
    ASSERT_EQ(kept.rows.size(), 500u);
    EXPECT_EQ(kept.rows.back().time, 499);
    EXPECT_EQ(kept.identity.parts, identity.parts);
    EXPECT_FALSE(kept.cut.empty());
    // A digest that is none.
    const std::string checkpoint = core::read_file("trace.pcd.checkpoint");
    std::ofstream("trace.pcd.checkpoint") << "500 0123456789abcde\n";
    try {
        station::read_trace_or_checkpoint("trace.pcd", units);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_STREQ(error.what(), "trace.pcd.checkpoint: is no checkpoint of a trace");
    }
    std::ofstream("trace.pcd.checkpoint") << checkpoint;
    // What is lost beyond the checkpoint is lost.
    bytes.replace(bytes.size() / 4, bytes.size() / 2, bytes.size() / 2, '\0');
    std::ofstream("trace.pcd") << bytes;
    EXPECT_THROW(station::read_trace_or_checkpoint("trace.pcd", units), core::InputError);
    std::ofstream("trace.pcd.checkpoint") << "nonsense";
    EXPECT_THROW(station::read_trace_or_checkpoint("trace.pcd", units), core::InputError);
}

} // namespace station_test
} // namespace fettle
