#include "plugins/paraview/mimetra/third_party_operations.h"

#include <ranges>
#include <set>

#include <vtkObject.h>
#include <vtkPVPlugin.h>
#include <vtkPVServerManagerPluginInterface.h>

#include "plugins/c/plugins.h"
#include "plugins/paraview/mimetra/filters/filter_proxies.h"
#include "toolkit/operations/operation.h"

using namespace mimetra;

namespace {

std::string name_in_python(std::string label) {
  std::erase(label, ' ');
  return label;
}

/// A ParaView plugin with the filters of all mimetra plugins.
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
  // The toolkit's filters are in the XML that was written with the plugin.
  const std::size_t own = filter_proxies(table).size();
  for (const std::string& problem : add_plugins(table, plugin_folders())) {
    vtkGenericWarningMacro(<< problem);
  }
  std::string xml;
  std::set<std::string> taken = {"mimetraSequence"};
  for (const Proxy& proxy : filter_proxies(table) | std::views::drop(own)) {
    if (taken.insert(name_in_python(proxy.label)).second) {
      xml += proxy_xml(proxy);
    } else {
      vtkGenericWarningMacro(<< "plugins: operation '" << proxy.operation.name
                             << "': " << proxy.label
                             << " is something else in ParaView; it is left out there");
    }
  }
  if (xml.empty()) return;
  // ParaView keeps a pointer to the plugin until it exits.
  static ThirdPartyOperations plugin(
      "<ServerManagerConfiguration>\n  <ProxyGroup name=\"filters\">\n" + xml +
      "  </ProxyGroup>\n</ServerManagerConfiguration>\n");
  vtkPVPlugin::ImportPlugin(&plugin);
}
