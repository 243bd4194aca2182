#include "cli/tool.h"
#include "mesh/part_output.h"
#include "mesh/shape_file.h"
#include "part/part.h"

using namespace fettle;

int main(int argc, char** argv)
{
    return cli::tool_main(
        argc, argv, "Make a part: a desired surface, anomalies on it, and the noise of a scan.", [](cli::Tool& t) {
            const std::string& path = t.main_input("SPEC", "what to make, JSON of kind \"part\"");
            const bool& bare = t.flag("--without-anomaly", "The desired surface alone: no anomalies, no noise");
            const bool& as_cloud =
                t.flag("--cloud", "The corners of the triangles as points; a scanned cloud is always one");
            const mesh::PartOutput out{t};
            t.example("fettle-part parts/wang1.json -o stock.stl", "a plate with a sloped H on it, as a triangle mesh");
            t.reference("Wang 2007, 6.2 (test parts) and figure 5-8");
            t.parse();

            part::PartSpec spec = part::read_part(path);
            if (bare) {
                spec.anomalies.clear();
                spec.noise = {};
            }
            std::vector<std::string> warnings;
            mesh::CloudMesh part = mesh::as_cloud_mesh(part::make_part(spec, t.seed(), &warnings));
            for (const std::string& warning : warnings) t.warn(warning);
            if (as_cloud) part.triangles.resize(3, 0);
            out.write(part, spec.units);
            return cli::Verdict::yes;
        });
}
