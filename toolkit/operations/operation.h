#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/correspondence/landmark_finder.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/data.h"
#include "toolkit/operations/format.h"
#include "toolkit/operations/manifest.h"
#include "toolkit/operations/parameter.h"

namespace mimetra {

/// Something an operation works on.
struct Input {
  std::string name;  ///< "source"; an optional or named one is the option --NAME
  DataKind kind;
  std::string help;
  bool optional = false;
  bool repeated = false;    ///< one or more; only the last positional input
  bool named = false;       ///< an option although it is needed
  bool fields = false;      ///< a sequence whose fields are looked at
  bool identities = false;  ///< a model that keeps its identities; otherwise it is one person
  bool run = false;         ///< the manifest of a run, whose inputs are read too
  bool streamed = false;    ///< frames are read when they are needed, not all at once
  /// A sequence of which only the faces and the rest pose count: what says how sequences are read
  /// (--frames, --weights) is about the others.
  bool shape = false;
  /// An optional one that a command line has in its place among the needed ones.
  bool positional = false;

  /// True where a command line names it by an option.
  bool is_option() const { return (optional && !positional) || named; }
};

/// Something an operation makes.
struct Output {
  std::string name;  ///< "out" is -o, another is --NAME
  DataKind kind;
  std::string help;
  bool optional = false;
  bool repeated = false;  ///< one value for each of the repeated input
  /// ".fit.json": it is written to NAME.fit.json beside the output `out` where no other path is
  /// asked for.
  std::string companion = {};
  /// Its fields matter: a sequence that only formats with fields take.
  bool fields = false;
  /// The formats that it is written in, where its kind has others too; "" is a folder.
  std::vector<std::string> extensions = {};
  /// A correspondence is written beside it where source and target are paired.
  bool paired = false;
  /// A table of blendshape weights, or a sequence that may be written as the weights that drive it.
  bool weights = false;
};

enum class LogLevel { info, warning };
using Log = std::function<void(LogLevel, const std::string&)>;

/// More threads than that are a slip of the one who asks for them.
constexpr int kMostThreads = 1024;

/// One call of an operation: values, not files.
struct Invocation {
  std::map<std::string, std::vector<NamedData>> inputs;
  Parameters parameters;
  /// Outputs asked for and where their values go, in order (no paths for a host that takes values);
  /// others need not be computed.
  std::map<std::string, std::vector<std::filesystem::path>> wanted;
  /// How the call runs: with the ranks of other processes only if the operation is shared. Its
  /// notes become warnings of the log once with_notes_as_warnings() made it.
  Context context;
  Log log;
  /// The program's; empty where it cannot find faces.
  LandmarkFinder landmark_finder = {};

  template <typename T>
  const T& get(const std::string& name) const {
    return std::get<T>(inputs.at(name).front().data);
  }
  template <typename T>
  const T* find(const std::string& name) const {
    return has_input(name) ? &get<T>(name) : nullptr;
  }
  /// The first value of an input. Throws std::out_of_range where it has none.
  const NamedData& input(const std::string& name) const { return inputs.at(name).front(); }
  /// Its frames, all in memory.
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

/// A run that wrote something, ready to be made again.
struct RunRead {
  RunRecord record;
  Invocation invocation;  ///< its inputs, read, and its parameters
};

/// What came of it.
struct Outcome {
  /// By name of the output; several values where an input was repeated.
  std::map<std::string, std::vector<NamedData>> outputs;
  std::string report;   ///< a JSON object, the result for programs
  std::string summary;  ///< the same for people, lines of text
};

/// What an operation prints of its result, as it is called there, and what that means.
struct Measure {
  std::string name;
  std::string meaning;
};

/// An operation, declared once: the command, its help, the reference page and every host's dialog
/// are made of this.
struct Operation {
  std::string name;
  std::string summary;  ///< one line
  std::vector<Input> inputs;
  std::vector<Output> outputs;
  std::vector<Parameter> parameters;
  std::vector<std::string> examples;  ///< two command lines without the program's name
  std::function<Outcome(const Invocation&)> run;
  std::vector<Measure> measures = {};
  /// Options, inputs and outputs that do not go together: a Call refuses them before it reads
  /// anything.
  std::vector<Exclusion> exclusions = {};
  /// Several processes compute it together: frames are dealt out to them, and vertices of the
  /// decomposition. The first one writes.
  bool shared = false;
  /// Bytes that it takes at its peak besides what it is given; none where that is little.
  std::function<double(const Invocation&)> memory = {};
  /// Bytes that it keeps in a file without a name meanwhile, in the folder for temporary files.
  std::function<double(const Invocation&)> scratch = {};
  /// For who asks what a run would do: throws and warns as it would of its inputs, without
  /// computing.
  std::function<void(const Invocation&)> foresee = {};
};

/// All operations and formats of a program; built by its main function and passed down.
class OperationTable {
 public:
  /// Throws std::invalid_argument for a name that is taken, or that two of the operation's inputs,
  /// outputs and parameters (with those of its files) have.
  void add(Operation operation);
  /// Throws std::invalid_argument for an extension that its kind is read or written by already, and
  /// for an option that means something else in an operation.
  void add(Format format);
  /// What finds faces in drawings of meshes. Throws std::invalid_argument where there is one.
  void add(LandmarkFinder finder);

  const std::vector<Operation>& operations() const { return operations_; }
  const std::vector<Format>& formats() const { return formats_; }
  const LandmarkFinder& landmark_finder() const { return landmark_finder_; }  ///< may be empty
  const Operation* find(const std::string& name) const;

  /// The operation's own parameters, those of reading its inputs and of writing its outputs. Throws
  /// std::invalid_argument where an own one has a name of those, or two of those share a name but
  /// not a kind.
  std::vector<Parameter> parameters_of(const Operation& operation) const;
  /// The format that a value of a kind is read from. Throws UsageError, and IoError for a file
  /// whose extension no format of the kind has; both list those that are known.
  const Format& reader(DataKind kind, const std::string& text) const;
  /// The format that an output is written in. Throws UsageError that lists the known extensions.
  const Format& writer(const Output& output, const std::filesystem::path& target) const;
  /// Those of the formats that an input is read from or an output written in, as in Format.
  std::vector<std::string> extensions(const Input& input) const;
  std::vector<std::string> extensions(const Output& output) const;
  /// What an input or output is, for people: its help, and these extensions.
  std::string help(const Input& input) const;
  std::string help(const Output& output) const;
  /// True where that format is a folder.
  bool writes_folder(const Output& output, const std::filesystem::path& target) const;
  /// Makes and removes what that writer would begin with, so that nobody computes for nothing.
  /// Throws OutputError where it cannot be written, exists and not `overwrite`, or would replace
  /// one of `inputs`.
  void check_writable(const Output& output, const std::filesystem::path& target, bool overwrite,
                      const std::vector<std::filesystem::path>& inputs = {}) const;
  /// Where an output's values go, one for each of `names`: the path asked for where there is one
  /// name; otherwise a folder OUT/NAME each, or OUT-NAME.EXT for files.
  std::vector<std::filesystem::path> output_paths(const Output& output,
                                                  const std::filesystem::path& asked,
                                                  const std::vector<std::string>& names) const;
  /// Where a companion goes, given the path of the output `out`.
  std::filesystem::path companion_path(const Operation& operation, const Output& companion,
                                       const std::filesystem::path& out) const;
  /// The table as a JSON array: name, summary, inputs, outputs, parameters, examples.
  std::string json() const;

 private:
  void check_names(const Operation& operation) const;

  std::vector<Operation> operations_;
  std::vector<Format> formats_;
  LandmarkFinder landmark_finder_;
};

/// The operations of the toolkit (info, check, align, geodesic, decompose, regions, transfer,
/// evaluate, convert, retarget) and the formats of io.
void add_toolkit(OperationTable& table);
/// Adds `markers`, which writes what the finder of landmarks finds on two heads to a file, and that
/// file's format.
void add_markers(OperationTable& table);
/// Adds the operations `operations` and `formats`, which list the table they are in. The table must
/// outlive the call.
void add_listing(OperationTable& table);

}  // namespace mimetra
