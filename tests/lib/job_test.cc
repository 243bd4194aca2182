// Jobs: units, defaults, refusals, and writing as JSON.
#include "job/job.h"

#include "core/error.h"
#include "job/plausible.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fettle {
namespace job_test {

job::Job parse(const std::string& text) { return job::parse_job(json::Reader::parse(text, "job.json")); }

std::string problem(const std::string& text)
{
    try {
        parse(text);
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "accepted";
}

const std::string kSquares = R"("anomaly": [[1,1],[2,1],[2,2],[1,2]], "sampling": [[0,0],[3,0],[3,3],[0,3]])";

std::string inches(const std::string& members)
{
    return R"({"kind": "job", "units": {"length": "in", "force": "lbf"}, "surface": {"type": "freeform"}, )" +
           kSquares + members + "}";
}

TEST(Job, ConvertsEveryNumberToBaseUnits)
{
    const job::Job job = parse(R"({"kind": "job", "units": {"length": "in", "force": "lbf"},
      "frame": {"theta_deg": 90}, "surface": {"type": "swept", "direction_deg": 45},
      "anomaly": [[1,1,0.5],[2,1],[2,2],[1,2]], "sampling": [[0,0,0],[3,0,0],[3,3,0],[0,3,0]],
      "probe": {"accuracy": 0.005, "tip_radius": 0.1}, "tolerance": 0.02, "safe_height": 2,
      "wheel": {"radius": 3, "width": 0.5, "min_radius": 2, "grinding_ratio": 35, "source": "fettle-calibrate"},
      "force": {"min": 20, "down": 40, "max": 60, "stiffness": 200, "preload": 1},
      "feed": {"axis": "x", "rate": 2, "step_over": 0.25}, "removal": {"coefficient": 1e-3}})");
    const double in = 25.4, lbf = 4.4482216152605;
    EXPECT_DOUBLE_EQ(job.theta, std::numbers::pi / 2);
    EXPECT_EQ(job.surface, job::SurfaceType::swept);
    EXPECT_DOUBLE_EQ(job.ruling_direction, std::numbers::pi / 4);
    EXPECT_DOUBLE_EQ(job.anomaly(2, 0), 0.5 * in);
    EXPECT_TRUE(std::isnan(job.anomaly(2, 1)));
    EXPECT_DOUBLE_EQ(job.sampling(0, 2), 3 * in);
    EXPECT_DOUBLE_EQ(job.probe.accuracy, 0.005 * in);
    EXPECT_DOUBLE_EQ(job.probe.tip_radius, 0.1 * in);
    EXPECT_DOUBLE_EQ(job.tolerance, 0.02 * in);
    EXPECT_DOUBLE_EQ(job.safe_height, 2 * in);
    EXPECT_DOUBLE_EQ(job.wheel.min_radius, 2 * in);
    EXPECT_EQ(job.wheel.grinding_ratio, 35);
    EXPECT_EQ(job.wheel.source, "fettle-calibrate");
    EXPECT_DOUBLE_EQ(job.force.down, 40 * lbf);
    EXPECT_DOUBLE_EQ(job.force.stiffness, 200 * lbf / in);
    EXPECT_DOUBLE_EQ(job.feed.rate, 2 * in);
    EXPECT_EQ(job.feed.axis, 'x');
    EXPECT_DOUBLE_EQ(job.removal_coefficient, 1e-3 * in * in * in / lbf);
}

TEST(Job, DefaultsAreTheSamePhysicalOnesInBothUnits)
{
    const job::Job in = parse(R"({"kind": "job", "units": {"length": "in"}, "surface": {"type": "plane"},
      "anomaly": [[0,0],[1,0],[0,1]]})");
    const job::Job mm = parse(R"({"kind": "job", "units": {"length": "mm"}, "surface": {"type": "plane"},
      "anomaly": [[0,0],[1,0],[0,1]]})");
    for (const job::Job& job : {in, mm}) {
        EXPECT_EQ(job.force.down, job::Job().force.down);
        EXPECT_EQ(job.wheel.min_radius, job::Job().wheel.min_radius);
        EXPECT_DOUBLE_EQ(job.feed.step_over, job::Job().feed.step_over);
        EXPECT_EQ(job.safe_height, job::Job().safe_height);
        EXPECT_EQ(job.sampling.cols(), 0);
    }
    // 5/10/15 lbf on 200 lbf/in, 2e-3 in^3/(lbf s), to the digits that the header gives
    EXPECT_NEAR(job::Job().force.max, 15 * 4.44822, 0.01);
    EXPECT_NEAR(job::Job().force.stiffness, 200 * 4.44822 / 25.4, 0.03);
    EXPECT_NEAR(job::Job().removal_coefficient, 2e-3 * 16387.064 / 4.44822, 1e-3);
}

TEST(Job, DefaultsFollowWhatIsGiven)
{
    const job::Job job = parse(inches(R"(, "wheel": {"radius": 2, "width": 0.1}, "force": {"min": 20, "max": 60})"));
    EXPECT_DOUBLE_EQ(job.wheel.min_radius, 25.4);
    EXPECT_DOUBLE_EQ(job.feed.step_over, 0.08 * 25.4);
    EXPECT_DOUBLE_EQ(job.force.down, 40 * 4.4482216152605);
    const job::Job high = parse(R"({"kind": "job", "units": {"length": "mm"}, "surface": {"type": "plane"},
      "anomaly": [[0,0,400],[1,0,401],[0,1]]})");
    EXPECT_DOUBLE_EQ(high.safe_height, 451.8);
}

TEST(Job, ComesBackFromJsonUnchanged)
{
    const std::string text = job::to_json(parse(inches(R"(, "frame": {"theta_deg": 33.3}, "tolerance": 0.0231,
      "force": {"min": 5.1, "down": 9.7, "max": 15.3, "stiffness": 201.7}, "removal": {"coefficient": 0.00217})")))
                                 .text();
    EXPECT_NE(text.find("\"tolerance\": 0.0231,"), std::string::npos) << text;
    EXPECT_NE(text.find("33.3"), std::string::npos) << text;
    EXPECT_EQ(job::to_json(parse(text)).text(), text);
}

TEST(Job, HasAFrameOfItsOwn)
{
    const job::Job job = parse(inches(R"(, "frame": {"position": [1, -2, 0.5], "quaternion": [0.5, 0.5, 0.5, 0.5]})"));
    ASSERT_TRUE(job.T_part_job);
    const Eigen::Vector3d p = *job.T_part_job * Eigen::Vector3d(25.4, 50.8, 76.2); // x to y to z to x
    EXPECT_LT((p - 25.4 * Eigen::Vector3d(1 + 3, -2 + 1, 0.5 + 2)).norm(), 1e-12);
    EXPECT_EQ(job::to_json(parse(job::to_json(job).text())).text(), job::to_json(job).text());
    EXPECT_FALSE(parse(inches(R"(, "frame": {"theta_deg": 5})")).T_part_job);
    EXPECT_EQ(job::to_json(parse(inches(R"(, "frame": {"theta_deg": 5})"))).text().find("quaternion"),
              std::string::npos);
}

TEST(Job, RefusesWithTheKey)
{
    const auto expect = [](const std::string& members, const std::string& message) {
        EXPECT_EQ(problem(inches(members)), "job.json: " + message);
    };
    expect(R"(, "force": {"min": 20, "max": 10})", "force.max: must be above min, 20, got 10");
    expect(R"(, "force": {"min": 5, "down": 16, "max": 15})",
           "force.down: must lie between min and max, 5 and 15, got 16");
    expect(R"(, "force": {"min": 5, "down": 4, "max": 15})",
           "force.down: must lie between min and max, 5 and 15, got 4");
    expect(R"(, "force": {"min": 5, "max": 15, "preload": 15})", "force.preload: must be below max, 15, got 15");
    expect(R"(, "force": {"stiffness": 0})", "force.stiffness: must be positive, got 0");
    expect(R"(, "feed": {"rate": -1})", "feed.rate: must be positive, got -1");
    expect(R"(, "wheel": {"width": 0.25}, "feed": {"step_over": 0.5})",
           "feed.step_over: wider than the wheel, 0.25: 0.5 leaves ridges");
    expect(R"(, "wheel": {"grinding_ratio": 0})", "wheel.grinding_ratio: must be positive, got 0");
    expect(R"(, "wheel": {"radius": 1, "min_radius": 2})", "wheel.min_radius: must be at most the radius, 1, got 2");
    expect(R"(, "tolerance": 0)", "tolerance: must be positive, got 0");
    expect(R"(, "feed": {"axes": "x"})", "feed.axes: unknown key, did you mean \"axis\"?");
    expect(R"(, "anomaly_": 1)", "anomaly_: unknown key, did you mean \"anomaly\"?");
}

TEST(Job, RefusesWrongShapesOfTheFile)
{
    EXPECT_EQ(problem(R"({"kind": "surface"})"), "job.json: kind: expected \"job\", got \"surface\"");
    EXPECT_EQ(problem(R"({"kind": "job"})"), "job.json: units: missing, expected an object");
    EXPECT_EQ(problem(R"({"kind": "job", "units": {"length": "cm"}})"),
              "job.json: units.length: \"cm\" is none of mm, in; did you mean \"mm\"?");
    // a force in no unit must not pass
    EXPECT_EQ(problem(R"({"kind": "job", "units": {"length": "in"}, "force": {"min": 1}})"),
              "job.json: units.force: missing, expected text");
    EXPECT_EQ(problem(R"({"kind": "job", "units": {"length": "in"}, "surface": {"type": "freeform"},
      "anomaly": [[0,0],[1,0],[0,1]]})"),
              "job.json: sampling: missing, expected an array of rows");
    EXPECT_EQ(problem(R"({"kind": "job", "units": {"length": "in"}, "surface": {"type": "plane"},
      "anomaly": [[0,0],[1e30,0],[0,1]]})"),
              "job.json: anomaly[1][0]: no casting reaches that far: 1e+30");
}

TEST(Plausible, BoxInAnotherUnitIsDoubted)
{
    const job::Job job = parse(inches(""));
    const auto doubt = [&](double low, double high) {
        return job::part_box_warning({Eigen::Vector3d(low, low, 0), Eigen::Vector3d(high, high, 10)}, job);
    };
    EXPECT_EQ(doubt(-10, 100), "");
    EXPECT_EQ(doubt(0, 76.2), ""); // the boundary itself
    EXPECT_EQ(doubt(0, 3),
              "the part, 0.11811 x 0.11811 x 0.393701 in, does not contain the job's boundary: is its unit right?");
    EXPECT_EQ(
        doubt(0, 25400),
        "the part, 1000 x 1000 x 0.393701 in, is over 100 times as long as the job's boundary: is its unit right?");
}

TEST(Plausible, TouchesFarFromTheBoundaryPointsAreDoubted)
{
    // B from 1 to 2 in, S from 0 to 3 in: 4.24 in long.
    const std::string taught = R"({"kind": "job", "units": {"length": "in"}, "surface": {"type": "freeform"},
      "anomaly": [[1, 1, 2], [2, 1, 2.5], [2, 2]], "sampling": [[0, 0], [3, 0], [3, 3], [0, 3]]})";
    const auto doubt = [](const std::string& text, double z) {
        return job::touch_height_warning(Eigen::Vector3d(0, 0, z * 25.4), parse(text));
    };
    EXPECT_EQ(doubt(taught, 2.2), "");
    EXPECT_EQ(doubt(taught, 6.7), "");
    EXPECT_EQ(doubt(taught, 7.5),
              "the touches lie 5 in above the job's boundary points: is the part's unit right, does "
              "it lie where the job was taught?");
    EXPECT_NE(doubt(taught, -2.3).find("4.3 in below"), std::string::npos);
    EXPECT_EQ(doubt(taught, std::nan("")), "");
    EXPECT_EQ(doubt(inches(""), 1e3), ""); // no z was taught
}

TEST(Job, WorkingFrameIsTurnedCounterClockwise)
{
    // X_w lies along Y_m when theta is 90 degrees: a point on Y_m has x_w = 1.
    const Eigen::Vector2d w = job::rotation_working_machine(std::numbers::pi / 2) * Eigen::Vector2d(0, 1);
    EXPECT_NEAR(w.x(), 1, 1e-15);
    EXPECT_NEAR(w.y(), 0, 1e-15);
}

} // namespace job_test
} // namespace fettle
