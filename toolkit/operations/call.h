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

/// Where a value is written.
struct Destination {
  std::filesystem::path path;
  /// Replace outputs of an earlier run.
  bool overwrite = false;
};

/// A host's request for one call of an operation.
struct CallRequest {
  const Operation* operation = nullptr;
  /// Parameters that OperationTable::parameters_of() declares for the operation.
  Parameters parameters = Parameters();
  /// Values that the host has, by name of the input.
  std::map<std::string, std::vector<NamedData>> given = {};
  /// Texts from which load() reads inputs, by name of the input. These values follow the given
  /// ones.
  std::map<std::string, std::vector<std::string>> named = {};
  /// Optional outputs to compute; required outputs are always computed.
  std::set<std::string> wanted = {};
  /// Outputs to write, with their companions, and their paths.
  std::map<std::string, Destination> destinations = {};
  /// File for the manifest; each written output also gets one beside it. A manifest of the same
  /// operation may be replaced, unless it accompanies an output.
  std::optional<Destination> manifest = {};
  /// Frames of streamed inputs may be read on demand; otherwise all frames are in memory.
  bool may_stream = false;
  /// All ranks make the same call, and rank 0 writes. Notes become warnings of the log.
  Context context = {};
  Log log = {};
  /// For the manifest: the command line, and files besides the inputs that were read for it.
  std::vector<std::string> arguments = {};
  std::vector<std::filesystem::path> files = {};
};

/// Throws UsageError if an input of an operation does not take the value.
void check_kind(const Operation& operation, const Input& input, const Data& data);

/// Values of the inputs, and the files that were read, for the manifest.
struct LoadedInputs {
  std::map<std::string, std::vector<NamedData>> data;
  std::vector<std::filesystem::path> files;
};

/// Reads the inputs of an operation from the user's texts (`names`, by name of the input). `given`
/// contains values that the host has already. `log` receives the readers' notes as warnings.
/// Sequences are read into memory, except streamed inputs with `may_stream`. Throws what the
/// readers throw.
LoadedInputs load_inputs(const OperationTable& table, const Operation& operation,
                         const Parameters& parameters,
                         const std::map<std::string, std::vector<std::string>>& names,
                         const Log& log, std::map<std::string, std::vector<NamedData>> given = {},
                         bool may_stream = false, const Context& context = {});

/// Name of the output for one value of a repeated input. Returns a model's own `name`, and the stem
/// of other files or folders `name`. Throws UsageError if that is empty.
std::string name_of_output(const Input& input, const std::string& name);

/// Compares the files of all ranks with the files of rank 0: their number, sizes, and first and
/// last 64 kB. Throws MismatchError on ranks with different files.
void check_same_inputs(const std::vector<std::filesystem::path>& inputs, const Context& context);

/// One call of an operation, from a host's request to files on disk. It makes checks, reads inputs,
/// and writes outputs with their manifests. Call load(), run() and write() in this order.
class Call {
 public:
  /// Checks the request without reading the inputs. Throws UsageError for an input that is missing
  /// or of the wrong kind, and for options that exclude each other. Throws UsageError for a
  /// parameter of files that applies to no file, and for an output that no format can write. Throws
  /// OutputError for an output that cannot be written.
  Call(const OperationTable& table, CallRequest request);

  /// Reads the inputs. Throws what the readers throw, and UsageError if two outputs would be
  /// written to one place.
  void load();
  /// Reports what a run would refuse later, by exceptions and warnings. Covers the operation's own
  /// checks, and files beside the outputs that would have other contents. \pre load()
  void foresee() const;
  /// Inputs and parameters of the operation's run. \pre load()
  const Invocation& invocation() const { return invocation_; }
  /// Requests the value of a further output.
  void want(const std::string& output);
  /// Gives an input a value, which replaces its other values.
  void give(const std::string& input, NamedData data);

  /// Runs the operation. Throws what it throws, and MismatchError on a process that reads other
  /// inputs than rank 0. \pre load()
  const Outcome& run();
  /// Writes the outputs that have a path, each with the run's manifest, and the separate manifest.
  /// Throws what the writers throw, and Cancelled while no output is in place. \pre run()
  void write();

  /// True if any output is written.
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
