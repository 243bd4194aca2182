#include "cad/design.h"

#include "cad/design_file.h"
#include "cad/shapes.h"
#include "core/error.h"
#include "core/file.h"

#include <BRep_Builder.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <Standard_Failure.hxx>
#include <TDataStd_Name.hxx>
#include <TDF_Label.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopTools_MapOfShape.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFPrs.hxx>
#include <XCAFPrs_DocumentExplorer.hxx>
#include <XCAFPrs_IndexedDataMapOfShapeStyle.hxx>

#include <algorithm>
#include <utility>

namespace fettle::cad {
namespace {

using Colour = std::array<std::uint8_t, 3>;

std::string name_of(const TDF_Label& label)
{
    Handle(TDataStd_Name) name;
    if (label.IsNull() || !label.FindAttribute(TDataStd_Name::GetID(), name)) return "";
    return TCollection_AsciiString(name->Get()).ToCString(); // UTF-8
}

std::string surface_of(const TopoDS_Face& face)
{
    switch (BRepAdaptor_Surface(face, false).GetType()) {
    case GeomAbs_Plane:
        return "plane";
    case GeomAbs_Cylinder:
        return "cylinder";
    case GeomAbs_Cone:
        return "cone";
    case GeomAbs_Sphere:
        return "sphere";
    case GeomAbs_Torus:
        return "torus";
    case GeomAbs_BSplineSurface:
        return "B-spline";
    case GeomAbs_SurfaceOfRevolution:
        return "revolution";
    case GeomAbs_SurfaceOfExtrusion:
        return "extrusion";
    case GeomAbs_OffsetSurface:
        return "offset";
    default:
        return "other";
    }
}

std::optional<Colour> colour_of(const XCAFPrs_Style& style)
{
    if (!style.IsSetColorSurf()) return std::nullopt;
    std::array<double, 3> rgb{};
    style.GetColorSurf().Values(rgb[0], rgb[1], rgb[2], Quantity_TOC_sRGB);
    Colour colour;
    std::ranges::transform(rgb, colour.begin(), [](double c) { return static_cast<std::uint8_t>(255 * c + 0.5); });
    return colour;
}

/// Colours of a part's faces: those of the face itself before those of its shell, solid and part.
class FaceColours {
  public:
    explicit FaceColours(const TDF_Label& part)
    {
        XCAFPrs_IndexedDataMapOfShapeStyle styles;
        XCAFPrs::CollectStyleSettings(part, TopLoc_Location(), styles);
        for (int type = TopAbs_COMPOUND; type <= TopAbs_FACE; ++type) // from the whole to its faces
            for (int i = 1; i <= styles.Extent(); ++i)
                if (const auto colour = colour_of(styles.FindFromIndex(i));
                    colour && styles.FindKey(i).ShapeType() == type) {
                    colours_.push_back(*colour);
                    for (TopExp_Explorer face(styles.FindKey(i), TopAbs_FACE); face.More(); face.Next())
                        colour_of_.Bind(face.Current(), static_cast<int>(colours_.size()) - 1);
                }
    }
    std::optional<Colour> of(const TopoDS_Shape& face, const XCAFPrs_Style& of_assembly) const
    {
        const int* index = colour_of_.Seek(face);
        return index != nullptr ? std::optional(colours_[static_cast<std::size_t>(*index)]) : colour_of(of_assembly);
    }

  private:
    std::vector<Colour> colours_;
    TopTools_DataMapOfShapeInteger colour_of_;
};

/// Names of the assemblies and the part of a node, "vice/jaw".
std::string path_of(const XCAFPrs_DocumentExplorer& node)
{
    std::string path;
    for (int depth = 0; depth <= node.CurrentDepth(); ++depth) {
        const std::string name = name_of(node.Current(depth).RefLabel);
        if (!name.empty()) path += (path.empty() ? "" : "/") + name;
    }
    return path;
}

/// Faces that belong to no solid, where they are placed.
struct LooseFaces {
    std::vector<Face> faces;
    std::vector<TopoDS_Shape> shapes;
};

/// Adds the faces of the solids below a leaf of the assemblies; the others are loose.
void add_part(const XCAFPrs_DocumentExplorer& node, const Handle(XCAFDoc_ShapeTool) & tool, Shapes& shapes,
              LooseFaces& loose)
{
    const XCAFPrs_DocumentNode& leaf = node.Current();
    const TopoDS_Shape part = XCAFDoc_ShapeTool::GetShape(leaf.RefLabel);
    if (part.IsNull()) return;
    const FaceColours colours(leaf.RefLabel);
    const std::string path = path_of(node);
    const auto describe = [&](const TopoDS_Shape& face) {
        TDF_Label label;
        const bool is_known = tool->FindSubShape(leaf.RefLabel, face, label);
        return Face{path, is_known ? name_of(label) : "", surface_of(TopoDS::Face(face)), colours.of(face, leaf.Style)};
    };
    for (TopExp_Explorer solid(part, TopAbs_SOLID); solid.More(); solid.Next()) {
        ++shapes.solids;
        for (TopExp_Explorer face(solid.Current(), TopAbs_FACE); face.More(); face.Next()) {
            shapes.faces.push_back(describe(face.Current()));
            shapes.placed.push_back(TopoDS::Face(face.Current().Moved(leaf.Location)));
        }
        if (std::ranges::none_of(shapes.parts,
                                 [&](const TopoDS_Shape& known) { return known.IsSame(solid.Current()); }))
            shapes.parts.push_back(solid.Current());
    }
    for (TopExp_Explorer face(part, TopAbs_FACE, TopAbs_SOLID); face.More(); face.Next()) {
        loose.faces.push_back(describe(face.Current()));
        loose.shapes.push_back(face.Current().Moved(leaf.Location));
    }
}

/// The shells of a sewn shape; a face that is closed by itself, as a sphere, is one.
std::vector<TopoDS_Shell> shells_of(const TopoDS_Shape& sewn)
{
    std::vector<TopoDS_Shell> shells;
    for (TopExp_Explorer shell(sewn, TopAbs_SHELL); shell.More(); shell.Next())
        shells.push_back(TopoDS::Shell(shell.Current()));
    for (TopExp_Explorer face(sewn, TopAbs_FACE, TopAbs_SHELL); face.More(); face.Next()) {
        TopoDS_Shell& shell = shells.emplace_back();
        BRep_Builder builder;
        builder.MakeShell(shell);
        builder.Add(shell, face.Current());
    }
    return shells;
}

/// Sews loose faces to solids. Most IGES files have no other.
void sew(const LooseFaces& loose, double gap, Shapes& shapes)
{
    BRepBuilderAPI_Sewing sewing(gap);
    for (const TopoDS_Shape& face : loose.shapes) sewing.Add(face);
    sewing.Perform();
    const std::string faces = std::to_string(loose.faces.size()) + (loose.faces.size() == 1 ? " face" : " faces");
    if (sewing.NbFreeEdges() > 0)
        throw core::InputError(shapes.source, "has no solid: its " + faces + " leave " +
                                                  std::to_string(sewing.NbFreeEdges()) + " edges open");
    TopTools_DataMapOfShapeInteger origin;
    for (std::size_t i = 0; i < loose.shapes.size(); ++i)
        origin.Bind(sewing.Modified(loose.shapes[i]), static_cast<int>(i));
    for (const TopoDS_Shell& shell : shells_of(sewing.SewedShape())) {
        TopoDS_Solid solid = BRepBuilderAPI_MakeSolid(shell);
        BRepLib::OrientClosedSolid(solid);
        ++shapes.solids;
        shapes.parts.push_back(solid);
        for (TopExp_Explorer face(solid, TopAbs_FACE); face.More(); face.Next()) {
            const int* index = origin.Seek(face.Current());
            shapes.faces.push_back(index != nullptr ? loose.faces[static_cast<std::size_t>(*index)] : Face{});
            shapes.placed.push_back(TopoDS::Face(face.Current()));
        }
    }
    if (shapes.placed.size() != loose.faces.size())
        throw core::InputError(shapes.source, "has no solid: of its " + faces + " only " +
                                                  std::to_string(shapes.placed.size()) + " could be sewn together");
}

} // namespace

Design::Design(std::unique_ptr<Shapes> shapes) : shapes_(std::move(shapes)) {}
Design::Design(Design&&) noexcept = default;
Design::~Design() = default;

const std::vector<Face>& Design::faces() const { return shapes_->faces; }
int Design::solids() const { return shapes_->solids; }
int Design::loose_faces() const { return shapes_->loose_faces; }
const std::string& Design::file_unit() const { return shapes_->file_unit; }
const Shapes& Design::shapes() const { return *shapes_; }

std::string Design::describe(std::size_t face) const
{
    const Face& f = shapes_->faces[face];
    std::string names = f.name.empty() ? "" : "'" + f.name + "'";
    if (!f.part.empty()) names += std::string(names.empty() ? "" : " ") + "of '" + f.part + "'";
    return "face " + std::to_string(face) + " (" + f.surface + (names.empty() ? "" : ", " + names) + ")";
}

Design read_design(const std::string& path, double gap)
{
    const DesignFile file = read_design_file(path);
    auto shapes = std::make_unique<Shapes>();
    shapes->source = core::display_name(path);
    shapes->file_unit = file.unit;
    LooseFaces loose;
    try {
        const Handle(XCAFDoc_ShapeTool) tool = XCAFDoc_DocumentTool::ShapeTool(file.document->Main());
        for (XCAFPrs_DocumentExplorer node(file.document, XCAFPrs_DocumentExplorerFlags_OnlyLeafNodes); node.More();
             node.Next())
            add_part(node, tool, *shapes, loose);
        if (shapes->solids == 0 && loose.faces.empty())
            throw core::InputError(shapes->source, "has no solid, and no face");
        if (shapes->solids == 0)
            sew(loose, gap, *shapes);
        else if (!loose.faces.empty())
            shapes->loose_faces = static_cast<int>(loose.faces.size());
    } catch (const Standard_Failure& failure) {
        throw core::InputError(shapes->source,
                               std::string("OpenCASCADE cannot build it: ") + failure.GetMessageString());
    }
    return Design(std::move(shapes));
}

} // namespace fettle::cad
