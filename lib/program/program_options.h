#pragma once

#include "cli/tool.h"
#include "program/program.h"

#include <optional>
#include <string>

namespace fettle::program {

/// The command-line options of robot programs.
struct ProgramArguments {
    explicit ProgramArguments(cli::Tool& tool);

    /// Is a program wanted?
    bool any() const { return !name_of_first().empty(); }
    /// The first program's option and file; empty: none.
    std::string name_of_first() const;
    std::string option_of_first() const;

    const std::string& rapid;           ///< --rapid
    const std::string& krl;             ///< --krl
    const std::string& fanuc;           ///< --ls
    const std::string& urscript;        ///< --urscript
    const bool& unchecked;              ///< --unchecked
    const std::string& zone;            ///< --zone
    const double& joint_speed;          ///< --joint-speed, %
    const int& output;                  ///< --process-output
    const std::optional<double>& force; ///< --force, N
    const std::string& coupling;        ///< --coupling
};

/// What the first line of a program says about the check of its path: its clearances and digest, or that it is
/// unchecked.
/// @param path  with the joints of its check   @param mm  in the length unit of the path's file
/// @throws InputError if a path is neither checked nor allowed to be unchecked, or was checked with other joints, with
/// the pose, the joint and both values
std::string check_remark(const robot::Robot& robot, const cloud::Cloud& path, const robot::SolvedPath& solved,
                         bool may_be_unchecked, double mm);

/// Writes the programs that the arguments name. @param options  without what the arguments say
void write_programs(cli::Tool& tool, const ProgramArguments& arguments, const robot::Robot& robot,
                    const cloud::Cloud& path, const robot::SolvedPath& solved, ProgramOptions options);

} // namespace fettle::program
