#include <nlohmann/json.hpp>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/convergence_report.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/paraview_view.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/operations/region_report.h"
#include "toolkit/operations/toolkit_operations.h"

namespace mimetra {

namespace {

struct RegionsCall {
  RegionChoiceOptions regions = {};
  /// Also write support_k and component_k of each region.
  bool component_fields = false;
  AnalysisOptions analysis = {};
  SourceOptions source = {};

  static constexpr Option kComponentFields{"component_fields", &RegionsCall::component_fields};
};

BoundParameters<RegionsCall> regions_parameters(const FieldSequence* fields = nullptr) {
  const FrameSource* sequence = fields ? fields->frames.get() : nullptr;
  BoundParameters<RegionsCall> list;
  return list.add(&RegionsCall::regions, region_parameters())
      .add("component-fields", RegionsCall::kComponentFields,
           "also write support_k and component_k of each region")
      .add(&RegionsCall::analysis, count_parameters())
      .add(&RegionsCall::analysis, analysis_parameters(fields))
      .add(&RegionsCall::source, rest_parameters(sequence))
      .add(&RegionsCall::source, alignment_parameters(sequence));
}

struct Found {
  Analysis analysis;
  /// None where components are given.
  std::optional<HeadMotionTaken> head_motion = {};
};

/// Components given, or those of the sequence without its motion.
Found analysis_of(const Invocation& invocation, const RegionsCall& call) {
  const NamedData& input = invocation.input("sequence");
  const MeshSequence& sequence = std::get<FieldSequence>(input.data).sequence();
  if (const auto given = given_components(invocation)) {
    return {analysis_of(*given, sequence, call.analysis)};
  }
  SourceOptions options = described(call.source, input);
  options.notes = call.analysis.notes;
  options.threads = invocation.threads;
  const Source source = prepare_source(sequence, options);
  return {analyse(source, call.analysis), source.head_motion};
}

/// What the script for ParaView opens: the main output.
std::filesystem::path series_of(const Invocation& invocation) {
  const auto out = invocation.wanted.find("out");
  if (out != invocation.wanted.end() && !out->second.empty()) {
    const std::filesystem::path& path = out->second.front();
    const std::string extension = lower_extension(path);
    if (extension == ".pvd" || extension == ".vtp") {
      return std::filesystem::absolute(path).lexically_normal();
    }
  }
  throw UsageError("--paraview: needs regions that ParaView opens, with -o NAME.pvd or NAME.vtp");
}

Outcome run_regions(const Invocation& invocation) {
  if (invocation.wants("paraview")) series_of(invocation);
  RegionsCall call =
      regions_parameters(&invocation.get<FieldSequence>("sequence")).read(invocation.parameters);
  call.regions.notes = call.analysis.notes = warnings_of(invocation);
  call.analysis.threads = invocation.threads;
  call.analysis.progress = invocation.progress;
  const Components* given = invocation.find<Components>("components");
  if (call.component_fields && given && given->support.size() == 0) {
    throw MismatchError(invocation.input("components").name +
                        ": holds no support maps, which --component-fields writes; decompose the "
                        "sequence again");
  }
  const Found found =
      in_command_terms(invocation.parameters, [&] { return analysis_of(invocation, call); });
  const Analysis& analysis = found.analysis;
  const Regions regions = choose_regions(analysis, call.regions);
  std::vector<Field> fields = fields_of(regions);
  if (call.component_fields) {
    for (Field& field : component_fields(analysis.components, regions)) {
      fields.push_back(std::move(field));
    }
  }
  Outcome outcome;
  Json json = report_of(regions);
  if (found.head_motion) json["head_motion"] = json_of(*found.head_motion);
  add_convergence(json, analysis.components);
  json["seconds"] = analysis.seconds;
  outcome.report = json_text(json);
  outcome.summary = summary_of(regions);
  const RegionData shown{regions, FieldSequence(invocation.get<FieldSequence>("sequence").frames,
                                                std::move(fields), true)};
  if (invocation.wants("paraview")) {
    outcome.outputs["paraview"].push_back(
        {"", Document{paraview_view(shown, series_of(invocation))}});
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
      {"components", DataKind::components, "components of an earlier decompose", true}};
  operation.inputs.front().fields = true;
  operation.outputs = {{"out", DataKind::regions, "the regions, as .pvd over time"},
                       components_output(),
                       {"paraview", DataKind::document,
                        "script that shows them by paraview --script=VIEW.py", true}};
  operation.outputs.back().extensions = {".py"};
  operation.parameters = regions_parameters().declared();
  operation.examples = {"regions takes/ -k 30 -o rois/take.pvd --paraview view.py",
                        "regions take.npy --coverage 0.8 --radius 12abs -o rois.json"};
  operation.run = run_regions;
  operation.memory = [](const Invocation& invocation) {
    return analysis_bytes(invocation, invocation.input("sequence"),
                          invocation.parameters.integer("k"));
  };
  return operation;
}

}  // namespace mimetra
