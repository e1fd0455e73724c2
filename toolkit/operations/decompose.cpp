#include <algorithm>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/operations/weight_tables.h"

namespace mimetra {

namespace {

struct DecomposeCall {
  AnalysisOptions analysis = {.count = DecompositionOptions().count};
  SourceOptions source = {};
};

const BoundParameters<DecomposeCall>& decompose_parameters() {
  static const auto list =
      BoundParameters<DecomposeCall>()
          .add(&DecomposeCall::analysis, count_parameters(DecomposeCall{}.analysis))
          .add(&DecomposeCall::analysis, analysis_parameters())
          .add(&DecomposeCall::source, rest_parameters())
          .add(&DecomposeCall::source, alignment_parameters());
  return list;
}

/// Returns each component's weight over time.
Table weight_table(const Components& components, const Eigen::VectorXd& times) {
  WeightTrack track{{}, components.weights, times};
  for (int k = 0; k < components.count(); ++k) {
    track.names.push_back("component_" + std::to_string(k));
  }
  return weight_table(track);
}

/// The part of a sequence that was decomposed: vertices that are not `inside` stay at rest.
class MovingInside : public FrameSource {
 public:
  MovingInside(std::shared_ptr<const FrameSource> whole, std::vector<bool> inside)
      : FrameSource(whole->header()), whole_(std::move(whole)), inside_(std::move(inside)) {}

  bool is_quick() const override { return whole_->is_quick(); }

 private:
  void read_frames(int first, FramesView poses) const override {
    whole_->read(first, poses);
    for (VertexIndex v = 0; v < vertices(); ++v) {
      if (!inside_[v]) poses.middleCols(3 * v, 3).rowwise() = rest().row(v);
    }
  }

  std::shared_ptr<const FrameSource> whole_;
  std::vector<bool> inside_;
};

std::shared_ptr<const FrameSource> moving_inside(std::shared_ptr<const FrameSource> sequence,
                                                 const std::vector<bool>& inside) {
  if (inside.empty()) return sequence;
  return std::make_shared<const MovingInside>(std::move(sequence), inside);
}

Outcome run_decompose(const Invocation& invocation) {
  const FieldSequence& sequence = invocation.get<FieldSequence>("sequence");
  DecomposeCall call = decompose_parameters().read(invocation.parameters, &sequence);
  call.source = described(std::move(call.source), invocation.input("sequence"));
  const Context context = within_memory(invocation);
  auto [still, analysis] = in_command_terms(invocation.parameters, [&] {
    Source source = prepare_source(sequence.frames, call.source, {}, context.part(0, 0));
    Analysis found = analyse(source, call.analysis, context);
    return std::pair(std::move(source), std::move(found));
  });
  const Components& components = analysis.components;
  const auto moving = moving_inside(with_rest(still.sequence, components.rest), analysis.inside);
  const DecompositionError error = decomposition_error(*moving, components, context.part(1, 1));
  const auto dead = std::ranges::count(components.centers, -1);
  if (dead > 0) {
    invocation.warn(std::to_string(dead) + " of " + std::to_string(components.count()) +
                    " components died: fewer tell the same");
  }
  if (error.kg > 100) {
    invocation.warn(
        "the components leave " + readable(error.kg / 100) +
        " times as much of the motion as the mean of the frames does (KG error): the frames are "
        "far from the rest pose and near to each other; take more frames, or another --rest");
  }
  Outcome outcome;
  Json report = {{"frames", still.sequence->frames()},
                 {"vertices", still.sequence->vertices()},
                 {"components", components.count() - dead},
                 {"energies", components.energies},
                 {"e_rms", error.rms},
                 {"e_rms_relative", error.relative_rms},
                 {"kg", error.kg},
                 {"sparsity", error.sparsity},
                 {"centers", components.centers},
                 {"head_motion", json_of(still.head_motion)},
                 {"seconds", analysis.seconds}};
  add_convergence(report, components);
  outcome.report = json_text(report);
  outcome.summary = counted(components.count() - dead, "component") + ", RMS error " +
                    readable(error.rms) + " (" + readable(100 * error.relative_rms) +
                    " % of the box diagonal), KG error " + readable(error.kg) + " %, " +
                    percent(error.sparsity) + " of the displacements are zero, " +
                    convergence_text(components) + ", " + readable(analysis.seconds) + " s\n";
  if (invocation.wants("weights-out")) {
    outcome.outputs["weights-out"].push_back(
        {"", weight_table(components, still.sequence->times())});
  }
  outcome.outputs["out"].push_back({"", std::move(analysis.components)});
  return outcome;
}

}  // namespace

Operation decompose_operation() {
  Operation operation;
  operation.name = "decompose";
  operation.summary = "Sparse localized deformation components of a sequence";
  operation.inputs = {{"sequence", DataKind::sequence, "sequence to decompose"}};
  operation.inputs.front().streamed = operation.inputs.front().fields = true;
  operation.outputs = {{"out", DataKind::components, "the components"},
                       {"weights-out", DataKind::table, "weights over time", true}};
  operation.parameters = decompose_parameters().declared();
  operation.examples = {"decompose takes/ -k 30 -o take.h5",
                        "decompose take.npy -k 50 --compat splocs2013 -o take.h5"};
  operation.measures = decomposition_measures();
  operation.run = run_decompose;
  operation.shared = true;
  const auto plan = [](const Invocation& invocation) {
    return analysis_plan(invocation, *invocation.get<FieldSequence>("sequence").frames,
                         decompose_parameters().read(invocation.parameters).analysis);
  };
  operation.memory = [plan](const Invocation& invocation) { return plan(invocation).bytes; };
  operation.scratch = [plan](const Invocation& invocation) {
    return plan(invocation).scratch_bytes;
  };
  return operation;
}

}  // namespace mimetra
