#include "gantry_stock.h"
#include "own_folder.h"

#include "core/descriptor.h"
#include "core/error.h"
#include "core/file.h"
#include "strategy/joystick.h"
#include "strategy/keys.h"
#include "strategy/layer_switching.h"
#include "strategy/run.h"
#include "strategy/steering.h"
#include "strategy/trace.h"
#include "strategy/trace_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <sys/resource.h>
#include <utility>
#include <vector>

namespace fettle {
namespace strategy_test {

using Kind = strategy::Action::Kind;

constexpr double kMin = 5, kDown = 10, kMax = 15;

// `count` lines one apart, each with places 0, 1, … `points` - 1.
std::vector<plan::ToolPass> square(int count, int points, double spacing = 1)
{
    std::vector<plan::ToolPass> passes(static_cast<std::size_t>(count));
    for (int p = 0; p < count; ++p) {
        plan::ToolPass& pass = passes[static_cast<std::size_t>(p)];
        pass.line = p * spacing;
        pass.starts = {0};
        for (int i = 0; i < points; ++i) pass.along.push_back(i);
    }
    return passes;
}

strategy::LayerSwitching::Settings settings()
{
    strategy::LayerSwitching::Settings s;
    s.force_min = kMin, s.force_down = kDown, s.force_max = kMax;
    s.step_over = 1;
    s.max_remaining = 0.1;
    s.bounds = {.layers = 5, .re_cuts = 3, .coverings = 3, .time = 1000, .steps = 1000};
    return s;
}

// Forces in, what was decided out: "event layer pass.point".
class Script {
  public:
    explicit Script(std::vector<plan::ToolPass> passes, strategy::LayerSwitching::Settings s = settings(),
                    strategy::ForcePredictions predictions = {})
        : passes_(std::move(passes)), strategy_(passes_, s, std::move(predictions)), action_(strategy_.first())
    {
    }

    std::string force(double f, double remaining = 0)
    {
        action_ = strategy_.next({f, remaining, time_});
        time_ += 1;
        return command_text();
    }
    // Reports a force n times. @return  the last decision
    std::string forces(double f, int n)
    {
        std::string last;
        for (int i = 0; i < n; ++i) last = force(f);
        return last;
    }
    std::string command_text() const
    {
        static const char* names[] = {"go",      "start",  "up",       "down", "step-over",
                                      "cut-end", "re-cut", "covering", "done", "bound"};
        return std::string(names[int(action_.event)]) + " " + std::to_string(action_.layer) + " " +
               std::to_string(action_.to.pass) + "." + std::to_string(action_.to.point);
    }
    Kind kind() const { return action_.kind; }
    const strategy::LayerSwitching& strategy() const { return strategy_; }

  private:
    std::vector<plan::ToolPass> passes_;
    strategy::LayerSwitching strategy_;
    strategy::Action action_;
    double time_ = 0;
};

TEST(LayerSwitching, CoversLayer1InZigZagWithoutForce)
{
    Script s(square(2, 3));
    EXPECT_EQ(s.command_text(), "start 1 0.0");
    EXPECT_EQ(s.kind(), Kind::travel);
    EXPECT_EQ(s.force(0), "go 1 0.1");
    EXPECT_EQ(s.kind(), Kind::grind);
    EXPECT_EQ(s.force(0), "go 1 0.2");
    EXPECT_EQ(s.force(0), "step-over 1 1.2");
    EXPECT_EQ(s.force(0), "go 1 1.1");
    EXPECT_EQ(s.force(0), "go 1 1.0");
    EXPECT_EQ(s.force(0), "done 1 1.0");
    EXPECT_EQ(s.kind(), Kind::finish);
    EXPECT_EQ(s.strategy().counts().coverings, 1);
}

TEST(LayerSwitching, CoversLayer1AgainUntilWithinTolerance)
{
    Script s(square(1, 3));
    s.force(14, 0.05);
    s.force(14, 0.11); // the one place above the tolerance
    EXPECT_EQ(s.force(14, 0.05), "covering 1 0.0");
    EXPECT_EQ(s.kind(), Kind::travel);
    s.force(4, 0.1);
    s.force(4, 0.1);
    EXPECT_EQ(s.force(4, 0.1), "done 1 0.2"); // the tolerance itself is within
}

TEST(LayerSwitching, CoversOnlyUnfinishedPassesAgain)
{
    strategy::LayerSwitching::Settings skipping = settings();
    skipping.skip_finished_passes = true;
    Script s(square(4, 2), skipping);
    for (const double remaining : {0.05, 0.1, 0.2, 0.05, 0.1, 0.05, 0.05}) s.force(14, remaining);
    EXPECT_EQ(s.force(14, 0.2), "covering 1 1.0"); // passes 1 and 3 have more than 0.1
    s.force(14, 0.1);
    EXPECT_EQ(s.force(14, 0.1), "step-over 1 3.1");
    s.force(14, 0.1);
    EXPECT_EQ(s.force(14, 0.11), "covering 1 3.0");
    s.force(14, 0.1);
    EXPECT_EQ(s.force(14, 0.1), "done 1 3.1");
    EXPECT_EQ(s.strategy().counts().coverings, 3);
}

// Where the force is expected to stay below F_min a pass is not begun, and one that was begun ends at once.
TEST(LayerSwitching, LeavesOutPassesThatWouldEndTheCut)
{
    double expected = kMin;
    strategy::LayerSwitching::Settings s = settings();
    s.step_over = 2;
    const auto script = [&] {
        return Script(square(5, 9, 2), s, {{}, [&](const std::vector<strategy::PathIndex>& points, int layer) {
                                               EXPECT_EQ(layer, 2);
                                               EXPECT_LE(points.size(), 3U); // no longer than the step-over
                                               return expected;
                                           }});
    };
    Script begun = script();
    EXPECT_EQ(begun.force(16), "up 2 0.0");
    begun.force(9);
    EXPECT_EQ(begun.force(9), "go 2 0.2");
    EXPECT_EQ(begun.force(4), "step-over 2 1.2");
    EXPECT_EQ(begun.force(4), "go 2 1.1"); // F_min may come yet
    expected = 0.9 * kMin;
    EXPECT_EQ(begun.force(4), "cut-end 2 1.1");

    Script left_out = script();
    left_out.force(16);
    left_out.force(9);
    EXPECT_EQ(left_out.force(4), "cut-end 2 0.1");
    EXPECT_EQ(left_out.force(0), "down 1 0.0");
}

TEST(LayerSwitching, TravelsOverAGapInLayer1)
{
    std::vector<plan::ToolPass> passes = square(2, 4);
    for (plan::ToolPass& pass : passes) pass.starts = {0, 2};
    Script s(passes);
    s.force(0);
    EXPECT_EQ(s.force(0), "go 1 0.2");
    EXPECT_EQ(s.kind(), Kind::travel);
    EXPECT_EQ(s.force(0), "go 1 0.3");
    EXPECT_EQ(s.kind(), Kind::grind);
    s.force(0); // 1.3
    s.force(0); // 1.2
    EXPECT_EQ(s.force(0), "go 1 1.1");
    EXPECT_EQ(s.kind(), Kind::travel);
}

TEST(LayerSwitching, ExactlyTheLargestForceIsInRange)
{
    Script s(square(1, 3));
    EXPECT_EQ(s.force(kMax), "go 1 0.1");
    EXPECT_EQ(s.force(std::nextafter(kMax, 100)), "up 2 0.1");
    EXPECT_EQ(s.kind(), Kind::lift);
}

// Wang 2007, fig. 5-6: up at A, passes until C, F_a below F_down: down to A' and on.
TEST(LayerSwitching, GoesUpCutsAndComesDownWhereItLeft)
{
    Script s(square(4, 6));
    s.force(0);
    EXPECT_EQ(s.force(0), "go 1 0.2");
    EXPECT_EQ(s.force(16), "up 2 0.2");
    EXPECT_EQ(s.force(9), "go 2 0.3");
    EXPECT_EQ(s.force(9), "go 2 0.4");
    EXPECT_EQ(s.force(4), "step-over 2 1.4"); // the pass ends
    EXPECT_EQ(s.force(8), "go 2 1.3");        // and turns
    EXPECT_EQ(s.force(8), "go 2 1.2");
    EXPECT_EQ(s.force(4.9), "step-over 2 2.2");
    EXPECT_EQ(s.force(4), "go 2 2.3"); // the beginning of the pass, one step-over long, has no metal
    EXPECT_EQ(s.force(4), "cut-end 2 2.3");
    EXPECT_EQ(s.kind(), Kind::stay);
    EXPECT_EQ(s.force(4), "down 1 0.2");
    EXPECT_EQ(s.kind(), Kind::travel);
    EXPECT_EQ(s.force(12), "go 1 0.3"); // on, in the direction it had
    EXPECT_EQ(s.strategy().direction(), 1);
}

TEST(LayerSwitching, ComesDownInTheDirectionItHadOnAWayBack)
{
    Script s(square(3, 4));
    s.forces(0, 5); // 0.1 0.2 0.3 1.3 1.2
    EXPECT_EQ(s.force(16), "up 2 1.2");
    EXPECT_EQ(s.force(4), "step-over 2 2.2");
    s.force(4);
    EXPECT_EQ(s.force(4), "cut-end 2 2.3");
    EXPECT_EQ(s.force(4), "down 1 1.2");
    EXPECT_EQ(s.force(0), "go 1 1.1");
}

TEST(LayerSwitching, FollowsMetalThatBeginsWithinTheStepOver)
{
    Script s(square(3, 6));
    s.forces(0, 2);
    s.force(16); // up at 0.2
    s.force(9);  // 0.3
    EXPECT_EQ(s.force(4), "step-over 2 1.3");
    EXPECT_EQ(s.force(4), "go 2 1.2");        // still the beginning
    EXPECT_EQ(s.force(6), "go 2 1.1");        // metal
    EXPECT_EQ(s.force(4), "step-over 2 2.1"); // the end of a pass, not of the cut
}

TEST(LayerSwitching, CutsAgainFromWhereTheLayerWasEntered)
{
    Script s(square(3, 6));
    s.forces(0, 2);
    EXPECT_EQ(s.force(16), "up 2 0.2");
    s.force(11); // F_a
    EXPECT_EQ(s.force(4), "step-over 2 1.3");
    s.force(4);
    s.force(4); // cut end
    EXPECT_EQ(s.force(4), "re-cut 2 0.2");
    EXPECT_EQ(s.kind(), Kind::travel);
    EXPECT_EQ(s.force(10), "go 2 0.3"); // F_a = F_down now: not above
    EXPECT_EQ(s.force(4), "step-over 2 1.3");
    s.force(4);
    EXPECT_EQ(s.force(4), "cut-end 2 1.2");
    EXPECT_EQ(s.force(4), "down 1 0.2");
    EXPECT_EQ(s.strategy().counts().re_cuts, 1);
}

TEST(LayerSwitching, EndsTheCutAtTheLastLineOfB)
{
    Script s(square(2, 4));
    s.forces(0, 4); // 0.1 0.2 0.3 1.3
    EXPECT_EQ(s.force(16), "up 2 1.3");
    s.force(9);
    s.force(9);
    s.force(9);                             // 1.0, the boundary
    EXPECT_EQ(s.force(9), "cut-end 2 1.0"); // nothing beyond the last line
}

TEST(LayerSwitching, EndsAPassAtTheBoundaryAndClampsTheStepOverToB)
{
    std::vector<plan::ToolPass> passes = square(3, 6);
    passes[1].along = {0, 1, 2}; // B is narrower there
    Script s(passes);
    s.forces(0, 3);
    EXPECT_EQ(s.force(16), "up 2 0.3");
    s.force(9);
    EXPECT_EQ(s.force(9), "go 2 0.5");
    EXPECT_EQ(s.force(9), "step-over 2 1.2");
}

TEST(LayerSwitching, NestedRaisesComeDownOneByOne)
{
    Script s(square(4, 8));
    s.forces(0, 2);
    EXPECT_EQ(s.force(16), "up 2 0.2");
    s.force(9);
    EXPECT_EQ(s.force(9), "go 2 0.4");
    EXPECT_EQ(s.force(17), "up 3 0.4");
    EXPECT_EQ(s.force(16), "up 4 0.4"); // twice at the same place
    EXPECT_EQ(s.force(8), "go 4 0.5");
    EXPECT_EQ(s.force(4), "step-over 4 1.5");
    EXPECT_EQ(s.force(16), "up 5 1.5"); // at the beginning of a pass
    EXPECT_EQ(s.force(4), "step-over 5 2.5");
    s.force(4);
    EXPECT_EQ(s.force(4), "cut-end 5 2.6");
    EXPECT_EQ(s.force(4), "down 4 1.5");
    EXPECT_EQ(s.force(9), "go 4 1.4"); // backwards, as it was going
    EXPECT_EQ(s.force(4), "step-over 4 2.4");
    s.force(4);
    s.force(4);
    EXPECT_EQ(s.force(4), "re-cut 4 0.4"); // the 16 N belonged to this cut
    s.force(4);
    EXPECT_EQ(s.force(4), "cut-end 4 0.5");
    EXPECT_EQ(s.force(4), "down 3 0.4");
    s.force(9);
    EXPECT_EQ(s.force(4), "step-over 3 1.5");
    s.force(4);
    s.force(4);
    EXPECT_EQ(s.force(4), "re-cut 3 0.4");
    s.force(4);
    s.force(4);
    EXPECT_EQ(s.force(4), "down 2 0.4");
    EXPECT_EQ(s.force(9), "go 2 0.5");
    EXPECT_EQ(s.strategy().counts().highest_layer, 5);
    EXPECT_EQ(s.strategy().counts().raises, 4);
}

TEST(LayerSwitching, PassesOverCloseLinesAboveLayer1)
{
    strategy::LayerSwitching::Settings fine = settings();
    fine.step_over = 2;
    Script s(square(5, 4), fine);
    s.force(16);
    s.force(9);
    s.force(9);
    s.force(9);
    EXPECT_EQ(s.force(9), "step-over 2 2.3");
}

TEST(LayerSwitching, StartsInsideTheStock)
{
    Script s(square(2, 3));
    EXPECT_EQ(s.force(100), "up 2 0.0");
    EXPECT_EQ(s.force(50), "up 3 0.0");
    EXPECT_EQ(s.force(14), "go 3 0.1");
}

TEST(LayerSwitching, Bounds)
{
    Script layers(square(2, 3));
    layers.forces(100, 4); // up to layer 5
    EXPECT_EQ(layers.force(100), "bound 5 0.0");
    EXPECT_EQ(layers.kind(), Kind::fail);
    EXPECT_NE(layers.strategy().failure().find("layers 5; in layer 5, pass 1"), std::string::npos);

    Script re_cuts(square(1, 2));
    re_cuts.force(16);
    for (int i = 0; i < 3; ++i) {
        re_cuts.forces(14, 1 + (i > 0 ? 1 : 1)); // to the boundary, and the cut's end
        EXPECT_EQ(re_cuts.force(14), "re-cut 2 0.0");
    }
    re_cuts.forces(14, 2);
    EXPECT_EQ(re_cuts.force(14), "bound 2 0.1");
    EXPECT_NE(re_cuts.strategy().failure().find("re-cuts 3"), std::string::npos);

    Script coverings(square(1, 2));
    coverings.force(1, 1);
    EXPECT_EQ(coverings.force(1, 1), "covering 1 0.0");
    coverings.force(1, 1);
    EXPECT_EQ(coverings.force(1, 1), "covering 1 0.0");
    coverings.force(1, 1);
    EXPECT_EQ(coverings.force(1, 1), "bound 1 0.1");
    EXPECT_NE(coverings.strategy().failure().find("coverings of layer 1 3"), std::string::npos);

    strategy::LayerSwitching::Settings finishing = settings();
    finishing.finish_passes = true;
    Script strokes(square(1, 3), finishing);
    int calls = 0;
    for (; strokes.kind() != Kind::fail && calls < 100; ++calls) strokes.force(1, 1);
    EXPECT_EQ(strokes.command_text(), "bound 1 0.0");
    EXPECT_EQ(strokes.strategy().counts().coverings, 0);
    EXPECT_NE(strokes.strategy().failure().find("strokes of a pass 3"), std::string::npos);
    EXPECT_LT(calls, 100);

    strategy::LayerSwitching::Settings few = settings();
    few.bounds.steps = 2;
    Script steps(square(1, 9), few);
    steps.forces(0, 2);
    EXPECT_EQ(steps.force(0), "bound 1 0.2");

    strategy::LayerSwitching::Settings quick = settings();
    quick.bounds.time = 1;
    Script time(square(1, 9), quick);
    time.forces(0, 2);
    EXPECT_EQ(time.force(0), "bound 1 0.2");
    EXPECT_NE(time.strategy().failure().find("time 1 s"), std::string::npos);
}

// --- the runner on a simple machine: columns of stock, a thin wheel, a spring
// -----------------------------------------

// Each place has a height; the tool rests on it and removes a share of the material above the commanded height
// where it begins to move and where it ends.
class ColumnGantry final : public gantry::Gantry {
  public:
    using Heights = std::function<double(double x, double y)>;
    ColumnGantry(const Heights& stock, double stiffness) : stiffness_(stiffness)
    {
        for (int i = 0; i < kColumns; ++i)
            for (int j = 0; j < kColumns; ++j) z_[i][j] = stock(i * kSide, j * kSide);
    }
    gantry::GantryStatus travel(const Eigen::Vector3d& point) override { return move(point, 1); }
    gantry::GantryStatus lift(double z) override { return move({at_.x(), at_.y(), z}, 0.1); }
    gantry::GantryStatus grind(const Eigen::Vector3d& point, double feed) override
    {
        const double duration = (point - at_).norm() / feed;
        for (int end = 0; end < 2; ++end, at_ = point) // where it comes from and where it goes to
            if (column() > point.z()) column() -= kShare * (column() - point.z());
        return move(point, duration);
    }
    double touch_off() override { return radius; }
    void change_wheel() override { radius = new_radius; }
    double probe(const Eigen::Vector2d& /*xy*/, double lowest) override { return lowest; }
    gantry::GantryStatus status() const override { return status_; }

    double highest(const Heights& reference) const
    {
        double max = -1;
        for (int i = 0; i < kColumns; ++i)
            for (int j = 0; j < kColumns; ++j) max = std::max(max, z_[i][j] - reference(i * kSide, j * kSide));
        return max;
    }
    double lowest() const
    {
        double min = 1e9;
        for (const auto& row : z_)
            for (const double z : row) min = std::min(min, z);
        return min;
    }
    double radius = 25.4, new_radius = 25.4;

  private:
    static constexpr int kColumns = 41;
    static constexpr double kSide = 1;
    static constexpr double kShare = 0.2;
    double& column()
    {
        const auto index = [](double c) { return std::clamp(int(std::lround(c / kSide)), 0, kColumns - 1); };
        return z_[index(at_.x())][index(at_.y())];
    }
    gantry::GantryStatus move(const Eigen::Vector3d& point, double duration)
    {
        at_ = point;
        status_.time += duration;
        status_.commanded = point;
        status_.deflection = std::max(0.0, column() - point.z());
        status_.force = stiffness_ * status_.deflection;
        status_.peak_force = status_.force;
        return status_;
    }
    double z_[kColumns][kColumns];
    double stiffness_;
    Eigen::Vector3d at_ = Eigen::Vector3d(0, 0, 50);
    gantry::GantryStatus status_;
};

// B: a square of 40 mm, the desired surface z = 0; lines and places on the columns.
plan::Plan square_plan()
{
    plan::Plan plan;
    plan.job.wheel = {25.4, 1, 12.7};
    plan.job.force = {5, 10, 15, 10, 0};
    plan.job.feed = {'y', 25, 1};
    plan.job.tolerance = 0.1;
    plan.job.surface = job::SurfaceType::plane;
    plan.job.anomaly.resize(3, 4);
    plan.job.anomaly << 0, 40, 40, 0, 0, 0, 40, 40, 0, 0, 0, 0;
    plan.surface.shape = surface::Plane{{0, 0}, 0, {0, 0}};
    plan.layers = plan::compute_layers(plan.job.force); // thickness 1, distance 0.5
    plan.start = Eigen::Vector3d::Zero();
    for (int p = 0; p <= 40; ++p) plan.passes.push_back({double(p), {{0, 40}}});
    plan.bounds.layers = 40;
    return plan;
}

const auto flat = [](double, double) { return 0.0; };

class Figure58Test : public testing::TestWithParam<int> {};

double dome(double x, double y, double cx, double cy, double radius, double height)
{
    const double r2 = ((x - cx) * (x - cx) + (y - cy) * (y - cy)) / (radius * radius);
    return r2 < 1 ? height * (1 - r2) : 0;
}

// Wang 2007, fig. 5-8: a hill of three layers, two hills in one boundary, a moon.
TEST_P(Figure58Test, IsGroundToTheDesiredSurface)
{
    const ColumnGantry::Heights stocks[] = {
        [](double x, double y) { return dome(x, y, 20, 20, 12, 2.6); },
        [](double x, double y) { return std::max(dome(x, y, 10, 12, 7, 3.2), dome(x, y, 28, 27, 9, 2.2)); },
        [](double x, double y) { return dome(x, y, 16, 20, 8, 9) > 0 ? 0.0 : dome(x, y, 20, 20, 14, 4); },
    };
    const plan::Plan plan = square_plan();
    ColumnGantry gantry(stocks[GetParam()], plan.job.force.stiffness);
    const strategy::GrindRun result = strategy::run(plan, gantry);
    EXPECT_TRUE(result.finished) << result.failure;
    EXPECT_LE(gantry.highest(flat), plan.job.tolerance);
    EXPECT_GE(gantry.lowest(), 0);
    EXPECT_GE(result.counts.highest_layer, 3);
    // Every reading of the force in range is ground where it is; the layers end one below the other.
    int layer = 1;
    for (const strategy::TraceRow& row : result.trace) {
        EXPECT_LE(std::abs(row.layer - layer), 1);
        if (row.event == strategy::Event::up)
            EXPECT_EQ(row.layer, layer + 1);
        else if (row.event == strategy::Event::down)
            EXPECT_EQ(row.layer, layer - 1);
        else
            EXPECT_EQ(row.layer, layer);
        layer = row.layer;
    }
    EXPECT_EQ(result.trace.back().event, strategy::Event::finished);
}

INSTANTIATE_TEST_SUITE_P(Wang2007, Figure58Test, testing::Values(0, 1, 2));

TEST(Run, StopsAtABoundAndSaysWhere)
{
    plan::Plan plan = square_plan();
    plan.bounds.layers = 3;
    ColumnGantry gantry([](double x, double y) { return dome(x, y, 20, 20, 12, 9); }, plan.job.force.stiffness);
    const strategy::GrindRun result = strategy::run(plan, gantry);
    EXPECT_FALSE(result.finished);
    EXPECT_NE(result.failure.find("layers 3"), std::string::npos) << result.failure;
    EXPECT_EQ(result.trace.back().event, strategy::Event::limit_reached);
}

TEST(Run, ChangesAWornWheelAndRefusesANewOneThatIsTooSmall)
{
    plan::Plan plan = square_plan();
    ColumnGantry gantry(flat, plan.job.force.stiffness);
    gantry.radius = 12;
    const strategy::GrindRun result = strategy::run(plan, gantry);
    EXPECT_TRUE(result.finished);
    EXPECT_EQ(result.wheel_changes, 1);
    EXPECT_EQ(result.touch_offs, 2);
    EXPECT_EQ(result.wheel_radius, 25.4);

    gantry.radius = gantry.new_radius = 12;
    EXPECT_THROW(strategy::run(plan, gantry), core::InputError);
}

TEST(Run, MeasuresTheWheelOnItsPeriod)
{
    plan::Plan plan = square_plan(); // 41 · 40 mm and 40 step-overs at 25 mm/s: 67.2 s
    ColumnGantry gantry(flat, plan.job.force.stiffness);
    strategy::RunOptions options;
    options.touch_off_period = 20;
    const strategy::GrindRun result = strategy::run(plan, gantry, options);
    EXPECT_EQ(result.touch_offs, 1 + 3);
    // A known wear says by itself when it is measured again: without force it is never.
    options.known_removal = {.removed_volume = 600, .lost_volume = 10, .wear_sigma = 0.04};
    EXPECT_EQ(strategy::run(plan, gantry, options).touch_offs, 1);
}

/// A machine that stops for good at its Nth command, like one whose driver dies.
class FailingGantry final : public gantry::Gantry {
  public:
    FailingGantry(gantry::Gantry& gantry, int commands) : gantry_(gantry), left_(commands) {}

    gantry::GantryStatus travel(const Eigen::Vector3d& p) override { return obey().travel(p); }
    gantry::GantryStatus grind(const Eigen::Vector3d& p, double feed) override
    {
        ground = obey().grind(p, feed).time;
        return gantry_.status();
    }
    gantry::GantryStatus lift(double z) override { return obey().lift(z); }
    double touch_off() override { return obey().touch_off(); }
    void change_wheel() override { obey().change_wheel(); }
    double probe(const Eigen::Vector2d& xy, double lowest) override { return gantry_.probe(xy, lowest); }
    gantry::GantryStatus status() const override { return gantry_.status(); }
    double ground = 0;
    std::function<void()> before_fault; ///< may be empty

  private:
    gantry::Gantry& obey()
    {
        if (left_-- != 0) return gantry_;
        if (before_fault) before_fault();
        throw gantry::GantryFault("dead");
    }
    gantry::Gantry& gantry_;
    int left_;
};

TEST(Run, GoesOnWhereverItWasCutOff)
{
    // The machine keeps its stock and dies at every seventh command; every time the run goes on from its trace. In the
    // end the same has been done as without: the rows other than touch-offs and returns are the same, but for the
    // readings, and the ground surface is the same within a step's repetition.
    const auto hills = [](double x, double y) {
        return std::max(dome(x, y, 10, 12, 7, 3.2), dome(x, y, 28, 27, 9, 2.2));
    };
    const plan::Plan plan = square_plan();
    ColumnGantry undisturbed(hills, plan.job.force.stiffness), mortal(hills, plan.job.force.stiffness);
    const strategy::GrindRun whole = strategy::run(plan, undisturbed);
    ASSERT_TRUE(whole.finished);

    strategy::RunOptions options;
    int interruptions = 0;
    for (int commands = 700;; ++interruptions) {
        FailingGantry gantry(mortal, commands);
        const strategy::GrindRun part = strategy::run(plan, gantry, options);
        if (part.finished) {
            EXPECT_EQ(part.counts.highest_layer, whole.counts.highest_layer);
            EXPECT_NEAR(part.counts.steps, whole.counts.steps, 0.05 * whole.counts.steps);
            EXPECT_LE(mortal.highest(flat), plan.job.tolerance);
            break;
        }
        ASSERT_LT(interruptions, 100);
        EXPECT_EQ(part.trace.back().event, strategy::Event::fault);
        ASSERT_GT(part.trace.size(), options.previous_trace.size());
        for (std::size_t n = 0; n < options.previous_trace.size(); ++n) // what was done is not done again
            ASSERT_EQ(part.trace[n].time, options.previous_trace[n].time) << n;
        for (std::size_t n = 1; n < part.trace.size(); ++n) ASSERT_GE(part.trace[n].time, part.trace[n - 1].time) << n;
        options.previous_trace = part.trace;
        options.previous_trace.pop_back();
    }
    EXPECT_GT(interruptions, 3);
}

// As FailingGantry, but it is the operator who stops it.
class InterruptedGantry final : public gantry::Gantry {
  public:
    InterruptedGantry(gantry::Gantry& gantry, int commands) : gantry_(gantry), left_(commands) {}

    gantry::GantryStatus travel(const Eigen::Vector3d& p) override { return obey().travel(p); }
    gantry::GantryStatus grind(const Eigen::Vector3d& p, double feed) override { return obey().grind(p, feed); }
    gantry::GantryStatus lift(double z) override { return obey().lift(z); }
    double touch_off() override { return obey().touch_off(); }
    void change_wheel() override { obey().change_wheel(); }
    double probe(const Eigen::Vector2d& xy, double lowest) override { return gantry_.probe(xy, lowest); }
    gantry::GantryStatus status() const override { return gantry_.status(); }
    bool dies = false; ///< when it is to be lifted off

  private:
    gantry::Gantry& obey()
    {
        if (left_-- == 0) throw gantry::Interrupted();
        if (dies && left_ < 0) throw gantry::GantryFault("dead");
        return gantry_;
    }
    gantry::Gantry& gantry_;
    int left_;
};

// Stopped at every 500th command: the wheel is lifted off and then to the safe height, with a row for each. Each time
// the work goes on, and in the end all is done.
TEST(Run, IsStoppedByTheOperatorAndGoesOn)
{
    const auto hill = [](double x, double y) { return dome(x, y, 20, 20, 9, 2); };
    const plan::Plan plan = square_plan();
    ColumnGantry machine(hill, plan.job.force.stiffness);
    strategy::RunOptions options;
    std::size_t seen = 0;
    options.watch = [&](const strategy::TraceRow& /*row*/) { ++seen; };
    int stops = 0;
    for (int commands = 500;; ++stops) {
        InterruptedGantry gantry(machine, commands);
        seen = 0;
        const strategy::GrindRun part = strategy::run(plan, gantry, options);
        EXPECT_FALSE(part.finished && part.stopped);
        if (part.finished) break;
        ASSERT_LT(stops, 100);
        ASSERT_TRUE(part.stopped) << part.failure;
        EXPECT_EQ(part.failure, "stopped by the operator");
        EXPECT_GT(seen, 0u);
        const strategy::TraceRow &free = part.trace.end()[-2], &safe = part.trace.back();
        EXPECT_EQ(free.event, strategy::Event::stopped);
        EXPECT_EQ(free.force, 0);
        EXPECT_EQ(free.feed, 0);
        EXPECT_EQ(safe.event, strategy::Event::stopped);
        EXPECT_FLOAT_EQ(float(safe.tool.z()), float(plan.job.safe_height)); // the trace holds floats
        options.previous_trace = part.trace;
        options.previous_trace.resize(part.trace.size() - 2);
    }
    EXPECT_GT(stops, 3);
    EXPECT_LE(machine.highest(flat), plan.job.tolerance);
}

TEST(Run, IsStoppedByTheOperatorAndFailsOnTheWayUp)
{
    const plan::Plan plan = square_plan();
    ColumnGantry machine(flat, plan.job.force.stiffness);
    InterruptedGantry gantry(machine, 10);
    gantry.dies = true;
    const strategy::GrindRun run = strategy::run(plan, gantry);
    EXPECT_TRUE(run.faulted);
    EXPECT_FALSE(run.stopped);
    EXPECT_EQ(run.failure, "dead");
    EXPECT_EQ(run.trace.back().event, strategy::Event::fault);
}

// What has failed is the machine: a disk that is full by then is not said instead.
TEST(Run, SaysTheFaultThatItsJournalHasNoRoomFor)
{
    const OwnFolder folder;
    std::signal(SIGXFSZ, SIG_IGN); // as the tools do
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const plan::Plan plan = square_plan();
    ColumnGantry machine(flat, plan.job.force.stiffness);
    FailingGantry gantry(machine, 10);
    gantry.before_fault = [&before] {
        const rlimit none{0, before.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &none);
    };
    strategy::TraceFile journal("trace.pcd", {}, cloud::PcdEncoding::ascii, {});
    strategy::RunOptions options;
    options.journal = &journal;
    const strategy::GrindRun run = strategy::run(plan, gantry, options);
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    EXPECT_TRUE(run.faulted);
    EXPECT_EQ(run.failure, "dead");
    EXPECT_EQ(run.trace.back().event, strategy::Event::fault);
    EXPECT_TRUE(journal.has_failed());
    EXPECT_EQ(strategy::read_trace("trace.pcd", {}).size() + 1, run.trace.size());
}

// Between the measurement of a worn wheel and the first move: measured, changed, measured.
TEST(Run, GoesOnInTheMiddleOfAChangeOfTheWheel)
{
    const plan::Plan plan = square_plan();
    for (const int commands : {1, 2, 3}) {
        ColumnGantry gantry(flat, plan.job.force.stiffness);
        gantry.radius = 12;
        FailingGantry mortal(gantry, commands);
        strategy::RunOptions options;
        options.previous_trace = strategy::run(plan, mortal).trace;
        options.previous_trace.pop_back();
        ASSERT_EQ(int(options.previous_trace.size()), commands);
        const strategy::GrindRun result = strategy::run(plan, gantry, options);
        EXPECT_TRUE(result.finished) << commands;
        EXPECT_EQ(result.wheel_changes, 1) << commands;
        EXPECT_EQ(result.wheel_radius, 25.4) << commands;
        EXPECT_EQ(gantry.radius, 25.4) << commands;
    }
}

TEST(Run, RefusesToGoOnWithAnotherRun)
{
    plan::Plan plan = square_plan();
    ColumnGantry gantry(flat, plan.job.force.stiffness);
    strategy::RunOptions options;
    options.previous_trace = strategy::run(plan, gantry).trace;
    plan.passes.erase(plan.passes.begin() + 20);
    EXPECT_THROW(strategy::run(plan, gantry, options), core::InputError);
}

// By the kernel's description: axis 0 to the right, axis 1 towards the operator, 32767 at full deflection; buttons from
// 0.
TEST(Joystick, MovesTheStick)
{
    using strategy::Button;
    strategy::Stick stick;
    const auto event = [&](int type, int number, int value) {
        js_event e = {};
        e.type = static_cast<__u8>(type), e.number = static_cast<__u8>(number), e.value = static_cast<__s16>(value);
        strategy::apply_event(e, stick);
    };
    event(JS_EVENT_AXIS | JS_EVENT_INIT, 0, 32767);
    event(JS_EVENT_AXIS, 1, -32767);
    event(JS_EVENT_AXIS, 2, 20000); // a throttle
    EXPECT_EQ(stick.direction, Eigen::Vector2d(1, 1));
    event(JS_EVENT_AXIS, 0, 3000); // at rest, but for the springs
    event(JS_EVENT_AXIS, 1, 3300);
    EXPECT_EQ(stick.direction.x(), 0);
    EXPECT_NEAR(stick.direction.y(), -0.1, 1e-3);
    EXPECT_TRUE(stick.on_part);
    event(JS_EVENT_BUTTON | JS_EVENT_INIT, 0, 1);
    EXPECT_FALSE(stick.on_part);
    event(JS_EVENT_BUTTON, 0, 0);
    EXPECT_TRUE(stick.on_part);
    for (int button = 1; button <= 3; ++button) {
        event(JS_EVENT_BUTTON | JS_EVENT_INIT, button, 1);
        event(JS_EVENT_BUTTON, button, 0);
    }
    EXPECT_EQ(stick.button, strategy::Button::none);
    EXPECT_FALSE(stick.end);
    event(JS_EVENT_BUTTON, 2, 1);
    EXPECT_EQ(stick.button, strategy::Button::record);
    event(JS_EVENT_BUTTON, 3, 1);
    EXPECT_EQ(stick.button, strategy::Button::next);
    const Button rest[] = {Button::stop, Button::start,     Button::automatic, Button::manual,
                           Button::back, Button::turn_left, Button::turn_right};
    for (int button = 4; button <= 10; ++button) {
        event(JS_EVENT_BUTTON, button, 1);
        EXPECT_EQ(stick.button, rest[button - 4]);
    }
    event(JS_EVENT_BUTTON, 11, 1); // there is no such button
    EXPECT_EQ(stick.button, Button::turn_right);
    event(JS_EVENT_BUTTON, 1, 1);
    EXPECT_TRUE(stick.end);
}

TEST(Steering, SeesAStopWhileTheMachineWorks)
{
    const OwnFolder own;
    std::ofstream("steer.txt") << "0 start\n5 1 0\n6 record\n7 stop\n7 automatic\n8 end\n";
    strategy::Steering steering("steer.txt");
    EXPECT_EQ(steering.at(0).button, strategy::Button::start);
    EXPECT_FALSE(steering.stop_due(0));
    EXPECT_FALSE(steering.stop_due(5.5)); // the stick was moved
    EXPECT_FALSE(steering.stop_due(7.5)); // a button before it waits to be reported
    EXPECT_EQ(steering.at(7.5).button, strategy::Button::record);
    EXPECT_FALSE(steering.stop_due(6.9));
    EXPECT_TRUE(steering.stop_due(7));
    EXPECT_TRUE(steering.stop_due(8));
    EXPECT_EQ(steering.at(8).button, strategy::Button::stop);
    EXPECT_FALSE(steering.stop_due(8));
    EXPECT_EQ(steering.at(8).button, strategy::Button::automatic);
    EXPECT_FALSE(steering.stop_due(9)); // the end of the text is no stop
    EXPECT_TRUE(steering.at(9).end);
    EXPECT_TRUE(steering.at(9).end);
    EXPECT_THROW(strategy::Steering("steer.txt", "/dev/null"), core::InputError);
}

/// Both ends of a terminal: what is written to the first is typed at the other.
struct Terminal {
    Terminal() : keyboard(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC))
    {
        if (!keyboard.is_open() || ::grantpt(keyboard.get()) != 0 || ::unlockpt(keyboard.get()) != 0) return;
        path = ::ptsname(keyboard.get());
        screen = core::FileDescriptor(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    }
    core::FileDescriptor keyboard, screen;
    std::string path; ///< of the screen
};

TEST(Keys, PushTheButtonsInTheOrderInWhichTheyAreTyped)
{
    using strategy::Button;
    const Terminal terminal;
    if (!terminal.screen.is_open()) GTEST_SKIP() << "there are no pseudo-terminals";
    strategy::Keys keys(terminal.screen.get());
    ASSERT_TRUE(core::write_all(terminal.keyboard, "rnb\b\n am[]x"));
    const Button buttons[] = {Button::record, Button::next,      Button::back,   Button::back,      Button::start,
                              Button::stop,   Button::automatic, Button::manual, Button::turn_left, Button::turn_right};
    EXPECT_TRUE(keys.has_stop());
    for (const Button button : buttons) {
        strategy::Stick stick;
        keys.update(0, stick);
        EXPECT_EQ(stick.button, button);
    }
    strategy::Stick stick;
    keys.update(0, stick);
    EXPECT_EQ(stick.button, Button::none);
    EXPECT_FALSE(keys.has_stop());
    EXPECT_FALSE(stick.end);
}

TEST(Steering, RefusesWhatIsNoJoystickBesideTheKeys)
{
    const Terminal terminal;
    if (!terminal.screen.is_open()) GTEST_SKIP() << "there are no pseudo-terminals";
    for (const auto& [joystick, message] : {std::pair("/no/joystick", "/no/joystick: cannot open: "),
                                            std::pair("/dev/null", "/dev/null: is no joystick")})
        try {
            strategy::Steering(terminal.path, joystick);
            ADD_FAILURE() << joystick;
        } catch (const core::InputError& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with(message)) << error.what();
        }
}

TEST(Trace, RefusesEventsThatThereAreNot)
{
    const std::vector<strategy::TraceRow> rows = {{.layer = 1, .pass = 1}, {.time = 1, .layer = 1, .pass = 1}};
    cloud::Cloud cloud = strategy::to_cloud(rows);
    EXPECT_EQ(strategy::trace_from_cloud(cloud, "trace").size(), 2u);
    cloud::set_field(cloud, "event", Eigen::Vector2d(0, 99));
    try {
        strategy::trace_from_cloud(cloud, "trace");
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_STREQ(error.what(), "trace: event 99 of point 2 is not an event of a trace");
    }
}

// A wheel that was measured smaller than the job's leaves a shorter mark. Reference: the chord of its circle.
TEST(Trace, IsReplayedWithTheMeasuredRadius)
{
    constexpr double kDepth = 1, kCell = 0.1;
    const job::Job job = small_job();
    for (const double radius : {0.0, 12.0}) {
        std::vector<strategy::TraceRow> rows(2);
        rows[0].tool = {0, 0, kTop - kDepth};
        rows[1] = {.time = 1, .tool = {0, 0.01, kTop - kDepth}, .feed = 1, .radius = radius};
        const removal::HeightField before = fettle::flat(kCell), after = strategy::replay_removal(rows, job, before);
        const double cut = static_cast<double>((before.z.array() - after.z.array() > 1e-9).count()) * kCell * kCell;
        const double r = radius > 0 ? radius : job.wheel.radius;
        const double chord = 2 * std::sqrt(kDepth * (2 * r - kDepth));
        EXPECT_NEAR(cut / job.wheel.width, chord, 3 * kCell) << radius;
    }
}

TEST(TraceFile, NamesTheFileThatItCannotWrite)
{
    const OwnFolder folder;
    EXPECT_THROW(strategy::TraceFile("no/where", {}, cloud::PcdEncoding::ascii, {}), core::InputError);
    std::filesystem::create_directory("folder");
    EXPECT_THROW(strategy::TraceFile("folder", {}, cloud::PcdEncoding::ascii, {}), core::InputError);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator("."), {}), 1); // it leaves nothing
}

TEST(TraceFile, HoldsEveryRowAtEveryMoment)
{
    const OwnFolder folder;
    const units::Units inches{units::Units::Length::in, units::Units::Force::lbf};
    for (const cloud::PcdEncoding encoding : {cloud::PcdEncoding::ascii, cloud::PcdEncoding::binary}) {
        const std::string path = "trace.pcd";
        const auto row = [](int n) {
            return strategy::TraceRow{.time = n + 0.1,
                                      .tool = {n * 1.7, -n * 0.3, 20},
                                      .layer = 2,
                                      .pass = n,
                                      .event = strategy::Event::none,
                                      .force = 10.3 * n,
                                      .feed = 25.4,
                                      .peak_force = 11.0 * n,
                                      .deflection = 0.01 * n,
                                      .radius = 25};
        };
        strategy::TraceFile file(path, inches, encoding, {row(1)});
        for (int n = 2; n < 30; ++n) {
            strategy::TraceRow begun = row(n);
            begun.event = strategy::Event::in_progress;
            file.begin_row(begun);
            EXPECT_EQ(int(cloud::read_cloud(path, inches).cloud.size()), n);
            EXPECT_EQ(int(strategy::read_trace(path, inches).size()), n - 1);
            file.complete_row(row(n));
            const std::vector<strategy::TraceRow> rows = strategy::read_trace(path, inches);
            ASSERT_EQ(int(rows.size()), n);
            EXPECT_NEAR(rows.back().force, row(n).force, 1e-4);
            EXPECT_EQ(rows.back().time, row(n).time);
            EXPECT_NEAR((rows.back().tool - row(n).tool).norm(), 0, 1e-4);
        }
        // Killed after a row, before its count: the row is passed over.
        std::string bytes = core::read_file(path);
        std::ofstream(path) << bytes << bytes.substr(bytes.size() - 3);
        EXPECT_EQ(strategy::read_trace(path, inches).size(), 29u);
    }
}

// A limit on the file's size cuts a write short at that byte, as SIGKILL does where a page ends: the row that was to be
// replaced is not counted then, and those before it are untouched.
TEST(TraceFile, CountsNoRowThatIsWrittenInPart)
{
    const OwnFolder folder;
    std::signal(SIGXFSZ, SIG_IGN); // as the tools do
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    for (const cloud::PcdEncoding encoding : {cloud::PcdEncoding::ascii, cloud::PcdEncoding::binary}) {
        const std::string path = "trace.pcd";
        strategy::TraceFile file(path, {}, encoding, {{.time = 1.25, .pass = 1, .feed = 25}});
        const rlim_t start = std::filesystem::file_size(path);
        file.begin_row({.time = 1.25, .pass = 2, .event = strategy::Event::in_progress});
        for (rlim_t cut = start + 1; cut < std::filesystem::file_size(path); cut += 3) {
            const rlimit limit{cut, before.rlim_max};
            ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
            EXPECT_THROW(file.complete_row({.time = 2.5, .pass = 2, .feed = 25}), core::InputError);
            ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
            const std::vector<strategy::TraceRow> rows = strategy::read_trace(path, {});
            ASSERT_EQ(rows.size(), 1u);
            EXPECT_EQ(rows[0].time, 1.25);
            EXPECT_EQ(rows[0].pass, 1);
        }
        file.complete_row({.time = 2.5, .pass = 2, .feed = 25}); // there is room again
        EXPECT_EQ(strategy::read_trace(path, {}).size(), 2u);
    }
}

} // namespace strategy_test
} // namespace fettle
