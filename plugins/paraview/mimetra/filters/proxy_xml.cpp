#include "plugins/paraview/mimetra/filters/proxy_xml.h"

#include <algorithm>
#include <cctype>

#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

std::string attribute(const std::string& name, const std::string& value) {
  return ' ' + name + "=\"" + escaped_for_xml(value) + '"';
}

std::string range_domain(const std::string& element, const Parameter& parameter) {
  const auto bound = [](const char* name, const std::string& text) {
    return text.empty() ? text : attribute(name, text);
  };
  return "<" + element + " name=\"range\"" + bound("min", parameter.minimum_text()) +
         bound("max", parameter.maximum_text()) + "/>";
}

std::string choice_domain(const std::vector<std::string>& choices) {
  std::string domain = "<StringListDomain name=\"choices\">";
  for (const std::string& choice : choices) {
    domain += "<String" + attribute("value", choice) + "/>";
  }
  return domain + "</StringListDomain>";
}

/// Property for a value in ParaView: its element, its setter, and the domain of its values.
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
      // The typed text may be a word, a pattern, or a model with an identity.
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
    help += "; a share of the rest pose's diameter as in 0.1, or a length as in 12abs";
  }
  const bool is_file = parameter.kind == ParameterKind::file;
  const bool optional = std::holds_alternative<std::monostate>(parameter.fallback);
  // A choice with a default is picked from a list, which shows the choices.
  if (!parameter.choices.empty() && (is_file || optional)) {
    help += is_file ? "; a file, or one of" : "; one of";
    for (const std::string& choice : parameter.choices) help += ' ' + choice;
  }
  if (optional) help += "; empty for none";
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

std::string output_port_xml(const std::string& name, std::size_t index) {
  return "      <OutputPort" + attribute("name", name) + attribute("index", std::to_string(index)) +
         "/>\n";
}

/// Label of a property. Appends `held` if a port has the same name, because Python accesses both by
/// their labels.
std::string label_beside_ports(const Proxy& proxy, const std::string& name,
                               const std::string& held) {
  const std::string label = label_of(name);
  const bool is_taken = std::ranges::find(proxy.ports, label, &Port::property) != proxy.ports.end();
  return is_taken ? label + ' ' + held : label;
}

/// Property of a parameter, or of an input that may be a file. Empty for other inputs.
std::string property_named(const Proxy& proxy, const std::string& name, bool advanced) {
  const auto& inputs = proxy.operation.inputs;
  const auto input = std::ranges::find(inputs, name, &Input::name);
  if (input == inputs.end()) {
    const auto parameter = std::ranges::find(proxy.parameters, name, &Parameter::name);
    return property_of(*parameter, label_beside_ports(proxy, name, "Value"), advanced);
  }
  const auto port = std::ranges::find(proxy.ports, name, &Port::input);
  const bool has_port = port != proxy.ports.end();
  if (has_port && !port->optional) return "";
  // An input that may stay empty has no default.
  const auto fallback = input->optional || has_port ? ParameterValue() : ParameterValue("");
  return property_of({input->name, ParameterKind::file, fallback, input->help},
                     label_beside_ports(proxy, name, "File"), advanced);
}

}  // namespace

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

std::string proxy_xml(const Proxy& proxy) {
  const Operation& operation = proxy.operation;
  std::string xml = "    <SourceProxy" + attribute("class", proxy.class_name) +
                    attribute("name", proxy.name) + attribute("label", proxy.label) +
                    ">\n      <Documentation" + attribute("short_help", operation.summary) + ">" +
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
  for (std::size_t i = 0; i < proxy.outputs.size(); ++i) {
    xml += output_port_xml(proxy.outputs[i], i);
  }
  return xml + proxy.further + "      <Hints>" + proxy.hints + "</Hints>\n    </SourceProxy>\n";
}

}  // namespace mimetra
