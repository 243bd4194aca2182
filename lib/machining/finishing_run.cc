#include "machining/finishing_run.h"

#include "core/error.h"
#include "core/file.h"
#include "geometry/bounding_box.h"
#include "machining/part_mesh.h"
#include "machining/tilt.h"

#include <utility>

namespace fettle::machining {

FinishingRun plan_finishing(const FinishingRequest& request)
{
    FinishingRun run;
    run.R_tilted_machine = rotation_tilted_machine(request.tool_axis);
    run.options = request.options;
    PartMesh part = read_design(request.design, request.unit, run.R_tilted_machine);
    const mesh::Mesh& design = part.mesh;
    run.warnings = std::move(part.warnings);
    const std::string name = core::display_name(request.design);
    const std::string doubt =
        cutter_size_warning("the design", geometry::bounding_box(design.vertices).sizes(), request.cutter);
    if (!doubt.empty()) run.warnings.push_back(name + ": " + doubt);
    core::with_error_prefix(name, [&] {
        const DesignShape shape = estimate_design_shape(design);
        run.options.step_over =
            request.step_over ? *request.step_over : step_over_for(*request.scallop, request.cutter, shape);
        run.options.overhang = request.overhang ? *request.overhang : overhang_for(request.cutter, shape);
        run.path = finishing_path(design, request.cutter, run.options);
    });
    return run;
}

cloud::Cloud to_cloud(const FinishingRun& run) { return rotated(to_cloud(run.path), run.R_tilted_machine.transpose()); }

} // namespace fettle::machining
