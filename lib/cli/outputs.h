#pragma once

#include "core/file.h"

#include <iosfwd>
#include <list>
#include <memory>
#include <string>
#include <vector>

namespace fettle::cli {

/// Prepares the process before it opens a file: a file must not get the number of a closed stdin, stdout or stderr, and
/// a write beyond the file size limit must fail instead of killing the process.
void guard_standard_streams();

/// All outputs of a tool: the main output and the files that options name. They are written atomically, all together or
/// none. No two outputs may name the same file, and none may replace an input. The strings of names are those that the
/// command line fills in; they must be set before open().
class Outputs {
  public:
    /// Declares an input, which no output may replace except as declared.
    void add_input(const std::string& input) { inputs_.push_back(&input); }
    /// Declares an output. @param may_replace  the input that it is derived from and may replace, or null
    void declare(const std::string& path, const std::string* may_replace);
    /// Reserves and opens all declared outputs.
    /// @param main_output  its name; null: none   @param main_input  the input that it may replace, or null
    /// @throws InputError as reserve(), or if an output cannot be written
    void open(const std::string* main_output, const std::string* main_input);

    /// Reserves a name for a file that is not written through this class.
    /// @throws InputError if it names another output, or an input, which would be lost
    void reserve(const std::string& path) { reserve(path, nullptr); }
    std::ostream& main();
    /// Stream of another output, declared or not. @throws InputError as reserve()
    std::ostream& file(const std::string& path);

    /// Gives all used outputs their names, or none of them if one cannot be written.
    /// @throws InputError
    void commit();

  private:
    struct Declared {
        const std::string* path;
        const std::string* may_replace;
    };
    struct Other {
        explicit Other(const std::string& name) : path(name), file(name) {}
        std::string path;
        core::OutputFile file;
        bool is_used = false;
    };
    void reserve(const std::string& path, const std::string* may_replace);

    std::vector<const std::string*> inputs_;
    std::vector<Declared> declared_;
    std::vector<std::string> reserved_; ///< names
    std::unique_ptr<core::OutputFile> main_;
    bool uses_main_ = false;
    std::list<Other> others_;
};

} // namespace fettle::cli
