#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "plugins/c/value.h"
#include "toolkit/operations/call.h"

/// One operation with its inputs and parameters, and the outputs of its last run.
struct mimetra_call {
  /// Throws UsageError for an unknown operation.
  mimetra_call(mimetra_context& owner, const std::string& operation);

  mimetra_context& context() const { return context_; }
  /// Throws UsageError if the name is unknown or the parameter does not accept the text. Null
  /// restores the default.
  void set(const std::string& parameter, const char* text);
  /// Throws UsageError if the input is unknown or the value has another kind.
  void give(const std::string& input, std::shared_ptr<const mimetra::Value> value);
  void read(const std::string& input, const std::string& text);
  /// want() and write() throw UsageError if the output is unknown.
  void want(const std::string& output);
  void write(const std::string& output, const std::string& path, bool overwrite);
  void write_manifest(const std::string& path, bool overwrite);

  /// Throws UsageError if an input is missing, and as readers, operation and writers throw.
  void run();
  /// Values of an output; empty before a run.
  const std::vector<std::shared_ptr<const mimetra::Value>>& output(const std::string& name) const;
  const std::string& report() const { return report_; }
  const std::string& summary() const { return summary_; }

 private:
  const mimetra::Input& input(const std::string& name) const;
  const mimetra::Output& declared_output(const std::string& name) const;
  mimetra::CallRequest request() const;

  mimetra_context& context_;
  const mimetra::Operation& operation_;
  mimetra::Parameters declared_;
  std::map<std::string, mimetra::ParameterValue> values_;
  std::map<std::string, std::vector<std::shared_ptr<const mimetra::Value>>> given_;
  std::map<std::string, std::vector<std::string>> read_;
  std::set<std::string> wanted_;
  std::map<std::string, mimetra::Destination> destinations_;
  std::optional<mimetra::Destination> manifest_;
  std::map<std::string, std::vector<std::shared_ptr<const mimetra::Value>>> outputs_;
  std::string report_;
  std::string summary_;
};
