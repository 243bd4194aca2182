// What is written reads back the same, for all formats that the suite both writes and reads: random contents (fixed
// seeds), the numbers of all sizes that their types hold. Files of kinds that are only read (STL as text, OBJ, OFF,
// XYZ, compressed PCD) are written here.

#include "align/rigid.h"
#include "cloud/cloud_writer.h"
#include "cloud/element.h"
#include "cloud/pcd.h"
#include "core/text.h"
#include "gantry/protocol.h"
#include "machining/nc_program.h"
#include "machining/nc_writer.h"
#include "mesh/mesh_file.h"
#include "own_folder.h"
#include "plan/plan.h"
#include "strategy/trace_file.h"
#include "surface/griddata.h"
#include "surface/surface.h"
#include "json/leaves.h"

#include <gtest/gtest.h>
#include <liblzf/lzf.h>

#include <bit>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

namespace fettle {
namespace round_trip_test {

constexpr int kRounds = 40;

class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    std::uint64_t bits() { return engine_(); }
    double between(double min, double max) { return std::uniform_real_distribution<double>(min, max)(engine_); }
    int integer(int min, int max) { return std::uniform_int_distribution<int>(min, max)(engine_); }
    /// A finite number of any size, denormals too.
    template <typename T>
    T finite()
    {
        for (;;) {
            const T value = any<T>();
            if (std::isfinite(value)) return value;
        }
    }
    /// Any bits: NaN and the infinities too.
    template <typename T>
    T any()
    {
        using Bits = std::conditional_t<sizeof(T) == sizeof(std::uint32_t), std::uint32_t, std::uint64_t>;
        return std::bit_cast<T>(static_cast<Bits>(bits()));
    }
    Eigen::VectorXd vector(Eigen::Index size, double min, double max)
    {
        return Eigen::VectorXd::NullaryExpr(size, [&] { return between(min, max); });
    }
    Eigen::Vector3d unit() { return vector(3, -1, 1).head<3>().normalized(); }
    units::Units units()
    {
        return {units::Units::Length(integer(0, 1)), units::Units::Force(integer(0, 1))};
    } // as a job has them

  private:
    std::mt19937_64 engine_;
};

// --- points
// -----------------------------------------------------------------------------------------------------------

void add_field(cloud::Cloud& cloud, const std::string& name, char type, int size, int count, Random& random)
{
    cloud::Field& field = cloud.fields.emplace_back(cloud::Field{name, type, size, count, {}});
    const auto elements = static_cast<std::size_t>(cloud.size()) * static_cast<std::size_t>(count);
    field.bytes.resize(elements * static_cast<std::size_t>(size));
    for (std::size_t i = 0; i < elements; ++i)
        cloud::visit_element(type, size, [&](auto zero) {
            using T = decltype(zero);
            T value{};
            if constexpr (std::is_floating_point_v<T>)
                value = i % 7 == 0 ? std::numeric_limits<T>::quiet_NaN() : random.any<T>();
            else
                value = static_cast<T>(random.bits());
            if (value != value) value = std::numeric_limits<T>::quiet_NaN(); // text has one NaN
            cloud::store(field.bytes.data() + i * sizeof(T), value);
        });
}

cloud::Cloud random_cloud(Random& random)
{
    cloud::Cloud cloud;
    cloud.xyz.resize(3, random.integer(1, 30));
    for (double& coordinate : cloud.xyz.reshaped()) {
        const float any = random.any<float>();
        coordinate = std::isfinite(any) && std::abs(any) > 1e10F ? any * 1e-29F : any; // none is farther than the Earth
    }
    for (const char type : {'I', 'U', 'F'})
        for (const int size : {1, 2, 4, 8})
            if (cloud::is_element_type(type, static_cast<std::size_t>(size)))
                add_field(cloud, type + std::to_string(size), type, size, 1, random);
    return cloud;
}

std::string bytes_of(const cloud::Cloud& cloud)
{
    std::string bytes;
    for (const cloud::Field& field : cloud.fields)
        bytes += field.name + field.type + std::to_string(field.size) + 'x' + std::to_string(field.count) +
                 std::string(reinterpret_cast<const char*>(field.bytes.data()), field.bytes.size());
    return bytes;
}

void expect_same(const cloud::Cloud& a, const cloud::Cloud& b)
{
    ASSERT_EQ(a.size(), b.size());
    EXPECT_TRUE((a.xyz.array() == b.xyz.array() || (a.xyz.array().isNaN() && b.xyz.array().isNaN())).all());
    EXPECT_EQ(bytes_of(a), bytes_of(b));
    EXPECT_EQ(a.view_origin, b.view_origin);
    EXPECT_EQ(a.view_orientation.coeffs(), b.view_orientation.coeffs());
}

std::string as_pcd(const cloud::Cloud& cloud, cloud::PcdEncoding encoding, const units::Units& units = {})
{
    std::ostringstream out;
    cloud::write_pcd(out, cloud, units, encoding);
    return out.str();
}

TEST(RoundTrip, PcdAsNumbersAndText)
{
    Random random(1);
    for (int round = 0; round < kRounds; ++round) {
        cloud::Cloud cloud = random_cloud(random);
        add_field(cloud, "_", 'U', 1, 3, random);
        add_field(cloud, "several", 'F', 4, random.integer(1, 40), random);
        cloud.view_origin = random.vector(3, -1e6, 1e6);
        cloud.view_orientation = Eigen::Quaterniond(random.vector(4, -1, 1).head<4>());
        for (const cloud::PcdEncoding encoding : {cloud::PcdEncoding::binary, cloud::PcdEncoding::ascii})
            expect_same(cloud, cloud::parse_cloud(as_pcd(cloud, encoding), "file").cloud);
    }
}

// Lengths and forces are kept in mm and N: those of a file in inches are rounded twice, and come back all the same.
TEST(RoundTrip, PcdInInchesAndPounds)
{
    const units::Units units{units::Units::Length::in, units::Units::Force::lbf};
    Random random(2);
    for (int round = 0; round < kRounds; ++round) {
        cloud::Cloud cloud;
        cloud.xyz = Eigen::Matrix3Xd::NullaryExpr(3, 20, [&] { return random.between(-1e4, 1e4); });
        for (const char* name : {"error", "radius", "force", "feed", "pressure", "layer"}) {
            cloud::set_field(cloud, name, random.vector(20, -100, 100), round % 2 == 0 ? 4 : 8);
        }
        for (const cloud::PcdEncoding encoding : {cloud::PcdEncoding::binary, cloud::PcdEncoding::ascii}) {
            const std::string file = as_pcd(cloud, encoding, units);
            const cloud::CloudFile read = cloud::parse_cloud(file, "file");
            EXPECT_TRUE(read.units == units);
            EXPECT_EQ(as_pcd(read.cloud, encoding, units), file);
        }
    }
}

TEST(RoundTrip, PcdCompressed)
{
    Random random(3);
    for (int round = 0; round < kRounds; ++round) {
        const cloud::Cloud cloud = random_cloud(random);
        const std::string plain = as_pcd(cloud, cloud::PcdEncoding::binary);
        const std::size_t body = plain.find("DATA binary\n") + 12;
        std::string fields; // one after the other
        const auto points = static_cast<std::size_t>(cloud.size());
        const std::size_t stride = (plain.size() - body) / points;
        std::vector<std::size_t> sizes(3, 4);
        for (const cloud::Field& field : cloud.fields) sizes.push_back(static_cast<std::size_t>(field.size));
        for (std::size_t f = 0, offset = 0; f < sizes.size(); offset += sizes[f++])
            for (std::size_t i = 0; i < points; ++i) fields += plain.substr(body + i * stride + offset, sizes[f]);
        std::string packed(2 * fields.size() + 100, '\0');
        const auto size = lzf_compress(fields.data(), static_cast<unsigned>(fields.size()), packed.data(),
                                       static_cast<unsigned>(packed.size()));
        ASSERT_GT(size, 0u);
        std::string file = plain.substr(0, body - 1) + "_compressed\n";
        for (const std::size_t n : {std::size_t{size}, fields.size()})
            file.append(reinterpret_cast<const char*>(&n), sizeof(std::uint32_t));
        expect_same(cloud, cloud::parse_cloud(file + packed.substr(0, size), "file").cloud);
    }
}

TEST(RoundTrip, Ply)
{
    Random random(4);
    for (int round = 0; round < kRounds; ++round) {
        cloud::Cloud cloud = random_cloud(random);
        std::erase_if(cloud.fields,
                      [](const cloud::Field& field) { return field.type != 'F' && field.size == 8; }); // it has none
        cloud::set_normals(cloud,
                           Eigen::Matrix3Xd::NullaryExpr(3, cloud.size(), [&] { return random.between(-1, 1); }));
        std::ostringstream out;
        cloud::CloudWriter writer(out, cloud::CloudFormat::ply, units::Units{}, static_cast<std::size_t>(cloud.size()));
        writer.write(cloud);
        writer.finish();
        const cloud::Cloud read = cloud::parse_cloud(out.str(), "file").cloud;
        EXPECT_TRUE(cloud::normals(read) == cloud::normals(cloud));
        expect_same(cloud, read);
    }
}

TEST(RoundTrip, Xyz)
{
    Random random(5);
    for (int round = 0; round < kRounds; ++round) {
        const int columns = random.integer(3, 9);
        const Eigen::MatrixXd table =
            Eigen::MatrixXd::NullaryExpr(columns, random.integer(1, 20), [&] { return random.finite<double>(); });
        std::string text;
        cloud::Cloud cloud;
        for (Eigen::Index j = 0; j < table.cols(); ++j)
            for (int i = 0; i < columns; ++i) {
                const double value = i < 3 ? std::fmod(table(i, j), 1e12) : table(i, j);
                text += core::to_text(value) + (i + 1 < columns ? '\t' : '\n');
            }
        cloud.xyz = table.topRows(3).unaryExpr([](double value) { return std::fmod(value, 1e12); });
        for (int i = 3; i < columns; ++i) cloud::set_field(cloud, "column" + std::to_string(i + 1), table.row(i), 8);
        expect_same(cloud, cloud::parse_cloud(text, "file").cloud);
    }
}

TEST(RoundTrip, Transform)
{
    Random random(6);
    const OwnFolder folder;
    for (int round = 0; round < kRounds; ++round) {
        Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
        matrix.topLeftCorner<3, 3>() = Eigen::AngleAxisd(random.between(0, 7), random.unit()).toRotationMatrix();
        matrix.topRightCorner<3, 1>() = random.vector(3, -1e5, 1e5);
        std::ofstream out("transform");
        align::write_transform(out, matrix);
        out.close();
        EXPECT_EQ(align::read_transform("transform"), matrix);
    }
}

// --- triangles
// --------------------------------------------------------------------------------------------------------

mesh::Mesh random_mesh(Random& random)
{
    mesh::Mesh mesh;
    mesh.vertices = Eigen::Matrix3Xd::NullaryExpr(3, random.integer(3, 20), [&] {
        return static_cast<double>(std::fmod(random.finite<float>(), 1e11F)); // as far as a part may reach
    });
    const int vertices = static_cast<int>(mesh.vertices.cols());
    mesh.triangles.resize(3, random.integer(1, 20));
    for (int& corner : mesh.triangles.reshaped()) corner = random.integer(0, vertices - 1);
    return mesh;
}

/// The corners of all triangles: an STL renumbers its vertices.
Eigen::Matrix3Xd corners(const mesh::Mesh& mesh) { return mesh.vertices(Eigen::all, mesh.triangles.reshaped()); }

std::string words(const Eigen::Vector3d& p)
{
    return core::to_text(p.x()) + ' ' + core::to_text(p.y()) + ' ' + core::to_text(p.z());
}

TEST(RoundTrip, StlAsNumbersAndText)
{
    Random random(7);
    for (int round = 0; round < kRounds; ++round) {
        const mesh::Mesh mesh = random_mesh(random);
        std::ostringstream out;
        mesh::write_stl(out, mesh);
        EXPECT_EQ(corners(mesh::parse_mesh(out.str(), "file")), corners(mesh));
        std::string text = "solid\n";
        for (const auto triangle : mesh.triangles.colwise()) {
            text += "facet normal 0 0 0\nouter loop\n";
            for (const int corner : triangle) text += "vertex " + words(mesh.vertices.col(corner)) + '\n';
            text += "endloop\nendfacet\n";
        }
        EXPECT_EQ(corners(mesh::parse_mesh(text + "endsolid\n", "file")), corners(mesh));
    }
}

TEST(RoundTrip, ObjAndOff)
{
    Random random(8);
    for (int round = 0; round < kRounds; ++round) {
        mesh::Mesh mesh = random_mesh(random);
        mesh.vertices =
            mesh.vertices.unaryExpr([&](double) { return random.between(-1e6, 1e6); }); // all digits of a double
        std::string vertices, obj_faces, off_faces;
        for (const auto vertex : mesh.vertices.colwise()) vertices += "v " + words(vertex) + '\n';
        for (const auto t : mesh.triangles.colwise()) {
            obj_faces += "f " + words((t.array() + 1).matrix().cast<double>()) + '\n';
            off_faces += "3 " + words(t.cast<double>()) + '\n';
        }
        const mesh::Mesh obj = mesh::parse_mesh(vertices + obj_faces, "file");
        EXPECT_EQ(corners(obj), corners(mesh));
        std::string off =
            "OFF\n" + std::to_string(mesh.vertices.cols()) + ' ' + std::to_string(mesh.triangles.cols()) + " 0\n";
        for (const auto vertex : mesh.vertices.colwise()) off += words(vertex) + '\n';
        EXPECT_EQ(corners(mesh::parse_mesh(off + off_faces, "file")), corners(mesh));
    }
}

// --- documents
// --------------------------------------------------------------------------------------------------------

TEST(RoundTrip, NumbersOfJson)
{
    Random random(9);
    const Eigen::VectorXd numbers = Eigen::VectorXd::NullaryExpr(2000, [&] { return random.finite<double>(); });
    json::Reader reader = json::Reader::parse(json::Value().set("numbers", numbers).text(), "file");
    EXPECT_EQ(reader.vector("numbers"), numbers);
}

job::Job random_job(Random& random)
{
    job::Job job;
    job.units = random.units();
    const units::Units& units = job.units;
    const double mm = units.mm();
    job.theta = random.between(-3, 3);
    job.surface = job::SurfaceType(random.integer(0, 2));
    if (job.surface == job::SurfaceType::swept) job.ruling_direction = random.between(-3, 3);
    const Eigen::Vector2d centre = random.vector(2, -100, 100) * mm;
    const auto around = [&](double radius, int count) {
        Eigen::Matrix3Xd points(3, count);
        for (int i = 0; i < count; ++i) {
            const double angle = 2 * std::numbers::pi * i / count, r = radius * random.between(0.9, 1.1);
            points.col(i) << centre.x() + r * std::cos(angle), centre.y() + r * std::sin(angle), random.between(-5, 5);
            if (random.integer(0, 3) == 0) points(2, i) = std::numeric_limits<double>::quiet_NaN();
        }
        return points;
    };
    job.anomaly = around(20, random.integer(4, 9));
    job.sampling = around(60, random.integer(4, 9));
    job.probe = {random.between(1e-3, 0.1), random.between(0, 3)};
    job.tolerance = random.between(1e-3, 1);
    job.safe_height = random.between(20, 200);
    job.wheel = {random.between(20, 100), random.between(2, 20), random.between(5, 20)};
    const double min = random.between(1, 50), max = min + random.between(1, 50);
    job.force = {min, min + random.between(0, 0.9) * (max - min), max, random.between(1, 100),
                 random.between(0, 0.9) * min};
    job.feed = {random.integer(0, 1) == 0 ? 'x' : 'y', random.between(1, 100),
                random.between(0.1, 1) * job.wheel.width};
    job.removal_coefficient = random.between(0.01, 10);
    return job;
}

/// Texts of documents that say the same, their numbers to `relative` of their own size or `absolute`.
void expect_same(const std::string& a, const std::string& b, double relative, double absolute = 0)
{
    const std::vector<json::Leaf> first = json::flatten(a, "first"), second = json::flatten(b, "second");
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t n = 0; n < first.size(); ++n) {
        EXPECT_EQ(first[n].path, second[n].path);
        const auto *x = std::get_if<double>(&first[n].value), *y = std::get_if<double>(&second[n].value);
        if (x != nullptr && y != nullptr)
            EXPECT_NEAR(*x, *y, std::max(absolute, relative * std::abs(*x))) << first[n].path;
        else
            EXPECT_EQ(json::to_text(first[n]), json::to_text(second[n])) << first[n].path;
    }
}

template <typename Parse>
std::string again(const std::string& text, const Parse& parse)
{
    return to_json(parse(json::Reader::parse(text, "file"))).text();
}

TEST(RoundTrip, Job)
{
    Random random(10);
    for (int round = 0; round < 10 * kRounds; ++round) {
        const job::Job job = random_job(random);
        const std::string text = job::to_json(job).text();
        EXPECT_EQ(again(text, job::parse_job), text);
        const job::Job read = job::parse_job(json::Reader::parse(text, "file"));
        EXPECT_NEAR(read.force.max, job.force.max, 1e-11 * job.force.max);
        EXPECT_NEAR(read.removal_coefficient, job.removal_coefficient, 1e-11 * job.removal_coefficient);
        EXPECT_NEAR(read.theta, job.theta, 1e-11);
        EXPECT_TRUE(read.sampling.topRows<2>().isApprox(job.sampling.topRows<2>(), 1e-11));
    }
}

std::vector<surface::Shape> random_shapes(Random& random)
{
    const Eigen::Vector3d point = random.vector(3, -100, 100);
    Eigen::Vector3d normal = random.unit() + Eigen::Vector3d(0, 0, 1.5);
    normal.normalize();
    const Eigen::Vector3d axis = normal.unitOrthogonal();
    const auto some = [&] { return random.between(-0.02, 0.02); };
    const Eigen::Matrix3d form = Eigen::Matrix3d::NullaryExpr(some);
    const Eigen::MatrixXd heights = Eigen::MatrixXd::NullaryExpr(5, 6, [&] { return random.between(-9, 9); });
    const double angle = random.between(-3, 3);
    Eigen::Vector2d ruling = random.vector(2, -1, 1);
    ruling.normalize();
    const auto knots = [](Eigen::Index inner) {
        Eigen::VectorXd all(8 + inner);
        all << Eigen::Vector4d::Zero(), Eigen::VectorXd::LinSpaced(inner, 3, 7), Eigen::Vector4d::Constant(10.1);
        return all;
    };
    return {
        surface::Plane{random.vector(2, -9, 9), some(), random.vector(2, -1, 1)},
        surface::Sphere{point, normal, some()},
        surface::Cylinder{point, normal, axis, some()},
        surface::Cone{point, normal, axis, some(), 10 * some()},
        surface::Torus{point, normal, axis, some(), 10 * some(), some()},
        surface::Quadric{point, normal, form + form.transpose()},
        surface::Polynomial{random.vector(2, -9, 9), random.between(1, 50), random.vector(10, -9, 9)},
        surface::Swept{random.vector(2, -9, 9), ruling, random.between(1, 50), random.vector(4, -9, 9), some(),
                       -20 + some(), 30 + some()},
        surface::Bspline{angle, random.vector(2, -9, 9), random.vector(2, 1, 9), heights},
        surface::TensorBspline{angle, knots(1), knots(2), heights},
        surface::make_griddata(Eigen::Matrix3Xd::NullaryExpr(3, 7, [&] { return random.between(-9, 9); }), 2, angle)};
}

surface::Surface random_surface(const surface::Shape& shape, const units::Units& units, Random& random)
{
    surface::Surface surface;
    surface.units = units;
    surface.shape = shape;
    surface.shift = random.between(0, 1);
    surface.method = "plane";
    surface.touch_sigma = random.between(1e-3, 0.1);
    surface.rms = random.between(1e-3, 0.1);
    surface.goodness = random.between(0, 1);
    surface.touches = Eigen::Matrix3Xd::NullaryExpr(3, 5, [&] { return random.between(-9, 9); });
    surface.roles = Eigen::VectorXi::Constant(5, 2);
    surface.ignored = random.integer(0, 9);
    surface.prediction =
        surface::Prediction{"posterior", random.between(0.5, 1), random.between(0.01, 1), surface.shift, false};
    const Eigen::Index size = surface::parameter_powers(shape).size();
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return random.between(-0.01, 0.01); });
    surface.covariance = root * root.transpose();
    return surface;
}

TEST(RoundTrip, Surfaces)
{
    Random random(11);
    for (int round = 0; round < kRounds; ++round)
        for (const surface::Shape& shape : random_shapes(random))
            for (const units::Units::Length unit :
                 {units::Units::Length::mm, units::Units::Length::in, units::Units::Length::m}) {
                const surface::Surface surface = random_surface(shape, {unit, units::Units::Force::N}, random);
                const std::string text = surface::to_json(surface).text();
                if (unit == units::Units::Length::mm) {
                    EXPECT_EQ(again(text, surface::parse_surface), text) << shape.index();
                }
                constexpr double kRounding = 1e-15; // of powers of the unit, and back
                expect_same(again(text, surface::parse_surface), text, kRounding);
                const surface::Surface read = surface::parse_surface(json::Reader::parse(text, "file"));
                const Eigen::Vector2d here = surface.touches.col(0).head<2>();
                const double z = surface::height(surface, here);
                if (std::isfinite(z)) {
                    EXPECT_NEAR(surface::height(read, here), z, 1e-9) << shape.index();
                }
            }
}

TEST(RoundTrip, Plan)
{
    Random random(12);
    for (int round = 0; round < kRounds; ++round) {
        job::Job job = random_job(random);
        surface::Surface surface;
        surface.units = job.units;
        surface.shape = surface::Plane{random.vector(2, -9, 9), random.between(-5, 5), random.vector(2, -0.01, 0.01)};
        const std::string text =
            plan::to_json(
                plan::make_plan(job::parse_job(json::Reader::parse(job::to_json(job).text(), "job")), surface))
                .text();
        constexpr double kRounding = 1e-15; // of places within a metre, turned into the working frame and back
        expect_same(again(text, plan::parse_plan), text, 0, 1e3 * kRounding);
    }
}

// --- programs, machines
// -----------------------------------------------------------------------------------------------

TEST(RoundTrip, Gcode)
{
    Random random(13);
    for (int round = 0; round < kRounds; ++round) {
        const bool inches = round % 2 == 1;
        std::ostringstream out;
        out << "G90 G17 " << (inches ? "G20" : "G21") << '\n';
        machining::NcWriter writer(out);
        writer.set_inches(inches);
        std::vector<machining::CutterMove> moves;
        Eigen::Vector3d at = random.vector(3, -100, 100);
        writer.move_to(at, 0);
        for (int n = 0; n < 30; ++n) {
            machining::CutterMove move;
            move.from = at;
            move.feed = n % 5 == 0 ? 0 : random.between(1, 100);
            if (n % 3 == 1) { // an arc of some turn about a centre at some distance
                move.feed = random.between(1, 100);
                move.sweep_angle = random.between(0.1, 6) * (random.integer(0, 1) == 0 ? 1 : -1);
                const Eigen::Vector2d spoke = random.vector(2, -30, 30);
                move.centre = at.head<2>() + spoke;
                move.to = at;
                move.to.head<2>() = move.centre - Eigen::Rotation2Dd(move.sweep_angle) * spoke;
            } else {
                move.to = random.vector(3, -100, 100);
            }
            writer.move_to(move);
            moves.push_back(move);
            at = move.to;
        }
        const machining::NcProgram program = machining::parse_nc_program(out.str(), "file");
        ASSERT_EQ(program.moves.size(), moves.size() + 1);
        EXPECT_EQ(program.chorded_arcs, 0u);
        for (std::size_t n = 0; n < moves.size(); ++n) {
            const machining::CutterMove &read = program.moves[n + 1], &move = moves[n];
            EXPECT_LT((read.to - move.to).norm(), 1e-5);
            EXPECT_NEAR(read.feed, move.feed, 1e-6);
            EXPECT_NEAR(read.sweep_angle, move.sweep_angle, 1e-4);
            if (move.sweep_angle != 0) {
                EXPECT_LT((read.centre - move.centre).norm(), 1e-4);
            }
        }
    }
}

TEST(RoundTrip, Protocol)
{
    Random random(14);
    const auto some = [&] { return random.finite<double>(); };
    const auto place = [&] { return Eigen::Vector3d(some(), some(), some()); };
    for (int round = 0; round < 10 * kRounds; ++round) {
        const gantry::GantryStatus status{some(), place(), some(), some(), some()};
        const gantry::GantryStatus heard = gantry::protocol::parse_status(gantry::protocol::to_line(status));
        EXPECT_EQ(heard.time, status.time);
        EXPECT_EQ(heard.commanded, status.commanded);
        EXPECT_EQ(heard.deflection, status.deflection);
        EXPECT_EQ(heard.force, status.force);
        EXPECT_EQ(heard.peak_force, status.peak_force);
        const gantry::protocol::Limits limits{place(), place(), some(), some()};
        const gantry::protocol::Limits parsed = gantry::protocol::parse_limits(gantry::protocol::to_line(limits));
        EXPECT_EQ(parsed.min, limits.min);
        EXPECT_EQ(parsed.max, limits.max);
        EXPECT_EQ(parsed.speed, limits.speed);
        EXPECT_EQ(parsed.force, limits.force);
    }
}

// A trace holds floats, but for the time and the wheel's radius.
TEST(RoundTrip, Trace)
{
    Random random(15);
    const OwnFolder folder;
    const auto some = [&] { return static_cast<double>(static_cast<float>(random.between(-1000, 1000))); };
    for (int round = 0; round < kRounds; ++round) {
        std::vector<strategy::TraceRow> rows(static_cast<std::size_t>(random.integer(1, 20)));
        for (strategy::TraceRow& row : rows)
            row = {.time = random.between(0, 1e6),
                   .tool = {some(), some(), some()},
                   .layer = random.integer(1, 99),
                   .pass = random.integer(1, 999),
                   .event = strategy::Event(random.integer(0, int(strategy::Event::stopped))),
                   .force = some(),
                   .feed = some(),
                   .peak_force = some(),
                   .deflection = some(),
                   .radius = random.between(1, 100)};
        rows.back().event = strategy::Event::none; // some would be left out at the end
        for (const cloud::PcdEncoding encoding : {cloud::PcdEncoding::binary, cloud::PcdEncoding::ascii}) {
            strategy::TraceFile("trace", units::Units{}, encoding, rows);
            const std::vector<strategy::TraceRow> read = strategy::read_trace("trace", units::Units{});
            ASSERT_EQ(read.size(), rows.size());
            for (std::size_t n = 0; n < rows.size(); ++n) {
                EXPECT_EQ(read[n].time, rows[n].time);
                EXPECT_EQ(read[n].tool, rows[n].tool);
                EXPECT_EQ(read[n].layer, rows[n].layer);
                EXPECT_EQ(read[n].pass, rows[n].pass);
                EXPECT_EQ(read[n].event, rows[n].event);
                EXPECT_EQ(read[n].force, rows[n].force);
                EXPECT_EQ(read[n].feed, rows[n].feed);
                EXPECT_EQ(read[n].peak_force, rows[n].peak_force);
                EXPECT_EQ(read[n].deflection, rows[n].deflection);
                EXPECT_EQ(read[n].radius, rows[n].radius);
            }
        }
    }
}

} // namespace round_trip_test
} // namespace fettle
