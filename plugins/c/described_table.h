#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "plugins/c/mimetra.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// A table of operations, and how the C interface describes it. Neither changes any more.
class DescribedTable {
 public:
  /// Of the operations that `fill` adds.
  explicit DescribedTable(const std::function<void(OperationTable&)>& fill);
  DescribedTable(const DescribedTable&) = delete;
  DescribedTable& operator=(const DescribedTable&) = delete;

  const OperationTable& operations() const { return table_; }
  /// Ends with NULL.
  const mimetra_operation* const* list() const { return list_.data(); }
  /// Null where there is none of that name.
  /// Ends with NULL.
  const mimetra_format* const* formats() const { return format_list_.data(); }
  /// Null where there is none of that name.
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
