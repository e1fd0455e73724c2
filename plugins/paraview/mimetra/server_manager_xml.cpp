// Writes the server manager XML of the plugin: what ParaView's menus, panels and Python know of the
// sources and filters, made of the operations table.

#include <algorithm>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <mimetra/operations/operation.h>
#include <mimetra/operations/xml_text.h>

#include "filters/reading.h"

using namespace mimetra;

namespace {

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
  std::string label;
  std::vector<std::string> first;  ///< parameters that are shown at once, in this order
  std::vector<Port> ports;
  std::string further;  ///< XML of properties that are no parameters, of further outputs
  std::string hints;
};

/// "admm-iterations" is "Admm Iterations".
std::string label_of(const std::string& name) {
  std::string label = name;
  bool begins = true;
  for (char& c : label) {
    if (begins) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    begins = c == '-';
    if (begins) c = ' ';
  }
  return label;
}

std::string attribute(const std::string& name, const std::string& value) {
  return ' ' + name + "=\"" + escaped_for_xml(value) + '"';
}

std::string range_domain(const std::string& element, const Parameter& parameter) {
  const auto bound = [](const char* name, const std::optional<double>& value) {
    return value ? attribute(name, to_text(*value)) : std::string();
  };
  return "<" + element + " name=\"range\"" + bound("min", parameter.minimum) +
         bound("max", parameter.maximum) + "/>";
}

std::string choice_domain(const std::vector<std::string>& choices) {
  std::string domain = "<StringListDomain name=\"choices\">";
  for (const std::string& choice : choices) {
    domain += "<String" + attribute("value", choice) + "/>";
  }
  return domain + "</StringListDomain>";
}

/// How ParaView holds a value: the kind of property, the setter, and the domain of the values.
struct Holder {
  std::string element;
  std::string command;
  std::string domain;
};

Holder holder_of(const Parameter& parameter) {
  const bool optional = std::holds_alternative<std::monostate>(parameter.fallback);
  switch (optional && parameter.kind != ParameterKind::file ? ParameterKind::text
                                                            : parameter.kind) {
    case ParameterKind::flag:
      return {"IntVectorProperty", "SetInteger", "<BooleanDomain name=\"bool\"/>"};
    case ParameterKind::integer:
      return {"IntVectorProperty", "SetInteger", range_domain("IntRangeDomain", parameter)};
    case ParameterKind::number:
      return {"DoubleVectorProperty", "SetNumber", range_domain("DoubleRangeDomain", parameter)};
    case ParameterKind::choice:
      return {"StringVectorProperty", "SetText", choice_domain(parameter.choices)};
    case ParameterKind::file:
      // What is typed may be a word, a pattern, or a model with an identity.
      return {"StringVectorProperty", "SetText",
              "<FileListDomain name=\"files\"/><Hints><AcceptAnyFile/></Hints>"};
    default:
      return {"StringVectorProperty", "SetText", ""};
  }
}

std::string help_of(const Parameter& parameter) {
  std::string help = parameter.help;
  if (!parameter.unit.empty()) help += " (" + parameter.unit + ")";
  if (parameter.kind == ParameterKind::length) {
    help += "; a share of the rest pose's longest side as in 0.1, or a length as in 12abs";
  }
  if (parameter.kind == ParameterKind::file && !parameter.choices.empty()) {
    help += "; a file, or one of";
    for (const std::string& choice : parameter.choices) help += ' ' + choice;
  }
  if (std::holds_alternative<std::monostate>(parameter.fallback)) help += "; empty for none";
  return help;
}

std::string property_of(const Parameter& parameter, const std::string& label, bool advanced) {
  const Holder holder = holder_of(parameter);
  std::string fallback = to_text(parameter.fallback);
  if (parameter.kind == ParameterKind::flag) fallback = fallback == "true" ? "1" : "0";
  return "      <" + holder.element + attribute("name", parameter.name) +
         attribute("label", label) + attribute("command", holder.command) +
         attribute("initial_string", parameter.name) + " number_of_elements=\"1\"" +
         attribute("default_values", fallback) +
         attribute("panel_visibility", advanced ? "advanced" : "default") + ">\n        " +
         holder.domain + "\n        <Documentation>" + escaped_for_xml(help_of(parameter)) +
         "</Documentation>\n      </" + holder.element + ">\n";
}

std::string port_xml(const Port& port, int index, const std::string& help) {
  return "      <InputProperty" + attribute("name", port.property) +
         attribute("port_index", std::to_string(index)) + " command=\"SetInputConnection\"" +
         (port.optional ? " null_on_empty=\"1\"" : "") +
         ">\n"
         "        <ProxyGroupDomain name=\"groups\"><Group name=\"sources\"/>"
         "<Group name=\"filters\"/></ProxyGroupDomain>\n"
         "        <DataTypeDomain name=\"input_type\"><DataType value=\"vtkPolyData\"/>"
         "</DataTypeDomain>\n" +
         (port.optional ? "        <Hints><Optional/></Hints>\n" : "") + "        <Documentation>" +
         escaped_for_xml(help) + "</Documentation>\n      </InputProperty>\n";
}

/// An input that is a file; where it may come through a port instead, its label says so.
std::string path_xml(const Input& input, bool has_port, bool advanced) {
  return property_of({input.name, ParameterKind::file, {}, input.help},
                     label_of(input.name) + (has_port ? " File" : ""), advanced);
}

/// The property of a parameter, or of an input that may be a file; nothing for one that may not.
std::string property_named(const Proxy& proxy, const std::string& name, bool advanced) {
  const auto& inputs = proxy.operation.inputs;
  const auto input = std::ranges::find(inputs, name, &Input::name);
  if (input == inputs.end()) {
    const auto parameter = std::ranges::find(proxy.parameters, name, &Parameter::name);
    return property_of(*parameter, label_of(name), advanced);
  }
  const auto port = std::ranges::find(proxy.ports, name, &Port::input);
  const bool has_port = port != proxy.ports.end();
  return has_port && !port->optional ? "" : path_xml(*input, has_port, advanced);
}

std::string proxy_xml(const Proxy& proxy) {
  const Operation& operation = proxy.operation;
  std::string xml = "    <SourceProxy" + attribute("class", proxy.class_name) +
                    attribute("name", proxy.class_name.substr(std::string("vtk").size())) +
                    attribute("label", proxy.label) + ">\n      <Documentation" +
                    attribute("short_help", operation.summary) + ">" +
                    escaped_for_xml(operation.summary) + ".</Documentation>\n";
  for (const Input& input : operation.inputs) {
    const auto port = std::ranges::find(proxy.ports, input.name, &Port::input);
    if (port == proxy.ports.end()) continue;
    xml += port_xml(*port, static_cast<int>(port - proxy.ports.begin()), input.help);
  }
  for (const std::string& name : proxy.first) xml += property_named(proxy, name, false);
  const auto add_advanced = [&](const std::string& name) {
    const bool is_first = std::ranges::find(proxy.first, name) != proxy.first.end();
    if (!is_first) xml += property_named(proxy, name, true);
  };
  for (const Input& input : operation.inputs) add_advanced(input.name);
  for (const Parameter& parameter : proxy.parameters) add_advanced(parameter.name);
  return xml + proxy.further + "      <Hints>" + proxy.hints + "</Hints>\n    </SourceProxy>\n";
}

const std::string kTimes =
    "      <DoubleVectorProperty name=\"TimestepValues\" repeatable=\"1\" information_only=\"1\">\n"
    "        <TimeStepsInformationHelper/>\n      </DoubleVectorProperty>\n";

const std::string kDecompositions =
    "      <IntVectorProperty name=\"Decompositions\" command=\"GetDecompositions\""
    " information_only=\"1\">\n        <SimpleIntInformationHelper/>\n"
    "        <Documentation>How often components were computed.</Documentation>\n"
    "      </IntVectorProperty>\n";

const std::string kDisplayedRegion =
    "      <IntVectorProperty name=\"DisplayedRegion\" command=\"SetDisplayedRegion\""
    " number_of_elements=\"1\" default_values=\"-1\">\n"
    "        <IntRangeDomain name=\"range\" min=\"-1\"/>\n"
    "        <Documentation>Region that the point data displayed_region tell of, with what others"
    " cover; -1 for none.</Documentation>\n      </IntVectorProperty>\n";

/// A mesh, and a table over time for the line chart.
std::string with_weights(const std::string& first) {
  return "      <OutputPort name=\"" + first +
         "\" index=\"0\"/>\n"
         "      <OutputPort name=\"Weights\" index=\"1\"/>\n";
}

const std::string kInMenu = "<ShowInMenu category=\"mimetra\"/>";
const std::string kChart = "<View type=\"XYChartView\" port=\"1\"/>";

Proxy sequence_proxy(const OperationTable& table) {
  const Operation operation = reading_operation();
  return {operation,
          table.parameters_of(operation),
          "vtkMimetraSequence",
          "mimetra Sequence",
          {"FileName", "weights"},
          {},
          kTimes,
          kInMenu +
              "<DefaultFileNameProperty name=\"FileName\"/>"
              "<ReaderFactory extensions=\"npy off\""
              " file_description=\"Mesh sequences (mimetra)\"/>"};
}

std::vector<Proxy> filter_proxies(const OperationTable& table) {
  const auto proxy = [&table](const std::string& operation, std::string class_name,
                              std::string label, std::vector<std::string> first,
                              std::vector<Port> ports, std::string further, std::string hints) {
    const Operation& found = *table.find(operation);
    return Proxy{found,
                 found.parameters,
                 std::move(class_name),
                 std::move(label),
                 std::move(first),
                 std::move(ports),
                 std::move(further),
                 std::move(hints)};
  };
  return {proxy("regions", "vtkMimetraRegions", "Regions of Interest", {"k", "radius", "coverage"},
                {{"sequence", "Input"}}, kDisplayedRegion + kDecompositions, kInMenu),
          proxy("decompose", "vtkMimetraComponents", "Sparse Components", {"k"},
                {{"sequence", "Input"}}, with_weights("Components") + kDecompositions,
                kInMenu + kChart),
          proxy("transfer", "vtkMimetraTransfer", "Region Transfer",
                {"target", "k", "radius", "coverage", "full", "space"},
                {{"source", "Input"}, {"target", "Target", true}},
                with_weights("Target") + kDecompositions, kInMenu + kChart),
          proxy("geodesic", "vtkMimetraGeodesic", "Geodesic Distance", {"source"},
                {{"mesh", "Input"}}, "", kInMenu)};
}

}  // namespace

int main(int, char** argv) {
  OperationTable table;
  add_toolkit(table);
  std::string xml = "<ServerManagerConfiguration>\n  <ProxyGroup name=\"sources\">\n" +
                    proxy_xml(sequence_proxy(table)) +
                    "  </ProxyGroup>\n  <ProxyGroup name=\"filters\">\n";
  for (const Proxy& proxy : filter_proxies(table)) xml += proxy_xml(proxy);
  xml += "  </ProxyGroup>\n</ServerManagerConfiguration>\n";
  if (std::ofstream(argv[1]) << xml << std::flush) return 0;
  std::cerr << argv[1] << ": cannot be written\n";
  return 1;
}
