#include "cli/tool.h"
#include "core/file.h"
#include "core/text.h"
#include "diff/diff.h"

#include <cmath>
#include <ostream>

using namespace fettle;

namespace {

constexpr std::size_t kMostLines = 20; // of what differs in structure; more help nobody

void print(std::ostream& out, const Difference& found)
{
    for (std::size_t i = 0; i < found.structure.size() && i < kMostLines; ++i) out << found.structure[i] << '\n';
    if (found.structure.size() > kMostLines) out << "and " << found.structure.size() - kMostLines << " more\n";
    out << found.unequal << " of " << found.values << " values differ";
    if (found.where.empty())
        out << '\n';
    else
        out << "; largest difference " << to_text(found.largest) << " at " << found.where << '\n';
}

} // namespace

int main(int argc, char** argv)
{
    return tool_main(argc, argv, "Compare two files of numbers: points, meshes or JSON.", [](Tool& t) {
        const std::string& a = t.file("A", "PCD, PLY, XYZ, STL, OBJ, OFF or JSON; stdin if it is -");
        const std::string& b = t.file("B", "Of the same kind; stdin if it is -");
        const double& absolute = t.number("--tol", 0, "T", "Allowed difference of two numbers", Range::at_least(0));
        const double& relative = t.number("--rel", 0, "R",
                                          "Allowed difference, relative to the greater number; "
                                          "added to --tol",
                                          Range::at_least(0));
        t.example("fettle-diff --tol 1e-6 jobs/wang1.json jobs/wang1.json",
                  "exits 0 if no two numbers differ by more than 1e-6, 1 if some do, 2 if a file cannot be read");
        t.parse();

        if (a == "-" && b == "-") throw InputError("A and B are both stdin");
        const Difference found =
            difference(read_whole(a), display_name(a), read_whole(b), display_name(b), {absolute, relative});
        print(t.output(), found);
        t.report()
            .set("equal", found.equal())
            .set("values", found.values)
            .set("unequal", found.unequal)
            .set("largest", found.largest)
            .set("where", found.where);
        return found.equal() ? Verdict::yes : Verdict::no;
    });
}
