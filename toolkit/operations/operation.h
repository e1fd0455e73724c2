#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/correspondence/landmark_finder.h"
#include "toolkit/io/data.h"
#include "toolkit/io/format.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parameter.h"
#include "toolkit/operations/manifest.h"

namespace mimetra {

struct Input {
  std::string name;  ///< "source"; an optional or named one is the option --NAME
  DataKind kind;
  std::string help;
  bool optional = false;
  bool repeated = false;    ///< one value or more; only for the last positional input
  bool named = false;       ///< an option although it is required
  bool fields = false;      ///< a sequence that is read with its fields
  bool identities = false;  ///< a model that keeps its identities; otherwise it is one person
  bool run = false;         ///< the manifest of a run, whose inputs are also read
  bool streamed = false;    ///< frames are read on demand, not all at once
  /// Only the faces and the rest pose of the sequence count. Parameters for reading sequences
  /// (--frames, --weights) do not apply to it.
  bool shape = false;
  /// An optional input that is positional on a command line.
  bool positional = false;

  /// True if a command line gives it by an option.
  bool is_option() const { return (optional && !positional) || named; }
};

struct Output {
  std::string name;  ///< "out" is -o, others are --NAME
  DataKind kind;
  std::string help;
  bool optional = false;
  bool repeated = false;  ///< one value for each value of the repeated input
  /// Ending such as ".fit.json": by default the output is written to NAME.fit.json beside the
  /// output `out`.
  std::string companion = {};
  /// A sequence that only formats with fields can write.
  bool fields = false;
  /// Formats to which the output is restricted; "" is a folder. Empty for all formats of its kind.
  std::vector<std::string> extensions = {};
  /// If source and target are paired, a correspondence is written beside the output.
  bool paired = false;
  /// A table of blendshape weights, or a sequence that may be written as the weights that drive it.
  bool weights = false;
};

enum class LogLevel { info, warning };
using Log = std::function<void(LogLevel, const std::string&)>;

/// Larger numbers of threads are refused as typing errors.
constexpr int kMostThreads = 1024;

/// One call of an operation, with values instead of files.
struct Invocation {
  std::map<std::string, std::vector<NamedData>> inputs;
  Parameters parameters;
  /// Outputs to compute, and the paths of their values in order. Paths are empty for a host that
  /// takes values. Other outputs need not be computed.
  std::map<std::string, std::vector<std::filesystem::path>> wanted;
  /// Ranks are available only if the operation is shared. Notes become warnings of the log after
  /// with_notes_as_warnings().
  Context context;
  Log log;
  /// The program's finder; empty if the program cannot find faces.
  LandmarkFinder landmark_finder = {};

  template <typename T>
  const T& get(const std::string& name) const {
    return std::get<T>(inputs.at(name).front().data);
  }
  template <typename T>
  const T* find(const std::string& name) const {
    return has_input(name) ? &get<T>(name) : nullptr;
  }
  /// First value of an input. Throws std::out_of_range if there is none.
  const NamedData& input(const std::string& name) const { return inputs.at(name).front(); }
  /// The input's frames, all in memory.
  const MeshSequence& sequence(const std::string& name) const {
    return get<FieldSequence>(name).sequence();
  }
  bool has_input(const std::string& name) const {
    const auto found = inputs.find(name);
    return found != inputs.end() && !found->second.empty();
  }
  bool wants(const std::string& output) const { return wanted.contains(output); }
  void warn(const std::string& message) const;
  void info(const std::string& message) const;
};

/// A run that wrote outputs, ready to be repeated.
struct RunRead {
  RunRecord record;
  Invocation invocation;  ///< inputs, read again, and parameters
};

/// Result of a call.
struct Outcome {
  /// Values by name of the output; several if an input was repeated.
  std::map<std::string, std::vector<NamedData>> outputs;
  std::string report;   ///< a JSON object, the result for programs
  std::string summary;  ///< the result for people, lines of text
};

/// A quantity in the printed result, with its name there and its meaning.
struct Measure {
  std::string name;
  std::string meaning;
};

/// An operation, declared once. The command, its help, the reference page and every host's dialog
/// use this declaration.
struct Operation {
  std::string name;
  std::string summary;  ///< one line
  std::vector<Input> inputs;
  std::vector<Output> outputs;
  std::vector<Parameter> parameters;
  std::vector<std::string> examples;  ///< two command lines without the program's name
  std::function<Outcome(const Invocation&)> run;
  std::vector<Measure> measures = {};
  /// Options, inputs and outputs that exclude each other. A Call refuses them before it reads
  /// anything.
  std::vector<Exclusion> exclusions = {};
  /// Several processes compute the operation together: they share out frames, and vertices of the
  /// decomposition. Rank 0 writes.
  bool shared = false;
  /// Peak memory in bytes besides the inputs; empty if it is small.
  std::function<double(const Invocation&)> memory = {};
  /// Bytes of an unnamed temporary file, in the folder for temporary files.
  std::function<double(const Invocation&)> scratch = {};
  /// Checks the inputs and reports what a run would do, without computing. Throws and warns as
  /// run() would.
  std::function<void(const Invocation&)> foresee = {};
};

/// All operations and formats of a program, built by its main function and passed down.
class OperationTable {
 public:
  /// Throws std::invalid_argument if the name is in use. Also throws if two inputs, outputs or
  /// parameters of the operation, including the parameters of its files, share a name.
  void add(Operation operation);
  /// Throws std::invalid_argument for an extension that the kind already reads or writes, and for a
  /// parameter that means something else in an operation.
  void add(Format format);
  /// Sets the function that finds faces in drawings of meshes. Throws std::invalid_argument if
  /// there is one already.
  void add(LandmarkFinder finder);

  const std::vector<Operation>& operations() const { return operations_; }
  const std::vector<Format>& formats() const { return formats_; }
  const LandmarkFinder& landmark_finder() const { return landmark_finder_; }  ///< may be empty
  const Operation* find(const std::string& name) const;

  /// Returns the operation's own parameters, then the parameters for reading its inputs and writing
  /// its outputs. Throws std::invalid_argument if an operation's own parameter shares a name with
  /// one of files. Also throws if parameters of files share a name but not a kind.
  std::vector<Parameter> parameters_of(const Operation& operation) const;
  /// Returns the format that reads a value of a kind. Throws UsageError if there is none. Throws
  /// IoError for a file with an unknown extension, and lists the known ones.
  const Format& reader(DataKind kind, const std::string& text) const;
  /// Returns the format that writes an output. Throws UsageError that lists the known extensions.
  const Format& writer(const Output& output, const std::filesystem::path& target) const;
  /// Extensions of the formats that read an input or write an output, as in Format.
  std::vector<std::string> extensions(const Input& input) const;
  std::vector<std::string> extensions(const Output& output) const;
  /// Describes an input or output for people: its help, and these extensions.
  std::string help(const Input& input) const;
  std::string help(const Output& output) const;
  /// True if that format is a folder.
  bool writes_folder(const Output& output, const std::filesystem::path& target) const;
  /// Tests whether the writer could start, before any computation, and removes the test's files.
  /// Throws OutputError if the target cannot be written, if it exists without `overwrite`, or if it
  /// would replace one of `inputs`.
  void check_writable(const Output& output, const std::filesystem::path& target, bool overwrite,
                      const std::vector<std::filesystem::path>& inputs = {}) const;
  /// Paths of an output's values, one for each of `names`. For one name this is `asked`; otherwise
  /// a folder OUT/NAME, or a file OUT-NAME.EXT.
  std::vector<std::filesystem::path> output_paths(const Output& output,
                                                  const std::filesystem::path& asked,
                                                  const std::vector<std::string>& names) const;
  /// Path of a companion, given the path of the output `out`.
  std::filesystem::path companion_path(const Operation& operation, const Output& companion,
                                       const std::filesystem::path& out) const;
  /// Returns the operations as a JSON array: name, summary, inputs, outputs, parameters, examples.
  std::string json() const;

 private:
  void check_names(const Operation& operation) const;

  std::vector<Operation> operations_;
  std::vector<Format> formats_;
  LandmarkFinder landmark_finder_;
};

/// Adds the operations of the toolkit (toolkit_operations.h) and the formats of files.
void add_toolkit(OperationTable& table);
/// Adds the operation `markers` and the format of its file. The operation searches for landmarks on
/// two heads and writes them.
void add_markers(OperationTable& table);
/// Adds the operations `operations` and `formats`, which list the table that contains them. The
/// table must outlive the call.
void add_listing(OperationTable& table);

}  // namespace mimetra
