#include "cli/tool.h"
#include "core/file.h"
#include "core/text.h"
#include "diff/diff.h"

#include <cmath>
#include <ostream>

using namespace fettle;

namespace {

constexpr std::size_t kMaxStructureLines = 20; // of differences in structure; the rest is only counted

void print(std::ostream& out, const diff::Difference& found)
{
    for (std::size_t i = 0; i < found.structure.size() && i < kMaxStructureLines; ++i)
        out << found.structure[i] << '\n';
    if (found.structure.size() > kMaxStructureLines)
        out << "and " << found.structure.size() - kMaxStructureLines << " more\n";
    out << found.unequal << " of " << found.values << " values differ";
    if (found.where.empty())
        out << '\n';
    else
        out << "; largest difference " << core::to_text(found.largest) << " at " << found.where << '\n';
}

} // namespace

int main(int argc, char** argv)
{
    return cli::tool_main(argc, argv, "Compare two files of numbers: points, meshes or JSON.", [](cli::Tool& t) {
        const std::string& a = t.positional_file("A", "PCD, PLY, XYZ, STL, OBJ, OFF or JSON; stdin if it is -");
        const std::string& b = t.positional_file("B", "Second file, of the same kind; stdin if it is -");
        const double& absolute =
            t.number("--tol", 0, "T", "Allowed difference of two numbers", core::Range::at_least(0));
        const double& relative = t.number("--rel", 0, "R",
                                          "Allowed difference, relative to the greater number; "
                                          "added to --tol",
                                          core::Range::at_least(0));
        t.example("fettle-diff --tol 1e-6 jobs/wang1.json jobs/wang1.json",
                  "exits 0 if no two numbers differ by more than 1e-6, 1 if some do, 2 if a file cannot be read");
        t.parse();

        if (a == "-" && b == "-") throw core::InputError("A and B are both stdin");
        const diff::Difference found = diff::compare_contents(
            core::read_file(a), core::display_name(a), core::read_file(b), core::display_name(b), {absolute, relative});
        print(t.output(), found);
        t.report()
            .set("equal", found.equal())
            .set("values", found.values)
            .set("unequal", found.unequal)
            .set("largest", found.largest)
            .set("where", found.where);
        return found.equal() ? cli::Verdict::yes : cli::Verdict::no;
    });
}
