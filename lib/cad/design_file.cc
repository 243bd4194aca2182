#include "cad/design_file.h"

#include "cad/step_placements.h"
#include "core/content.h"
#include "core/error.h"
#include "core/file.h"
#include "core/text.h"

#include <IGESCAFControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Check.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Standard_Failure.hxx>
#include <StepBasic_SiUnit.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <StepRepr_Representation.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepShape_ConnectedFaceSet.hxx>
#include <StepShape_Face.hxx>
#include <StepShape_SolidModel.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <TransferBRep.hxx>
#include <XCAFApp_Application.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fettle::cad {
namespace {

/// A STEP file begins with this word, after blanks and comments.
bool looks_like_step(std::string_view bytes)
{
    constexpr std::string_view kWord = "ISO-10303-21";
    constexpr std::size_t kMaxComment = 4096; // characters before the word
    return bytes.substr(0, kMaxComment).find(kWord) != std::string_view::npos;
}

/// Column 73 of each line of an IGES file has the letter of its section, and the numbers of lines follow.
bool looks_like_iges(std::string_view bytes)
{
    constexpr std::size_t kLetter = 72;
    if (bytes.size() < kLetter + 8) return false;
    const std::string_view first = bytes.substr(0, kLetter + 8);
    return first.find('\n') == std::string_view::npos && (first[kLetter] == 'S' || first[kLetter] == 'C') &&
           first[kLetter + 7] == '1' &&
           std::ranges::all_of(first.substr(kLetter + 1, 6), [](char c) { return c == ' ' || c == '0'; });
}

/// OpenCASCADE takes a unit that it does not know for a millimetre, and calls it by its prefix or not at all.
bool is_length_unit(std::string name)
{
    constexpr std::array kOthers = {"inch", "in", "foot", "ft", "yard", "mile", "mil", "micron", "mm", "cm", "m"};
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return name.ends_with("metre") || name.ends_with("meter") || std::ranges::find(kOthers, name) != kOthers.end();
}

/// The messages of a check's failures, as one.
std::string failure_of(const Handle(Interface_Check) & check)
{
    return !check.IsNull() && check->NbFails() > 0 ? std::string(check->CFail(1)) : std::string();
}

/// Faces and solids that OpenCASCADE could not build it leaves out without an error.
void check_all_built(const STEPControl_Reader& reader, const std::string& source)
{
    const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
    const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
    const auto refuse = [&](const Handle(Standard_Transient) & entity, const std::string& kind) {
        const Handle(Transfer_Binder) binder = process->Find(entity);
        const std::string reason = binder.IsNull() ? "" : failure_of(binder->Check());
        const std::string label = model->StringLabel(entity)->ToCString();
        throw core::InputError(source, kind + " " + label + " cannot be built" + (reason.empty() ? "" : ": " + reason));
    };
    const auto is_built = [&](const Handle(Standard_Transient) & entity) {
        return !TransferBRep::ShapeResult(process, entity).IsNull();
    };
    for (int i = 1; i <= model->NbEntities(); ++i) {
        const Handle(Standard_Transient) entity = model->Value(i);
        if (process->Find(entity).IsNull()) continue; // nothing that is placed refers to it
        if (entity->IsKind(STANDARD_TYPE(StepShape_SolidModel)) && !is_built(entity)) refuse(entity, "the solid");
        const Handle(StepShape_ConnectedFaceSet) shell = Handle(StepShape_ConnectedFaceSet)::DownCast(entity);
        for (int k = 1; !shell.IsNull() && k <= shell->NbCfsFaces(); ++k)
            if (!is_built(shell->CfsFacesValue(k))) refuse(shell->CfsFacesValue(k), "the face");
    }
}

void require_read(IFSelect_ReturnStatus status, const std::string& source, const std::string& kind)
{
    if (status != IFSelect_RetDone) throw core::InputError(source, "is no " + kind + " file that can be read whole");
}

/// OpenCASCADE looks for names among the items of all representations, and crashes on one that it does not know.
bool has_unknown_item(const Handle(Interface_InterfaceModel) & model)
{
    for (int i = 1; i <= model->NbEntities(); ++i) {
        const Handle(StepRepr_Representation) representation =
            Handle(StepRepr_Representation)::DownCast(model->Value(i));
        for (int k = 1; !representation.IsNull() && k <= representation->NbItems(); ++k)
            if (representation->ItemsValue(k).IsNull()) return true;
    }
    return false;
}

/// OpenCASCADE takes a unit whose name it does not know for metres; only its check of the entity tells.
/// @throws InputError for such a unit
void check_units(const Handle(Interface_InterfaceModel) & model, const std::string& source)
{
    constexpr Standard_Boolean kSyntactic = Standard_True;
    for (int i = 1; i <= model->NbEntities(); ++i) {
        if (!model->Value(i)->IsKind(STANDARD_TYPE(StepBasic_SiUnit))) continue;
        const Handle(Interface_Check) check = model->Check(i, kSyntactic);
        if (check->HasFailed())
            throw core::InputError(source, std::string("states a unit that is not known: ") + check->CFail(1));
    }
}

/// @return  its unit of length
std::string read_step(const std::string& bytes, const std::string& source, Handle(TDocStd_Document) & document)
{
    STEPCAFControl_Reader reader; // sets the defaults of what follows
    reader.SetNameMode(true);
    reader.SetColorMode(true);
    std::istringstream stream(bytes);
    require_read(reader.ChangeReader().ReadStream(source.c_str(), stream), source, "STEP");
    Interface_Static::SetIVal("read.stepcaf.subshapes.name", has_unknown_item(reader.Reader().WS()->Model()) ? 0 : 1);
    if (reader.Reader().WS()->Model()->NbEntities() == 0) throw core::InputError(source, "holds no STEP entities");
    check_units(reader.Reader().WS()->Model(), source);
    TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
    reader.ChangeReader().FileUnits(lengths, angles, solid_angles);
    if (lengths.IsEmpty()) throw core::InputError(source, "states no unit of length");
    if (const std::string unit = lengths.First().ToCString(); !is_length_unit(unit))
        throw core::InputError(source, "states a unit of length that is not known, '" + unit + "'");
    if (!reader.Transfer(document)) throw core::InputError(source, "holds no shape");
    check_all_built(reader.Reader(), source);
    check_step_placements(reader.Reader(), source);
    return lengths.First().ToCString();
}

/// OpenCASCADE reads IGES from a named file only. This one is in memory: nothing is left of it after a crash.
class NamedBytes {
  public:
    explicit NamedBytes(const std::string& bytes) : file_(memfd_create("design", 0))
    {
        if (file_ < 0) throw core::InputError("no memory for a file");
        std::ofstream(path(), std::ios::binary) << bytes;
    }
    NamedBytes(const NamedBytes&) = delete;
    NamedBytes& operator=(const NamedBytes&) = delete;
    ~NamedBytes() { close(file_); }
    std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

  private:
    int file_;
};

/// @return  its unit of length
std::string read_iges(const std::string& bytes, const std::string& source, Handle(TDocStd_Document) & document)
{
    constexpr std::array kUnits = {"inch", "mm",  "named",  "foot", "mile",     "m",
                                   "km",   "mil", "micron", "cm",   "microinch"};
    constexpr int kNamed = 3; // IGES 5.3, 2.2.4.3.14: the flag by which the unit's name stands in the next parameter
    IGESCAFControl_Reader reader;
    reader.SetNameMode(true);
    reader.SetColorMode(true);
    const NamedBytes file(bytes);
    require_read(reader.ReadFile(file.path().c_str()), source, "IGES");
    const IGESData_GlobalSection& global = reader.IGESModel()->GlobalSection();
    const int flag = global.UnitFlag();
    const std::string name = global.UnitName().IsNull() ? "" : global.UnitName()->ToCString();
    if (flag < 1 || flag > static_cast<int>(kUnits.size()) || (flag == kNamed && !(global.UnitValue() > 0)))
        throw core::InputError(source,
                               "the unit of length is not known: flag " + std::to_string(flag) + ", '" + name + "'");
    if (!reader.Transfer(document)) throw core::InputError(source, "holds no shape");
    return flag == kNamed ? name : kUnits[static_cast<std::size_t>(flag - 1)];
}

/// OpenCASCADE follows references of damaged files to nowhere: what is to be read is read in a process of its own
/// first.
template <typename Read>
void require_no_crash(const std::string& source, const Read& read)
{
    const pid_t child = fork();
    if (child < 0) return; // no more processes
    if (child == 0) {
        const rlimit none = {0, 0};
        setrlimit(RLIMIT_CORE, &none);
        try {
            read();
        } catch (...) { // said by the one that reads it for use
        }
        _exit(0);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    constexpr std::array kCrashes = {SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL};
    if (WIFSIGNALED(status) && std::ranges::find(kCrashes, WTERMSIG(status)) != kCrashes.end())
        throw core::InputError(source, "OpenCASCADE's reader crashes on it: the file is damaged");
}

DesignFile parse_design(const std::string& bytes, const std::string& source, bool is_step)
{
    DesignFile file;
    try {
        XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", file.document);
        file.unit = is_step ? read_step(bytes, source, file.document) : read_iges(bytes, source, file.document);
    } catch (const Standard_Failure& failure) {
        throw core::InputError(source, std::string("OpenCASCADE cannot read it: ") + failure.GetMessageString());
    }
    return file;
}

} // namespace

DesignFile read_design_file(const std::string& path)
{
    const std::string source = core::display_name(path);
    const std::string bytes = core::read_file(path);
    const bool is_step = looks_like_step(bytes);
    if (!is_step && !looks_like_iges(bytes)) {
        core::refuse_other_content(bytes, source, "a design, STEP or IGES");
        throw core::InputError(source, "expected a design, STEP (ISO-10303-21) or IGES");
    }
    Message::DefaultMessenger()->ChangePrinters().Clear(); // OpenCASCADE would print
    require_no_crash(source, [&] { parse_design(bytes, source, is_step); });
    return parse_design(bytes, source, is_step);
}

} // namespace fettle::cad
