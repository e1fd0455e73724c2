// Writes the server manager XML of the plugin: what ParaView's menus, panels and Python know of the
// sources and filters, made of the operations table.

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

/// "npy off": the formats that ParaView has no reader of its own for.
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

Proxy sequence_proxy(const OperationTable& table) {
  Operation operation = reading_operation();
  operation.inputs.front().help = table.help(operation.inputs.front());
  return {operation,
          table.parameters_of(operation),
          "vtkMimetraSequence",
          "MimetraSequence",
          "mimetra Sequence",
          {"FileName", "weights"},
          {},
          {},
          kTimes,
          "<ShowInMenu category=\"mimetra\"/>"
          "<DefaultFileNameProperty name=\"FileName\"/>"
          "<ReaderFactory extensions=\"" +
              file_extensions(table) + "\" file_description=\"Mesh sequences (mimetra)\"/>"};
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
