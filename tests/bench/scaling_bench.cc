// What a second thread gains of the long work of five tools, without reading and writing: one thread and two in turn,
// so that their ratio tells something on a busy machine too.
//   one_ms, two_ms   the fastest of the iterations, wall clock
//   scaling          one_ms / two_ms

#include "../lib/boat_hull.h"
#include "race.h"

#include "belt/belt_grinding.h"
#include "compare/signed_distance.h"
#include "find/find.h"
#include "machining/cutter.h"
#include "machining/milling.h"
#include "robot/collision.h"
#include "robot/follow.h"

#include <tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace fettle;

namespace {

/// Times the work with one thread and with two. @param prepare  called before each, untimed; what it returns is worked
/// on
template <typename Prepare, typename Work>
void scale(benchmark::State& state, const Prepare& prepare, const Work& work)
{
    double best[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (auto _ : state)
        for (const std::size_t threads : {1, 2}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            auto input = prepare();
            best[threads - 1] = std::min(best[threads - 1], time_of([&] { return work(input); }).wall);
        }
    state.counters["one_ms"] = best[0];
    state.counters["two_ms"] = best[1];
    state.counters["scaling"] = best[0] / best[1];
}

/// Index of 500,000 triangles and the distances of 500,000 points within 0.5 mm of them.
void compare(benchmark::State& state)
{
    const mesh::Mesh hull = boat::hull(500000);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> x(-149, 149), y(-59, 59), off(-0.5, 0.5);
    const Eigen::Matrix3Xd points = Eigen::Matrix3Xd::NullaryExpr(3, 500000, [&](Eigen::Index i, Eigen::Index) {
        return i == 0 ? x(random) : i == 1 ? y(random) : off(random);
    });
    Eigen::Matrix3Xd near = points;
    for (auto p : near.colwise()) p.z() += boat::height(p.x(), p.y());
    scale(
        state, [&] { return hull; },
        [&](mesh::Mesh& mesh) { return compare::Reference(std::move(mesh), {})(near).error.sum(); });
}
BENCHMARK(compare)->Unit(benchmark::kMillisecond)->Iterations(3);

/// A ball of radius 6 mm along waves of 30 mm, 50,000 moves over 10M cells.
void mill(benchmark::State& state)
{
    constexpr double kHalf = 158, kCell = 0.1, kStep = 0.5, kStepOver = 2;
    constexpr int kMoves = 50000;
    const Eigen::AlignedBox2d box(Eigen::Vector2d(-kHalf, -kHalf), Eigen::Vector2d(kHalf, kHalf));
    removal::HeightField stock = removal::empty_height_field(box, {0, 0}, 0, kCell);
    stock.z.setConstant(30);
    const int per_row = static_cast<int>(2 * kHalf / kStep);
    const auto tip = [&](int k) {
        const int row = k / per_row, i = row % 2 == 0 ? k % per_row : per_row - 1 - k % per_row;
        const double x = i * kStep - kHalf, y = row * kStepOver - kHalf;
        return Eigen::Vector3d(x, y, 20 + 2 * std::sin(x / 5) * std::cos(y / 15));
    };
    std::vector<machining::CutterMove> moves(kMoves);
    for (int k = 0; k < kMoves; ++k) {
        const auto i = static_cast<std::size_t>(k);
        moves[i].from = tip(k);
        moves[i].to = tip(k + 1);
        moves[i].feed = 50;
    }
    const machining::Cutter ball = machining::parse_cutter("ball:12");
    scale(
        state, [&] { return stock; },
        [&](removal::HeightField& field) { return machining::mill(field, ball, moves).back().volume; });
}
BENCHMARK(mill)->Unit(benchmark::kMillisecond)->Iterations(3);

/// 200 contacts of a wheel of 200 mm along a bead of 1 mm, surfels 0.2 mm apart.
void belt(benchmark::State& state)
{
    constexpr Eigen::Index kAlong = 700, kAcross = 400;
    constexpr double kSpacing = 0.2;
    constexpr int kContacts = 200;
    belt::Surfels plate;
    plate.position.resize(3, kAlong * kAcross);
    plate.normal.resize(3, kAlong * kAcross);
    plate.displacement.resize(kAlong * kAcross);
    for (Eigen::Index i = 0; i < kAlong * kAcross; ++i) {
        const double x = kSpacing * double(i % kAlong - kAlong / 2), y = kSpacing * double(i / kAlong - kAcross / 2);
        plate.position.col(i) << x, y, 0;
        plate.normal.col(i) << 0, 0, 1;
        plate.displacement[i] = std::exp(-y * y / 9);
    }
    plate.radius = plate.area = Eigen::VectorXd::Zero(plate.size());
    plate.uv = Eigen::Matrix2Xd::Zero(2, plate.size());
    plate.patch = Eigen::VectorXi::Zero(plate.size());
    std::vector<belt::BeltPoint> path(kContacts);
    for (int k = 0; k < kContacts; ++k) {
        belt::BeltPoint& point = path[static_cast<std::size_t>(k)];
        point.T_part_tool = Eigen::Translation3d(0.2 * (k - kContacts / 2), 0, 0);
        point.load.value = 20;
        point.feed = 5;
        point.touches_down = k == 0;
    }
    const belt::ContactWheel wheel = belt::read_contact_wheel("samples/wheels/rubber.json");
    scale(
        state, [&] { return plate; },
        [&](belt::Surfels& surfels) { return belt::grind(surfels, wheel, path, {}).removed_volume; });
}
BENCHMARK(belt)->Unit(benchmark::kMillisecond)->Iterations(3);

/// The cell of samples/robots/irb1400.json along 20,000 poses over a hull of 100,000 triangles, and between them.
void collide(benchmark::State& state)
{
    const Eigen::Vector3d place(1000, 1000, 500);
    const robot::Robot robot = robot::read_robot("samples/robots/irb1400.json");
    mesh::Mesh hull = boat::hull(100000);
    hull.vertices.colwise() += place;
    const robot::Workpiece workpiece(hull);
    cloud::PosePath poses = boat::poses(20000);
    for (Eigen::Isometry3d& T : poses)
        T = Eigen::Translation3d(place) * T * Eigen::Translation3d(0, 0, -boat::kBall) *
            Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()); // the bracket away from the robot
    const robot::ExternalChoice choice = robot::choose_externals(robot, poses, {});
    const robot::CellJointsPath joints =
        robot::follow_path(robot, poses, robot::external_values(robot, poses, choice.track, choice.table)).joints;
    scale(
        state, [] { return 0; }, [&](int) { return robot::check_path(robot, &workpiece, joints, {}).midpoint_count; });
}
BENCHMARK(collide)->Unit(benchmark::kMillisecond)->Iterations(3);

/// A plate of a million points with noise of 0.05 mm and nine bumps.
void find(benchmark::State& state)
{
    constexpr Eigen::Index kAcross = 1000;
    constexpr double kSpacing = 0.2, kNoise = 0.05;
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, kNoise);
    mesh::CloudMesh plate;
    plate.points.xyz.resize(3, kAcross * kAcross);
    for (Eigen::Index i = 0; i < kAcross * kAcross; ++i) {
        const double x = kSpacing * double(i % kAcross), y = kSpacing * double(i / kAcross);
        const double u = std::remainder(x - 100, 60), v = std::remainder(y - 100, 60); // from the nearest bump
        plate.points.xyz.col(i) << x, y, 1e-4 * x * x + 2 * std::exp(-(u * u + v * v) / 16) + noise(random);
    }
    scale(
        state, [] { return 0; }, [&](int) { return static_cast<int>(find::find_anomalies(plate).anomalies.size()); });
}
BENCHMARK(find)->Unit(benchmark::kMillisecond)->Iterations(3);

} // namespace
