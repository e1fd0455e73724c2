#include <nlohmann/json.hpp>

#include "toolkit/mesh/errors.h"
#include "toolkit/operations/analysis.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/memory.h"
#include "toolkit/operations/toolkit_operations.h"

namespace mimetra {

namespace {

/// What the script for ParaView opens: the main output.
std::filesystem::path series_of(const Invocation& invocation) {
  const auto out = invocation.wanted.find("out");
  if (out != invocation.wanted.end() && !out->second.empty()) {
    const std::filesystem::path& path = out->second.front();
    if (path.extension() == ".pvd" || path.extension() == ".vtp") {
      return std::filesystem::absolute(path).lexically_normal();
    }
  }
  throw UsageError("--paraview: needs regions that ParaView opens, with -o NAME.pvd or NAME.vtp");
}

Outcome run_regions(const Invocation& invocation) {
  if (invocation.wants("paraview")) series_of(invocation);
  const bool with_components = invocation.parameters.flag("component-fields");
  const Components* given = invocation.find<Components>("components");
  if (with_components && given && given->support.size() == 0) {
    throw MismatchError(invocation.inputs.at("components").front().name +
                        ": holds no support maps, which --component-fields writes; decompose the "
                        "sequence again");
  }
  const SequenceRead& read = invocation.get<SequenceRead>("sequence");
  const Analysis analysis = analysis_for(invocation, read);
  const Regions regions = regions_of(invocation, analysis);
  std::vector<Field> fields = fields_of(regions);
  if (with_components) {
    for (Field& field : component_fields(analysis.components, regions)) {
      fields.push_back(std::move(field));
    }
  }
  Outcome outcome;
  Json json = report_of(regions);
  json["seconds"] = analysis.seconds;
  outcome.report = json.dump();
  outcome.summary = summary_of(regions);
  const RegionData shown{regions, {read.sequence, std::move(fields), true}};
  if (invocation.wants("paraview")) {
    outcome.outputs["paraview"].push_back({"", RegionView{shown, series_of(invocation)}});
  }
  outcome.outputs["out"].push_back({"", shown});
  if (invocation.wants("components-out")) {
    outcome.outputs["components-out"].push_back({"", analysis.components});
  }
  return outcome;
}

}  // namespace

Operation regions_operation() {
  Operation operation;
  operation.name = "regions";
  operation.summary = "Regions of interest of a sequence, as fields for ParaView";
  operation.inputs = {
      {"sequence", DataKind::sequence, "sequence whose moving regions are looked for"},
      {"components", DataKind::components, "components (.h5) of an earlier decompose", true}};
  operation.outputs = {{"out", DataKind::regions, ".pvd (a time series), .vtp, .json or .csv"},
                       components_output(),
                       {"paraview", DataKind::view,
                        "script (.py) that shows them: paraview --script=VIEW.py", true}};
  operation.parameters = region_parameters();
  operation.parameters.push_back({"component-fields", ParameterKind::flag, false,
                                  "also write support_k and component_k of each region"});
  for (const auto& group : {decomposition_parameters(30), alignment_parameters()}) {
    for (const Parameter& parameter : group) operation.parameters.push_back(parameter);
  }
  operation.examples = {"regions takes/ -k 30 -o rois/take.pvd --paraview view.py",
                        "regions take.npy --coverage 0.8 --radius 12abs -o rois.json"};
  operation.run = run_regions;
  operation.memory = [](const Invocation& invocation) {
    return analysis_bytes(invocation, invocation.get<SequenceRead>("sequence"),
                          invocation.parameters.integer("k"));
  };
  return operation;
}

}  // namespace mimetra
