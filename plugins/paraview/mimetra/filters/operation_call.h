#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/operations/call.h"

/// True where both have one name, place and values; NaN is NaN.
bool same_field(const mimetra::Field& a, const mimetra::Field& b);

/// An operation as a host calls it again and again: what it computed is kept until something that
/// it depends on changes, and a decomposition until the sequence or its own parameters do.
class OperationCall {
 public:
  /// One of the toolkit's operations, or of a plugin's. Throws std::invalid_argument for another.
  explicit OperationCall(const std::string& name);
  explicit OperationCall(mimetra::Operation operation);

  const mimetra::Operation& operation() const { return operation_; }

  /// Sets a parameter, or the path of an input; no text is the default, or no input. Values are
  /// checked when the operation runs. True where something changed.
  bool set(const std::string& name, const mimetra::ParameterValue& value);
  /// True where it has another value than its default, or a path.
  bool is_set(const std::string& name) const { return values_.contains(name); }

  /// True for an input whose fields are looked at.
  bool looks_at_fields(const std::string& input) const;
  /// What names points by their numbers, as a dialog labels it: a parameter, a file, or another
  /// mesh than the first, whose points are in the same order; none where nothing does.
  std::optional<std::string> told_by_numbers() const;
  /// True where distances do not cross from one vertex to another at its position.
  bool keeps_vertices_apart() const;
  /// What an input was given, or null.
  const mimetra::Data* given(const std::string& input) const;
  /// Gives an input its value. True where it is another one than before.
  bool give(const std::string& input, mimetra::NamedData data);
  /// Takes it back.
  void take_back(const std::string& input);

  /// A file for the manifest of each run; no text for none. True where it is another than before.
  bool set_manifest(const std::string& path);

  /// The inputs given, and those read from files, ready to run. Throws what the readers throw,
  /// UsageError without an input that it needs, OutputError for a manifest that cannot be written
  /// or would replace anything but one of the same operation.
  mimetra::Call loaded(const mimetra::Log& log, const mimetra::Context& context) const;

  /// True while what was computed still holds.
  bool is_done() const { return outcome_.has_value(); }
  const mimetra::Outcome& outcome() const { return *outcome_; }
  /// Runs the operation, for the outputs `wanted` and those that are not optional, and writes the
  /// manifest. What it makes as "components-out" is its input `components` from then on. Throws
  /// what it throws.
  const mimetra::Outcome& run(mimetra::Call call, const std::vector<std::string>& wanted);

  /// How often components were computed.
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
