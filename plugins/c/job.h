#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "plugins/c/value.h"

/// One run of a third-party operation, from inside.
struct mimetra_job {
  /// Refers to both until it is done; `table` is of the operations it may call.
  mimetra_job(const mimetra::Operation& operation, const mimetra::Invocation& invocation,
              std::shared_ptr<const mimetra::DescribedTable> table);
  mimetra_job(const mimetra_job&) = delete;
  mimetra_job& operator=(const mimetra_job&) = delete;

  mimetra_context& context() { return context_; }
  /// Null past the last value of an input, and for an unknown one.
  const mimetra_data* input(const std::string& name, int index) const;
  /// NaN where it has no value, or no number.
  double number(const std::string& parameter);
  /// Null where it has no value.
  const char* text(const std::string& parameter);
  int threads() const { return invocation_.context.threads(); }
  bool wants(const std::string& output) const { return invocation_.wants(output); }
  /// Throws Cancelled. A share outside [0, 1] counts as the nearest in it.
  void progress(double share);
  /// True once the user has cancelled, whatever became of it.
  bool cancelled() const { return cancelled_; }
  void log(mimetra::LogLevel level, const std::string& text) const;
  /// Says why the run fails.
  void fail(const std::string& text);
  /// Throws UsageError for an unknown output or a value of another kind.
  void output(const std::string& name, const mimetra::NamedData& value);
  /// Throws UsageError where `json` is not a JSON object, or `summary` not UTF-8.
  void report(const std::string& json, const std::string& summary);

  /// Everything that was made. Throws std::runtime_error that names an output which is missing.
  mimetra::Outcome outcome() &&;

 private:
  bool goes_on();
  double number_of(const std::string& parameter) const;
  /// The sequence with these triangles that an input holds, of a repeated input the one at `index`;
  /// null for none.
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
