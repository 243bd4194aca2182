// Solids that OpenCASCADE makes and writes are read and triangulated. References: closed forms of the solids.

#include "cad/exact_distance.h"
#include "cad/triangulation.h"
#include "core/error.h"
#include "core/file.h"

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>

using namespace fettle;

namespace cad_test {

constexpr double kPi = std::numbers::pi;
constexpr double kTolerance = 0.05; // mm
constexpr double kFloat = 1e-5;     // rounding of the coordinates written, mm

struct Solid {
    const char* name;
    TopoDS_Shape shape;
    std::function<double(const Eigen::Vector3d&)> distance; ///< from its surface, mm
    double volume, area;
};

std::vector<Solid> solids()
{
    const auto ring = [](const Eigen::Vector3d& p) { return std::hypot(std::hypot(p.x(), p.y()) - 20, p.z()) - 6; };
    const auto cone = [](const Eigen::Vector3d& p) { // apex at z = 24, radius 10 at z = 0
        const double r = std::hypot(p.x(), p.y());
        return std::min(std::abs((24 * r + 10 * p.z() - 240) / 26), std::abs(p.z()));
    };
    const auto cylinder = [](const Eigen::Vector3d& p) {
        return std::min({std::abs(std::hypot(p.x(), p.y()) - 8), std::abs(p.z()), std::abs(p.z() - 30)});
    };
    return {{"sphere", BRepPrimAPI_MakeSphere(15).Shape(), [](const Eigen::Vector3d& p) { return p.norm() - 15; },
             4.0 / 3 * kPi * 3375, 4 * kPi * 225},
            {"cylinder", BRepPrimAPI_MakeCylinder(8, 30).Shape(), cylinder, kPi * 64 * 30, 2 * kPi * 8 * 38},
            {"cone", BRepPrimAPI_MakeCone(10, 0, 24).Shape(), cone, kPi * 100 * 8, kPi * 10 * 36},
            {"torus", BRepPrimAPI_MakeTorus(20, 6).Shape(), ring, 2 * kPi * kPi * 20 * 36, 4 * kPi * kPi * 120},
            {"B-spline torus", BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeTorus(20, 6).Shape()).Shape(), ring,
             2 * kPi * kPi * 20 * 36, 4 * kPi * kPi * 120}};
}

std::string written(const TopoDS_Shape& shape, const std::string& name, const char* unit = "MM")
{
    Message::DefaultMessenger()->ChangePrinters().Clear();
    STEPControl_Writer writer;
    Interface_Static::SetCVal("write.step.unit", unit);
    writer.Transfer(shape, STEPControl_AsIs);
    const std::string path = (std::filesystem::temp_directory_path() / ("fettle_cad_test_" + name + ".step")).string();
    writer.Write(path.c_str());
    Interface_Static::SetCVal("write.step.unit", "MM");
    return path;
}

double volume_of(const mesh::Mesh& mesh)
{
    double six = 0;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) six += mesh::triangle_of(mesh, t).determinant();
    return six / 6;
}

/// Largest distance of points on all triangles from the solid: corners, middles of edges, centroids.
double largest_distance(const mesh::Mesh& mesh, const Solid& solid)
{
    double largest = 0;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const mesh::Triangle c = mesh::triangle_of(mesh, t);
        for (const Eigen::Vector3d& weights :
             {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0.5, 0.5), Eigen::Vector3d(0.5, 0, 0.5),
              Eigen::Vector3d(0.5, 0.5, 0), Eigen::Vector3d::Constant(1.0 / 3).eval()})
            largest = std::max(largest, std::abs(solid.distance(c * weights)));
    }
    return largest;
}

void expect_within(const cad::Design& design, const Solid& solid, double tolerance = kTolerance)
{
    const cad::Triangulation result = cad::triangulate(design, tolerance);
    const double stated = *std::ranges::max_element(result.deviation);
    EXPECT_LE(stated, tolerance);
    EXPECT_LE(largest_distance(result.mesh, solid), stated + kFloat);
    EXPECT_EQ(result.open_edges, 0);
    EXPECT_NEAR(volume_of(result.mesh), solid.volume, solid.area * stated);
    EXPECT_LT(volume_of(result.mesh),
              solid.volume * (1 + 1e-6)); // all are convex along their circles: chords lie inside
}

TEST(Cad, SolidsWithClosedFormsAreWithinTheToleranceStatedForThem)
{
    for (const Solid& solid : solids()) {
        SCOPED_TRACE(solid.name);
        const cad::Design design = cad::read_design(written(solid.shape, "solid"), 0.01);
        EXPECT_EQ(design.solids(), 1);
        EXPECT_EQ(design.file_unit(), "millimetre");
        expect_within(design, solid);
    }
}

TEST(Cad, TheFileSaysTheUnit)
{
    const double r = 15 * 25.4; // the writer puts the numbers of the shape behind a unit of inches
    const Solid sphere{"sphere", BRepPrimAPI_MakeSphere(15).Shape(),
                       [r](const Eigen::Vector3d& p) { return p.norm() - r; }, 4.0 / 3 * kPi * r * r * r,
                       4 * kPi * r * r};
    const cad::Design design = cad::read_design(written(sphere.shape, "inch", "INCH"), 0.01);
    EXPECT_NE(design.file_unit(), "millimetre");
    expect_within(design, sphere, 2);
}

TEST(Cad, FacesOfIgesAreSewnToSolids)
{
    for (const Solid& solid : solids()) {
        SCOPED_TRACE(solid.name);
        const std::string path = (std::filesystem::temp_directory_path() / "fettle_cad_test.igs").string();
        IGESControl_Writer writer("MM", 0); // faces alone
        writer.AddShape(solid.shape);
        writer.Write(path.c_str());
        expect_within(cad::read_design(path, 0.01), solid);
    }
}

TEST(Cad, AssembliesArePlacedAndKeepNamesAndColours)
{
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
    const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
    const Handle(XCAFDoc_ColorTool) colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
    const TDF_Label vice = shapes->NewShape(), jaw = shapes->AddShape(box, false);
    TDataStd_Name::Set(vice, "vice");
    TDataStd_Name::Set(jaw, "jaw");
    const TDF_Label face = shapes->AddSubShape(jaw, TopExp_Explorer(box, TopAbs_FACE).Current());
    colours->SetColor(face, Quantity_Color(1, 0, 0, Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
    for (const double x : {0.0, 100.0}) {
        gp_Trsf shift;
        shift.SetTranslation(gp_Vec(x, 0, 0));
        shapes->AddComponent(vice, jaw, TopLoc_Location(shift));
    }
    shapes->UpdateAssemblies();
    const std::string path = (std::filesystem::temp_directory_path() / "fettle_cad_test_vice.step").string();
    STEPCAFControl_Writer writer;
    writer.Transfer(document);
    writer.Write(path.c_str());

    const cad::Design design = cad::read_design(path, 0.01);
    EXPECT_EQ(design.solids(), 2);
    ASSERT_EQ(design.faces().size(), 12u);
    EXPECT_EQ(design.faces().front().part, "vice/jaw");
    const auto red = std::ranges::count_if(design.faces(), [](const cad::Face& f) {
        return f.colour == std::array<std::uint8_t, 3>{255, 0, 0};
    });
    EXPECT_EQ(red, 2); // of each jaw one
    const cad::Triangulation result = cad::triangulate(design, kTolerance);
    EXPECT_EQ(result.mesh.triangles.cols(), 24);
    EXPECT_NEAR(volume_of(result.mesh), 2 * 6000, 1e-3);
    EXPECT_NEAR(result.mesh.vertices.row(0).maxCoeff(), 110, 1e-4);
    EXPECT_NEAR(result.mesh.vertices.row(0).minCoeff(), 0, 1e-4);
}

TEST(Cad, OpenFacesAreNoSolid)
{
    const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(8, 30).Shape();
    const TopoDS_Shape face = TopExp_Explorer(cylinder, TopAbs_FACE).Current(); // without its lids
    try {
        cad::read_design(written(face, "open"), 0.01);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("has no solid: its 1 face leave"), std::string::npos) << error.what();
    }
}

TEST(Cad, FacesBesideASolidAreLeftOut)
{
    const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(8, 30).Shape();
    TopoDS_Compound both;
    BRep_Builder builder;
    builder.MakeCompound(both);
    builder.Add(both, BRepPrimAPI_MakeSphere(15).Shape());
    builder.Add(both, TopExp_Explorer(cylinder, TopAbs_FACE).Current());
    const cad::Design design = cad::read_design(written(both, "beside"), 0.01);
    EXPECT_EQ(design.loose_faces(), 1);
    expect_within(design, solids().front());
}

/// A wavy ring, and with lids the solid that it is extruded to.
TopoDS_Shape extruded()
{
    const Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, 8);
    for (int i = 0; i < 8; ++i) {
        const double r = 10 + i % 2;
        points->SetValue(i + 1, gp_Pnt(r * std::cos(kPi * i / 4), r * std::sin(kPi * i / 4), 0));
    }
    GeomAPI_Interpolate ring(points, true, 1e-6);
    ring.Perform();
    const TopoDS_Edge edge = BRepBuilderAPI_MakeEdge(ring.Curve());
    const TopoDS_Face face = BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(edge).Wire(), true);
    return BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, 5)).Shape();
}

std::vector<std::string> surfaces_of(const cad::Design& design)
{
    std::vector<std::string> surfaces;
    for (const cad::Face& face : design.faces()) surfaces.push_back(face.surface);
    std::ranges::sort(surfaces);
    return surfaces;
}

TEST(Cad, NamesTheKindsOfFreeFormSurfaces)
{
    const TopoDS_Shape solid = extruded();
    const std::vector<std::string> extrusion = {"extrusion", "plane", "plane"}, offset = {"offset", "plane", "plane"};
    EXPECT_EQ(surfaces_of(cad::read_design(written(solid, "extruded"), 0.01)), extrusion);
    // One mm outward of the extruded side, with lids of its own.
    TopoDS_Compound faces;
    BRep_Builder builder;
    builder.MakeCompound(faces);
    for (TopExp_Explorer face(solid, TopAbs_FACE); face.More(); face.Next()) {
        const Handle(Geom_Surface) surface = BRep_Tool::Surface(TopoDS::Face(face.Current()));
        if (!surface->IsKind(STANDARD_TYPE(Geom_SurfaceOfLinearExtrusion))) continue;
        Standard_Real u0, u1, v0, v1;
        BRepTools::UVBounds(TopoDS::Face(face.Current()), u0, u1, v0, v1);
        const Handle(Geom_Surface) outer = new Geom_OffsetSurface(surface, 1);
        const TopoDS_Face side = BRepBuilderAPI_MakeFace(outer, u0, u1, v0, v1, 1e-6);
        builder.Add(faces, side);
        for (TopExp_Explorer edge(side, TopAbs_EDGE); edge.More(); edge.Next()) {
            BRepBuilderAPI_MakeFace lid(BRepBuilderAPI_MakeWire(TopoDS::Edge(edge.Current())).Wire(), true);
            if (lid.IsDone()) builder.Add(faces, lid.Face()); // the seam has none
        }
    }
    EXPECT_EQ(surfaces_of(cad::read_design(written(faces, "offset"), 0.01)), offset);
}

TEST(Cad, AnUnknownUnitOfIgesIsRefused)
{
    const std::string path = (std::filesystem::temp_directory_path() / "fettle_cad_test_unit.igs").string();
    IGESControl_Writer writer("MM", 0);
    writer.AddShape(BRepPrimAPI_MakeSphere(15).Shape());
    writer.Write(path.c_str());
    std::string text = core::read_file(path);
    const std::size_t at = text.find("2,2HMM,1,");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, 9, "12,2HMM,1"); // flags end with 11
    std::ofstream(path) << text;
    try {
        cad::read_design(path, 0.01);
        FAIL();
    } catch (const core::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("the unit of length is not known: flag 12, 'MM'"), std::string::npos)
            << error.what();
    }
}

TEST(Cad, AToleranceBelowTheRoundingOfTheFileIsRefused)
{
    const cad::Design design = cad::read_design(written(BRepPrimAPI_MakeBox(1e3, 1e3, 1e3).Shape(), "box"), 0.01);
    EXPECT_NO_THROW(cad::triangulate(design, 1e-3));
    EXPECT_THROW(cad::triangulate(design, 1e-6), core::InputError);
}

/// Signed distance of a capped cone frustum about z: radius r0 at z = 0, r1 at z = h.
double frustum_distance(const Eigen::Vector3d& p, double r0, double r1, double h)
{
    const Eigen::Vector2d q(std::hypot(p.x(), p.y()), p.z());
    const auto to_line = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        const double t = std::clamp((q - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
        return (a + t * (b - a) - q).norm();
    };
    const double d = std::min({to_line({0, 0}, {r0, 0}), to_line({r0, 0}, {r1, h}), to_line({r1, h}, {0, h})});
    const bool is_inside = q.y() > 0 && q.y() < h && q.x() < r0 + (r1 - r0) * q.y() / h;
    return is_inside ? -d : d;
}

double box_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& size)
{
    const Eigen::Vector3d q = (p - size / 2).cwiseAbs() - size / 2;
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

TEST(Cad, ExactDistancesAreThoseOfClosedForms)
{
    using Distance = std::function<double(const Eigen::Vector3d&)>;
    const auto ring = [](const Eigen::Vector3d& p) { return std::hypot(std::hypot(p.x(), p.y()) - 20, p.z()) - 6; };
    const auto of_frustum = [](double r0, double r1, double h) {
        return [=](const Eigen::Vector3d& p) { return frustum_distance(p, r0, r1, h); };
    };
    const TopoDS_Shape sphere = BRepPrimAPI_MakeSphere(15).Shape(), torus = BRepPrimAPI_MakeTorus(20, 6).Shape();
    const TopoDS_Shape frustum = BRepPrimAPI_MakeCone(10, 4, 24).Shape();
    const std::vector<std::pair<TopoDS_Shape, Distance>> cases = {
        {sphere, [](const Eigen::Vector3d& p) { return p.norm() - 15; }},
        {BRepPrimAPI_MakeCylinder(8, 30).Shape(), of_frustum(8, 8, 30)},
        {BRepPrimAPI_MakeCone(10, 0, 24).Shape(), of_frustum(10, 0, 24)},
        {frustum, of_frustum(10, 4, 24)},
        {torus, ring},
        {BRepPrimAPI_MakeBox(10, 20, 30).Shape(),
         [](const Eigen::Vector3d& p) {
             return box_distance(p, {10, 20, 30});
         }},
        {BRepBuilderAPI_NurbsConvert(sphere).Shape(), [](const Eigen::Vector3d& p) { return p.norm() - 15; }},
        {BRepBuilderAPI_NurbsConvert(torus).Shape(), ring},
        {BRepBuilderAPI_NurbsConvert(frustum).Shape(), of_frustum(10, 4, 24)}};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        SCOPED_TRACE(i);
        const cad::Design design = cad::read_design(written(cases[i].first, "exact"), 0.01);
        const cad::Triangulation triangulation = cad::triangulate(design, kTolerance);
        srand(1);
        Eigen::Matrix3Xd points = 32 * Eigen::Matrix3Xd::Random(3, 400); // far and near
        points.rightCols(200) = triangulation.mesh.vertices(
            Eigen::all, Eigen::VectorXi::LinSpaced(200, 0, static_cast<int>(triangulation.mesh.vertices.cols()) - 1));
        points.rightCols(200) += 0.5 * Eigen::Matrix3Xd::Random(3, 200); // at edges, seams, corners and poles
        points.col(0) = Eigen::Vector3d(0, 0, 25);                       // straight above poles and the apex
        const cad::ExactDistances found = cad::ExactDistance(design, triangulation)(points);
        for (Eigen::Index k = 0; k < points.cols(); ++k) {
            EXPECT_NEAR(found.error[k], cases[i].second(points.col(k)), 1e-6) << points.col(k).transpose();
            EXPECT_NEAR((points.col(k) - found.foot.col(k)).norm(), std::abs(found.error[k]), 1e-12);
            EXPECT_NEAR(found.normal.col(k).norm(), 1, 1e-9);
            EXPECT_GE(found.face[k], 0);
        }
    }
}

} // namespace cad_test
