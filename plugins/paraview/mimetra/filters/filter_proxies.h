#pragma once

#include <string>
#include <vector>

#include "plugins/paraview/mimetra/filters/proxy_xml.h"

namespace mimetra {

/// Input at a filter's first port: the first input that the operation needs, if it is a sequence.
/// Null if the operation begins with something else.
const Input* piped_input(const Operation& operation);

/// Names of the further models that the operation needs. Each comes in as a mesh at a port of its
/// own, or as a file.
std::vector<std::string> mesh_inputs(const Operation& operation);

/// Content of an output port of a filter.
struct ShownOutput {
  enum class Content { mesh, table, report };

  Content content = Content::report;
  std::string output = {};  ///< name of the operation's output; empty for the report
};

/// Contents of a filter's ports: the first sequence that the operation makes, and its tables. If
/// the operation makes neither, its report.
std::vector<ShownOutput> shown_outputs(const Operation& operation);

/// Filters for the operations that begin with a mesh over time (except convert), in the table's
/// order.
std::vector<Proxy> filter_proxies(const OperationTable& table);

}  // namespace mimetra
