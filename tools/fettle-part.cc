#include "cli/tool.h"
#include "mesh/mesh_file.h"
#include "part/part.h"

using namespace fettle;

int main(int argc, char** argv)
{
    return tool_main(
        argc, argv, "Make a part: a desired surface, anomalies on it, and the noise of a scan.", [](Tool& t) {
            const std::string& path = t.input("SPEC", "what to make, JSON of kind \"part\"");
            const bool& bare = t.flag("--without-anomaly", "The desired surface alone: no anomalies, no noise");
            t.example("fettle-part parts/wang1.json -o stock.stl", "a plate with a sloped H on it, as a triangle mesh");
            t.reference("Wang 2007, 6.2 (test parts) and figure 5-8");
            t.parse();

            PartSpec spec = read_part(path);
            if (bare) {
                spec.anomalies.clear();
                spec.noise = {};
            }
            const Mesh part = make_part(spec, t.seed());
            write_stl(t.output(), part, spec.units.length);
            return Verdict::yes;
        });
}
