#pragma once

#include <string>
#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra {

/// An input that another source or filter brings.
struct Port {
  std::string input;
  std::string property;
  bool optional = false;
};

/// What ParaView has to know of a source or filter beside its operation.
struct Proxy {
  Operation operation;
  std::vector<Parameter> parameters;
  std::string class_name;
  std::string name;  ///< unique in its group
  std::string label;
  std::vector<std::string> first;  ///< parameters that are shown at once, in this order
  std::vector<Port> ports;
  std::vector<std::string> outputs;  ///< names of the output ports, where there are several
  std::string further;               ///< XML of properties that are no parameters
  std::string hints;
};

/// "admm-iterations" is "Admm Iterations".
std::string label_of(const std::string& name);

/// The server manager XML of a source or filter: what ParaView's menus, panels and Python know.
std::string proxy_xml(const Proxy& proxy);

}  // namespace mimetra
