#pragma once

#include <string>
#include <vector>

#include "plugins/paraview/mimetra/filters/proxy_xml.h"

namespace mimetra {

/// The input that comes in at a filter's first port: the first one that the operation needs, where
/// that is a sequence. Null for an operation that begins with something else.
const Input* piped_input(const Operation& operation);

/// Further inputs that the operation needs and that may come in as a mesh, one at each port after
/// the first, or as a file: models.
std::vector<std::string> mesh_inputs(const Operation& operation);

/// What a filter shows at one of its output ports.
struct ShownOutput {
  enum class Content { mesh, table, report };

  Content content = Content::report;
  std::string output = {};  ///< the operation's name for it; none for the report
};

/// What a filter shows, port after port: the first sequence that the operation makes, and
/// its tables; the report of an operation that makes neither.
std::vector<ShownOutput> shown_outputs(const Operation& operation);

/// Filters of the operations that begin with a mesh over time, in the table's order.
std::vector<Proxy> filter_proxies(const OperationTable& table);

}  // namespace mimetra
