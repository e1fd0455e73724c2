#include "plugins/paraview/mimetra/third_party_operations.h"

#include <algorithm>
#include <set>

#include <vtkObject.h>
#include <vtkPVPlugin.h>
#include <vtkPVServerManagerPluginInterface.h>

#include "plugins/c/plugins.h"
#include "plugins/paraview/mimetra/filters/proxy_xml.h"
#include "toolkit/operations/operation.h"

using namespace mimetra;

namespace {

bool has_frames(DataKind kind) {
  return kind == DataKind::sequence || kind == DataKind::fields;
}

/// One mesh in and one out.
bool is_filter(const Operation& operation) {
  if (operation.inputs.empty()) return false;
  const Input& input = operation.inputs.front();
  const auto out = std::ranges::find(operation.outputs, "out", &Output::name);
  return has_frames(input.kind) && !input.optional && !input.repeated &&
         out != operation.outputs.end() && has_frames(out->kind);
}

std::string filter_label(const Operation& operation) {
  return "mimetra " + label_of(operation.name);
}

std::string name_in_python(std::string label) {
  std::erase(label, ' ');
  return label;
}

std::string filter_xml(const Operation& operation) {
  // ParaView sets properties in the order of their names, capitals first; no parameter has the name
  // or, in Python, the label.
  const std::string which =
      "      <StringVectorProperty name=\"MimetraOperation\" command=\"SetOperation\""
      " number_of_elements=\"1\" panel_visibility=\"never\" default_values=\"" +
      operation.name + "\"/>\n";
  // They are few, and what the operation is about: none is among the advanced ones.
  std::vector<std::string> shown;
  for (const Input& input : operation.inputs) shown.push_back(input.name);
  for (const Parameter& parameter : operation.parameters) shown.push_back(parameter.name);
  return proxy_xml({operation,
                    operation.parameters,
                    "vtkMimetraOperation",
                    "MimetraOperation-" + operation.name,
                    filter_label(operation),
                    shown,
                    {{operation.inputs.front().name, "Input"}},
                    which,
                    "<ShowInMenu category=\"mimetra\"/>"});
}

/// The filters of all plugins, as ParaView knows a plugin of its own.
class ThirdPartyOperations : public vtkPVPlugin, public vtkPVServerManagerPluginInterface {
 public:
  explicit ThirdPartyOperations(std::string xml) : xml_(std::move(xml)) {}

  const char* GetPluginName() override { return "MimetraThirdParty"; }
  const char* GetPluginVersionString() override { return "1.0"; }
  bool GetRequiredOnServer() override { return true; }
  bool GetRequiredOnClient() override { return true; }
  const char* GetRequiredPlugins() override { return "Mimetra"; }
  const char* GetDescription() override { return "Third-party operations of mimetra"; }
  const char* GetEULA() override { return nullptr; }
  void GetXMLs(std::vector<std::string>& xmls) override { xmls.push_back(xml_); }
  vtkClientServerInterpreterInitializer::InterpreterInitializationCallback
  GetInitializeInterpreterCallback() override {
    return nullptr;
  }

 private:
  std::string xml_;
};

}  // namespace

void add_third_party_operations() {
  OperationTable table;
  add_toolkit(table);
  const std::size_t own = table.operations().size();
  for (const std::string& problem : add_plugins(table, plugin_folders())) {
    vtkGenericWarningMacro(<< problem);
  }
  std::string xml;
  std::set<std::string> taken = {"mimetraSequence"};
  for (std::size_t i = own; i < table.operations().size(); ++i) {
    const Operation& operation = table.operations()[i];
    if (!is_filter(operation)) continue;
    if (taken.insert(name_in_python(filter_label(operation))).second) {
      xml += filter_xml(operation);
    } else {
      vtkGenericWarningMacro(<< "plugins: operation '" << operation.name
                             << "': " << filter_label(operation)
                             << " is something else in ParaView; it is left out there");
    }
  }
  if (xml.empty()) return;
  // ParaView keeps a pointer to it to its end.
  static ThirdPartyOperations plugin(
      "<ServerManagerConfiguration>\n  <ProxyGroup name=\"filters\">\n" + xml +
      "  </ProxyGroup>\n</ServerManagerConfiguration>\n");
  vtkPVPlugin::ImportPlugin(&plugin);
}
