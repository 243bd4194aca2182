#pragma once

#include "core/file.h"

#include <iosfwd>
#include <list>
#include <memory>
#include <string>
#include <vector>

namespace fettle {

/// For the whole program, before it opens a file: what is closed of stdin, stdout and stderr is not mistaken for one,
/// and a file that may not grow is a failed write.
void prepare_to_write();

/// All that a tool writes: the bulk output and the files that options name. They appear whole when all is done, or not
/// at all; no two have one name, and none takes the place of an input. Names are those on the command line: they may
/// be filled in until open().
class Outputs {
  public:
    /// An input, which no output may replace but as it is said below.
    void protect(const std::string& input) { inputs_.push_back(&input); }
    /// @param may_replace  the input that it is made of and whose place it may take, or null
    void declare(const std::string& path, const std::string* may_replace);
    /// Claims and opens what is declared, before any work. @param bulk  its name, or null: there is none
    /// @param bulk_input  which the bulk output may replace, or null
    /// @throws InputError as claim(), or if one could not be written
    void open(const std::string* bulk, const std::string* bulk_input);

    /// A file that the work itself writes.
    /// @throws InputError if it is another output, or an input: that would be lost
    void claim(const std::string& path) { claim(path, nullptr); }
    std::ostream& bulk();
    /// Whether it was declared or not. @throws InputError as claim()
    std::ostream& file(const std::string& path);

    /// What was written gets its names; where one cannot be written none does. Nothing is left of the others.
    /// @throws InputError
    void commit();

  private:
    struct Declared {
        const std::string* path;
        const std::string* may_replace;
    };
    /// Nothing happens to its file before something is written.
    struct Other {
        explicit Other(const std::string& name) : path(name), file(name) {}
        std::string path;
        OutputFile file;
        bool is_used = false;
    };
    void claim(const std::string& path, const std::string* may_replace);

    std::vector<const std::string*> inputs_;
    std::vector<Declared> declared_;
    std::vector<std::string> claimed_; ///< names
    std::unique_ptr<OutputFile> bulk_;
    bool has_bulk_ = false; ///< something is written there
    std::list<Other> others_;
};

} // namespace fettle
