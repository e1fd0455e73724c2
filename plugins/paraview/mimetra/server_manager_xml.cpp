// Writes the server manager XML of the plugin from the operations table: what ParaView's menus,
// panels and Python show of the sources and filters.

#include <fstream>
#include <iostream>
#include <set>
#include <string>

#include "plugins/paraview/mimetra/filters/filter_proxies.h"
#include "plugins/paraview/mimetra/filters/reading.h"
#include "toolkit/operations/operation.h"

using namespace mimetra;

namespace {

const std::string kTimes =
    "      <DoubleVectorProperty name=\"TimestepValues\" repeatable=\"1\" information_only=\"1\">\n"
    "        <TimeStepsInformationHelper/>\n      </DoubleVectorProperty>\n";

/// Extensions of the formats that ParaView cannot read itself, as in "npy off".
std::string file_extensions(const OperationTable& table) {
  const std::set<std::string> own = {".obj", ".ply", ".stl"};
  std::string words;
  for (const Format& format : table.formats()) {
    if (!format.read || format.kind != DataKind::sequence) continue;
    for (const std::string& extension : format.extensions) {
      if (own.contains(extension) || extension == Format::kFolder) continue;
      words += (words.empty() ? "" : " ") + extension.substr(1);
    }
  }
  return words;
}

Proxy sequence_proxy(const OperationTable& table, const std::string& name, const std::string& label,
                     const std::string& hints) {
  Operation operation = reading_operation();
  operation.inputs.front().help = table.help(operation.inputs.front());
  return {operation,
          table.parameters_of(operation),
          "vtkMimetraSequence",
          name,
          label,
          {"FileName", "weights"},
          {},
          {},
          kTimes,
          hints + "<DefaultFileNameProperty name=\"FileName\"/>"};
}

/// One proxy for the menu of sources and one for File > Open, because ParaView leaves readers out
/// of menus.
std::string sequence_proxies(const OperationTable& table) {
  return proxy_xml(sequence_proxy(table, "MimetraSequence", "mimetra Sequence",
                                  "<ShowInMenu category=\"mimetra\"/>")) +
         proxy_xml(sequence_proxy(table, "MimetraSequenceReader", "mimetra Sequence Reader",
                                  "<ReaderFactory extensions=\"" + file_extensions(table) +
                                      "\" file_description=\"Mesh sequences (mimetra)\"/>"));
}

}  // namespace

int main(int, char** argv) {
  OperationTable table;
  add_toolkit(table);
  std::string xml = "<ServerManagerConfiguration>\n  <ProxyGroup name=\"sources\">\n" +
                    sequence_proxies(table) + "  </ProxyGroup>\n  <ProxyGroup name=\"filters\">\n";
  for (const Proxy& proxy : filter_proxies(table)) xml += proxy_xml(proxy);
  xml += "  </ProxyGroup>\n</ServerManagerConfiguration>\n";
  if (std::ofstream(argv[1]) << xml << std::flush) return 0;
  std::cerr << argv[1] << ": cannot be written\n";
  return 1;
}
