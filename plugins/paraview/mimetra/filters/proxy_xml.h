#pragma once

#include <string>
#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra {

/// An input that another source or filter provides.
struct Port {
  std::string input;
  std::string property;
  bool optional = false;
};

/// What ParaView must know about a source or filter besides its operation.
struct Proxy {
  Operation operation;
  std::vector<Parameter> parameters;
  std::string class_name;
  std::string name;  ///< unique in its group
  std::string label;
  std::vector<std::string> first;  ///< parameters and inputs shown at once, in this order
  std::vector<Port> ports;
  std::vector<std::string> outputs;  ///< names of the output ports if there are several
  std::string further;               ///< XML of properties that are not parameters
  std::string hints;
};

/// Label of a name: "admm-iterations" becomes "Admm Iterations".
std::string label_of(const std::string& name);

/// Server manager XML of a source or filter: what ParaView's menus, panels and Python show.
std::string proxy_xml(const Proxy& proxy);

}  // namespace mimetra
