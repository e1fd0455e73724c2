#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/operations/call.h"

/// Returns whether two fields have the same name, place and values. NaN equals NaN.
bool same_field(const mimetra::Field& a, const mimetra::Field& b);

/// An operation that a host calls repeatedly. Keeps the outcome until something that it depends on
/// changes. Keeps a decomposition until the sequence or the decomposition's own parameters change.
class OperationCall {
 public:
  /// Takes an operation of the toolkit or of a plugin. Throws std::invalid_argument if the name is
  /// unknown.
  explicit OperationCall(const std::string& name);
  explicit OperationCall(mimetra::Operation operation);

  const mimetra::Operation& operation() const { return operation_; }

  /// Sets a parameter, or the path of an input. Empty text restores the default or removes the
  /// input. Values are checked when the operation runs. Returns whether something changed.
  bool set(const std::string& name, const mimetra::ParameterValue& value);
  /// Returns whether `name` has a value other than its default, or a path.
  bool is_set(const std::string& name) const { return values_.contains(name); }

  /// Returns whether the operation reads the fields of an input.
  bool looks_at_fields(const std::string& input) const;
  /// Value that an input was given, or null.
  const mimetra::Data* given(const std::string& input) const;
  /// Gives an input its value. Returns whether the value differs from the one before.
  bool give(const std::string& input, mimetra::NamedData data);
  /// Removes the value of an input.
  void take_back(const std::string& input);

  /// Sets a file for the manifest of each run; empty text for none. Returns whether the file
  /// changed.
  bool set_manifest(const std::string& path);

  /// Call with the given inputs and those read from files, ready to run. Throws what the readers
  /// throw, and UsageError if a needed input is missing. Throws OutputError if the manifest cannot
  /// be written, or would replace a file other than a manifest of the same operation.
  mimetra::Call loaded(const mimetra::Log& log, const mimetra::Context& context) const;

  /// Returns whether the outcome is still valid.
  bool is_done() const { return outcome_.has_value(); }
  const mimetra::Outcome& outcome() const { return *outcome_; }
  /// Runs the operation for the outputs `wanted` and those that are not optional, and writes the
  /// manifest. The output "components-out" becomes the input `components` of later runs. Throws
  /// what the operation throws.
  const mimetra::Outcome& run(mimetra::Call call, const std::vector<std::string>& wanted);

  /// Number of times that components were computed.
  int decompositions() const { return decompositions_; }

 private:
  mimetra::Parameters parameters() const;
  void check_inputs() const;
  bool has_input(const std::string& name) const;
  bool is_default(const std::string& name, const mimetra::ParameterValue& value) const;
  bool is_of_decomposition(const std::string& name) const;

  mimetra::OperationTable table_;
  mimetra::Operation operation_;
  std::map<std::string, mimetra::ParameterValue> values_;
  std::map<std::string, mimetra::NamedData> given_;
  std::string manifest_;
  std::optional<mimetra::Outcome> outcome_;
  std::optional<mimetra::NamedData> components_;
  int decompositions_ = 0;
};
