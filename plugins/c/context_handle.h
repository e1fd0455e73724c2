#pragma once

#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "plugins/c/crossing.h"
#include "plugins/c/mimetra.h"
#include "toolkit/mesh/context.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// A table of operations with its description for the C interface. Both are immutable.
class DescribedTable {
 public:
  /// Describes the operations that `fill` adds.
  explicit DescribedTable(const std::function<void(OperationTable&)>& fill);
  DescribedTable(const DescribedTable&) = delete;
  DescribedTable& operator=(const DescribedTable&) = delete;

  const OperationTable& operations() const { return table_; }
  /// List that ends with NULL.
  const mimetra_operation* const* list() const { return list_.data(); }
  /// List that ends with NULL.
  const mimetra_format* const* formats() const { return format_list_.data(); }
  /// Null if no operation has that name.
  const mimetra_operation* find(const std::string& name) const;
  const std::string& json() const { return json_; }

 private:
  void describe(const Operation& operation);
  void describe(const Format& format);
  template <typename Port>
  const mimetra_port* described(const Port& port, const std::string& help, bool named);
  const mimetra_parameter* described(const Parameter& parameter, std::uint32_t of_files);
  const mimetra_parameter* const* described(const std::vector<Parameter>& all,
                                            const std::vector<Parameter>& reading,
                                            const std::vector<Parameter>& writing);
  const char* kept(const std::string& text);
  const char* const* kept(const std::vector<std::string>& texts);

  OperationTable table_;
  std::string json_;
  std::vector<const mimetra_operation*> list_;
  std::vector<const mimetra_format*> format_list_;
  std::deque<mimetra_operation> operations_;
  std::deque<mimetra_format> formats_;
  std::deque<mimetra_port> ports_;
  std::deque<mimetra_parameter> parameters_;
  std::deque<std::vector<const mimetra_port*>> port_lists_;
  std::deque<std::vector<const mimetra_parameter*>> parameter_lists_;
  std::deque<std::vector<const char*>> text_lists_;
  std::deque<std::string> texts_;
};

}  // namespace mimetra

struct mimetra_context {
  std::shared_ptr<const mimetra::DescribedTable> table;
  mimetra::Log log = {};
  mimetra::Context context = {};
  std::string message = {};

  mimetra_status fail(const std::exception_ptr& error) noexcept {
    try {
      mimetra::Failure failure = mimetra::failure_of(error);
      message = std::move(failure.message);
      return failure.status;
    } catch (...) {
      message.clear();  // not enough memory for a message
      return MIMETRA_FAILED;
    }
  }
};

namespace mimetra {

/// Runs a function of the interface and turns exceptions into status and message.
template <typename Work>
mimetra_status guarded(mimetra_context* context, Work&& work) noexcept {
  if (!context) return MIMETRA_USAGE;
  try {
    work();
    return MIMETRA_OK;
  } catch (...) {
    return context->fail(std::current_exception());
  }
}

/// Returns its argument. Throws UsageError if that is NULL.
template <typename Argument>
Argument* needed(Argument* argument, const char* name) {
  if (!argument) throw UsageError(std::string("the argument '") + name + "' is NULL");
  return argument;
}

}  // namespace mimetra
