// Writes the server manager XML of the plugin: what ParaView's menus, panels and Python know of the
// sources and filters, made of the operations table.

#include <fstream>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include "plugins/paraview/mimetra/filters/proxy_xml.h"
#include "plugins/paraview/mimetra/filters/reading.h"
#include "toolkit/operations/formats.h"
#include "toolkit/operations/operation.h"

using namespace mimetra;

namespace {

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

/// "npy off": the formats that ParaView has no reader of its own for.
std::string file_extensions() {
  const std::set<std::string> own = {".obj", ".ply", ".stl"};
  std::string words;
  for (const std::string& extension : sequence_files()) {
    if (own.contains(extension)) continue;
    words += (words.empty() ? "" : " ") + extension.substr(1);
  }
  return words;
}

Proxy sequence_proxy(const OperationTable& table) {
  const Operation operation = reading_operation();
  return {operation,
          table.parameters_of(operation),
          "vtkMimetraSequence",
          "MimetraSequence",
          "mimetra Sequence",
          {"FileName", "weights"},
          {},
          kTimes,
          kInMenu +
              "<DefaultFileNameProperty name=\"FileName\"/>"
              "<ReaderFactory extensions=\"" +
              file_extensions() + "\" file_description=\"Mesh sequences (mimetra)\"/>"};
}

std::vector<Proxy> filter_proxies(const OperationTable& table) {
  const auto proxy = [&table](const std::string& operation, std::string class_name,
                              std::string label, std::vector<std::string> first,
                              std::vector<Port> ports, std::string further, std::string hints) {
    const Operation& found = *table.find(operation);
    std::string name = class_name.substr(std::string("vtk").size());
    return Proxy{found,
                 found.parameters,
                 std::move(class_name),
                 std::move(name),
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
