#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "toolkit/operations/manifest.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// Where something is written.
struct Destination {
  std::filesystem::path path;
  /// Replace what an earlier run wrote.
  bool overwrite = false;
};

/// What a host asks of an operation.
struct CallRequest {
  const Operation* operation = nullptr;
  /// Of OperationTable::parameters_of() the operation.
  Parameters parameters = Parameters();
  /// Values that the host has, by name of the input.
  std::map<std::string, std::vector<NamedData>> given = {};
  /// What is read when the call is loaded, as people name it, by name of the input; comes after
  /// given values.
  std::map<std::string, std::vector<std::string>> named = {};
  /// Optional outputs whose values are asked for; needed ones always are.
  std::set<std::string> wanted = {};
  /// Outputs that are written, and where; with their companions.
  std::map<std::string, Destination> destinations = {};
  /// A file for the manifest, which also accompanies every output that is written. A manifest of
  /// the same operation may be replaced, unless it accompanies an output.
  std::optional<Destination> manifest = {};
  /// Frames of streamed inputs may be read when they are needed; otherwise all are in memory.
  bool may_stream = false;
  /// Several ranks all make this call, and the first one writes. Notes go to the log, as warnings.
  Context context = {};
  Log log = {};
  /// For the manifest: the command line, and files that were read for it besides the inputs.
  std::vector<std::string> arguments = {};
  std::vector<std::filesystem::path> files = {};
};

/// Throws UsageError unless a value can be given to an input of an operation.
void check_kind(const Operation& operation, const Input& input, const Data& data);

/// What files were read, for the manifest.
struct LoadedInputs {
  std::map<std::string, std::vector<NamedData>> data;
  std::vector<std::filesystem::path> files;
};

/// Reads the inputs of an operation from what the user named (`names`, by name of the input),
/// beside those that a host has already (`given`). `log` receives the readers' notes as warnings.
/// Sequences are read into memory; with `may_stream`, those of streamed inputs are not. Throws what
/// the readers throw.
LoadedInputs load_inputs(const OperationTable& table, const Operation& operation,
                         const Parameters& parameters,
                         const std::map<std::string, std::vector<std::string>>& names,
                         const Log& log, std::map<std::string, std::vector<NamedData>> given = {},
                         bool may_stream = false, const Context& context = {});

/// What the output for one value of a repeated input is called, where `name` is what was read: a
/// person of a model has a name, all else that of its file or folder. Throws UsageError for none.
std::string name_of_output(const Input& input, const std::string& name);

/// Compares the files of all ranks with the first one's by their number, sizes, and first and last
/// 64 kB. Throws MismatchError on ranks that have others.
void check_same_inputs(const std::vector<std::filesystem::path>& inputs, const Context& context);

/// One call of an operation, from what a host asks for to what stands on disk: checks, inputs,
/// wanted outputs, and the manifest that accompanies what is written. load(), run() and write() in
/// this order.
class Call {
 public:
  /// Throws UsageError for an input that is missing or of another kind, for options that
  /// exclude each other, for a parameter of files that applies to none, and for an output that no
  /// writer takes; OutputError for one that cannot be written. Nothing is read yet.
  Call(const OperationTable& table, CallRequest request);

  /// Reads the inputs. Throws what the readers throw, and UsageError where two outputs would be
  /// written to one place.
  void load();
  /// Throws and warns of what a run would refuse later: what the operation foresees, and files
  /// beside the outputs that would be refused where the run's have another content. \pre load()
  void foresee() const;
  /// What the operation is going to get. \pre load()
  const Invocation& invocation() const { return invocation_; }
  /// Also asks for an output's value.
  void want(const std::string& output);
  /// Also gives an input a value, in place of its others.
  void give(const std::string& input, NamedData data);

  /// Runs the operation. Throws what it throws, and MismatchError on a process that reads other
  /// inputs than the first. \pre load()
  const Outcome& run();
  /// Writes the outputs that have a path, each with the run's manifest, and the manifest. Throws
  /// what the writers throw; Cancelled while nothing stands yet. \pre run()
  void write();

  /// True where something is written.
  bool writes() const { return !paths_.empty(); }
  Outcome& outcome() { return outcome_; }
  const FinishedRun& finished() const { return finished_; }
  double write_seconds() const { return write_seconds_; }

 private:
  using Paths = std::vector<std::filesystem::path>;

  bool helps_another() const;
  std::optional<Destination> destination_of(const Output& output) const;
  void check_inputs() const;
  void check_exclusions(const HasValue& has_value) const;
  void check_parameters_of_files() const;
  void check_outputs() const;
  void check_manifest() const;
  std::vector<std::string> repeated_names() const;
  Paths inputs_that_stay() const;
  void place_outputs();
  void write_outputs(PendingOutputs& together) const;
  void write_values(const Output& output, const Paths& targets, const std::string& manifest,
                    PendingOutputs& together, const Context& context) const;

  const OperationTable& table_;
  CallRequest request_;
  Invocation invocation_;
  std::map<std::string, Paths> paths_;
  Outcome outcome_;
  FinishedRun finished_;
  double write_seconds_ = 0;
};

}  // namespace mimetra
