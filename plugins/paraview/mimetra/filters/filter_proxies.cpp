#include "plugins/paraview/mimetra/filters/filter_proxies.h"

#include <algorithm>
#include <map>
#include <set>

namespace mimetra {

namespace {

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

const std::string kSideBySide =
    "      <IntVectorProperty name=\"SideBySide\" command=\"SetSideBySide\""
    " number_of_elements=\"1\" default_values=\"1\">\n        <BooleanDomain name=\"bool\"/>\n"
    "        <Documentation>Show the components in rows beside each other; otherwise all stand"
    " where the mesh is.</Documentation>\n      </IntVectorProperty>\n";

const std::string kRunFile =
    "      <StringVectorProperty name=\"RunFile\" command=\"SetRunFile\" number_of_elements=\"1\""
    " default_values=\"\" panel_visibility=\"advanced\">\n"
    "        <FileListDomain name=\"files\"/><Hints><AcceptAnyFile/></Hints>\n"
    "        <Documentation>file for the manifest of each run, which replaces that of an earlier"
    " one; empty for none</Documentation>\n      </StringVectorProperty>\n";

const std::string kInMenu = "<ShowInMenu category=\"mimetra\"/>";
const std::string kChart = "<View type=\"XYChartView\" port=\"1\"/>";

/// Property of the first input port.
constexpr const char* kInput = "Input";

/// ParaView has a menu of its own to save data.
const std::set<std::string> kLeftOut = {"convert"};

/// A filter with a class of its own; the class says why it needs one.
struct OwnFilter {
  std::string class_name;
  std::string label;
  std::vector<std::string> first;
  std::vector<std::string> outputs = {};
  std::string further = {};
  std::string hints = {};
};

const std::map<std::string, OwnFilter>& own_filters() {
  static const std::map<std::string, OwnFilter> filters = {
      {"regions",
       {"vtkMimetraRegions",
        "Regions of Interest",
        {"k", "radius", "coverage"},
        {},
        kDisplayedRegion + kDecompositions}},
      {"decompose",
       {"vtkMimetraComponents",
        "Sparse Components",
        {"k"},
        {"Components", "Weights"},
        kSideBySide + kDecompositions,
        kChart}},
      {"transfer",
       {"vtkMimetraTransfer",
        "Region Transfer",
        {"target", "k", "radius", "coverage", "full", "space"},
        {"Target", "Weights"},
        kDecompositions,
        kChart}},
      {"geodesic", {"vtkMimetraGeodesic", "Geodesic Distance", {"source"}}}};
  return filters;
}

std::vector<Port> ports_of(const Operation& operation) {
  std::vector<Port> ports = {{piped_input(operation)->name, kInput}};
  for (const std::string& name : mesh_inputs(operation)) {
    ports.push_back({name, label_of(name), true});
  }
  return ports;
}

Proxy own_proxy(const Operation& operation, const OwnFilter& filter) {
  return {operation,
          operation.parameters,
          filter.class_name,
          filter.class_name.substr(std::string("vtk").size()),
          filter.label,
          filter.first,
          ports_of(operation),
          filter.outputs,
          filter.further + kRunFile,
          kInMenu + filter.hints};
}

/// Parameters shown at once, for operations with many. Other operations show all of theirs, because
/// the parameters are what the operation is about.
const std::map<std::string, std::vector<std::string>>& first_of_many() {
  static const std::map<std::string, std::vector<std::string>> names = {
      {"evaluate", {"target", "k", "radius", "coverage"}}};
  return names;
}

std::vector<std::string> shown_at_once(const Operation& operation) {
  const auto chosen = first_of_many().find(operation.name);
  if (chosen != first_of_many().end()) return chosen->second;
  std::vector<std::string> names;
  for (const Input& input : operation.inputs) names.push_back(input.name);
  for (const Parameter& parameter : operation.parameters) names.push_back(parameter.name);
  return names;
}

Proxy generic_proxy(const Operation& operation) {
  // ParaView sets properties in the order of their names, capitals first, so this one is set first.
  // No parameter has its name or, in Python, its label.
  const std::string which =
      "      <StringVectorProperty name=\"MimetraOperation\" command=\"SetOperation\""
      " number_of_elements=\"1\" panel_visibility=\"never\" default_values=\"" +
      operation.name + "\"/>\n";
  const std::vector<ShownOutput> shown = shown_outputs(operation);
  std::vector<std::string> outputs;
  std::string hints = kInMenu;
  for (std::size_t port = 0; port < shown.size(); ++port) {
    if (shown.size() > 1) outputs.push_back(label_of(shown[port].output));
    if (shown[port].content == ShownOutput::Content::mesh) continue;
    hints += "<View type=\"SpreadSheetView\" port=\"" + std::to_string(port) + "\"/>";
  }
  return {operation,
          operation.parameters,
          "vtkMimetraOperation",
          "MimetraOperation-" + operation.name,
          "mimetra " + label_of(operation.name),
          shown_at_once(operation),
          ports_of(operation),
          std::move(outputs),
          which + kRunFile,
          std::move(hints)};
}

}  // namespace

const Input* piped_input(const Operation& operation) {
  const auto needed = std::ranges::find(operation.inputs, false, &Input::optional);
  return needed != operation.inputs.end() && needed->kind == DataKind::sequence ? &*needed
                                                                                : nullptr;
}

std::vector<std::string> mesh_inputs(const Operation& operation) {
  std::vector<std::string> names;
  for (const Input& input : operation.inputs) {
    // Two ports cannot have the same name, so a model named "input" is read from a file.
    const bool has_port = input.kind == DataKind::model && label_of(input.name) != kInput;
    if (has_port && !input.optional) names.push_back(input.name);
  }
  return names;
}

std::vector<ShownOutput> shown_outputs(const Operation& operation) {
  std::vector<ShownOutput> shown;
  const auto mesh = std::ranges::find(operation.outputs, DataKind::sequence, &Output::kind);
  if (mesh != operation.outputs.end()) {
    shown.push_back({ShownOutput::Content::mesh, mesh->name});
  }
  for (const Output& output : operation.outputs) {
    if (output.kind != DataKind::table) continue;
    shown.push_back({ShownOutput::Content::table, output.name});
  }
  if (shown.empty()) shown.emplace_back();
  return shown;
}

std::vector<Proxy> filter_proxies(const OperationTable& table) {
  std::vector<Proxy> proxies;
  for (const Operation& operation : table.operations()) {
    if (!piped_input(operation) || kLeftOut.contains(operation.name)) continue;
    const auto own = own_filters().find(operation.name);
    proxies.push_back(own == own_filters().end() ? generic_proxy(operation)
                                                 : own_proxy(operation, own->second));
  }
  return proxies;
}

}  // namespace mimetra
