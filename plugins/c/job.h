#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "plugins/c/value.h"

/// One run of a third-party operation, as the operation sees it.
struct mimetra_job {
  /// Keeps references to `operation` and `invocation`. The run may call operations of `table`.
  mimetra_job(const mimetra::Operation& operation, const mimetra::Invocation& invocation,
              std::shared_ptr<const mimetra::DescribedTable> table);
  mimetra_job(const mimetra_job&) = delete;
  mimetra_job& operator=(const mimetra_job&) = delete;

  mimetra_context& context() { return context_; }
  /// Null past the last value of an input, and for an unknown input.
  const mimetra_data* input(const std::string& name, int index) const;
  /// NaN if the parameter has no value or is not a number.
  double number(const std::string& parameter);
  /// Null if the parameter has no value.
  const char* text(const std::string& parameter);
  int threads() const { return invocation_.context.threads(); }
  bool wants(const std::string& output) const { return invocation_.wants(output); }
  /// Reports progress, clamped to [0, 1]. Throws Cancelled.
  void progress(double share);
  /// True once the user has cancelled, even if the plugin ignored it.
  bool cancelled() const { return cancelled_; }
  void log(mimetra::LogLevel level, const std::string& text) const;
  /// Sets the reason why the run fails.
  void fail(const std::string& text);
  /// Throws UsageError if the output is unknown or the value has another kind.
  void output(const std::string& name, const mimetra::NamedData& value);
  /// Throws UsageError if `json` is not a JSON object or `summary` is not UTF-8.
  void report(const std::string& json, const std::string& summary);

  /// Results of the run. Throws std::runtime_error if an output has a wrong number of values.
  mimetra::Outcome outcome() &&;

 private:
  bool goes_on();
  double number_of(const std::string& parameter) const;
  /// Sequence with the same vertices and triangles among the inputs, at `index` for repeated
  /// inputs; null if there is none.
  const mimetra::MeshSequence* given_mesh(const mimetra::Connectivity& faces,
                                          std::size_t index) const;
  std::size_t expected_count(const mimetra::Output& output) const;

  const mimetra::Operation& operation_;
  const mimetra::Invocation& invocation_;
  mimetra_context context_;
  double share_ = 0;
  bool cancelled_ = false;
  std::map<std::string, std::vector<std::unique_ptr<mimetra_data>>> inputs_;
  std::map<std::string, double> numbers_;
  std::map<std::string, std::string> texts_;
  mimetra::Outcome outcome_;
};
