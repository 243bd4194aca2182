#include "cad/step_placements.h"

#include "core/error.h"
#include "core/text.h"

#include <gp_Vec.hxx>
#include <Interface_Check.hxx>
#include <Interface_InterfaceModel.hxx>
#include <StepGeom_CartesianTransformationOperator3d.hxx>
#include <StepGeom_Direction.hxx>
#include <StepRepr_MappedItem.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <TransferBRep.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace fettle::cad {
namespace {

using Operator = StepGeom_CartesianTransformationOperator3d;

// A scale that is written as a ratio of two units is rounded by less.
constexpr double kScaleTolerance = 1e-9;

gp_Vec ratios_of(const Handle(StepGeom_Direction) & direction)
{
    gp_Vec v(0, 0, 0);
    for (int k = 1; k <= std::min(3, direction->NbDirectionRatios()); ++k)
        v.SetCoord(k, direction->DirectionRatiosValue(k));
    return v;
}

/// Are all three axes given, and left-handed?
bool reflects(const Handle(Operator) & by)
{
    if (!by->HasAxis1() || !by->HasAxis2() || !by->HasAxis3()) return false;
    return ratios_of(by->Axis1()).Crossed(ratios_of(by->Axis2())).Dot(ratios_of(by->Axis3())) < 0;
}

/// Why OpenCASCADE has not placed an item as the file says; empty: it has.
std::string wrong_placement(const Handle(StepRepr_MappedItem) & item, const Handle(Interface_Check) & check)
{
    const Handle(Operator) by = Handle(Operator)::DownCast(item->MappingTarget());
    if (!by.IsNull() && by->HasScale() && std::abs(by->Scale() - 1) > kScaleTolerance)
        return "scaled by " + core::to_short_text(by->Scale());
    if (!by.IsNull() && reflects(by)) return "mirrored";
    for (int k = 1; !check.IsNull() && k <= check->NbWarnings(); ++k)
        if (std::string_view(check->CWarning(k)).find("location ignored") != std::string_view::npos)
            return "placed in frames that are not found";
    return "";
}

} // namespace

void check_step_placements(const STEPControl_Reader& reader, const std::string& source)
{
    const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
    const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
    for (int i = 1; i <= model->NbEntities(); ++i) {
        const Handle(StepRepr_MappedItem) item = Handle(StepRepr_MappedItem)::DownCast(model->Value(i));
        if (item.IsNull() || TransferBRep::ShapeResult(process, item).IsNull()) continue;
        const std::string wrong = wrong_placement(item, process->Find(item)->Check());
        if (!wrong.empty())
            throw core::InputError(source, std::string("the mapped item ") + model->StringLabel(item)->ToCString() +
                                               " is " + wrong + ": OpenCASCADE does not read that");
    }
}

} // namespace fettle::cad
