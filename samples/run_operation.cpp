// Runs an operation of the command from another program, with values as inputs and outputs, with
// progress and with cancellation.

#include <iostream>

#include <mimetra/samples/head/head.h>
#include <mimetra/toolkit/mesh/errors.h>
#include <mimetra/toolkit/operations/operation.h>
using namespace mimetra;

int main() {
  OperationTable table;
  add_toolkit(table);
  const Operation& decompose = *table.find("decompose");

  const WeightTrack track = samples::parametric_performance();
  const BlendshapeModel head = samples::parametric_head().person();
  FieldSequence take(head.animate(track.weights, track.times).slice(0, 120, 4));

  Invocation call;
  call.inputs["sequence"] = {{"take", std::move(take), {.model_driven = true}}};
  call.parameters = Parameters(table.parameters_of(decompose));
  call.parameters.set("k", 10);
  int reports = 0;
  call.context = Context().with_progress([&reports](double share) {
    std::cerr << '\r' << int(100 * share) << " %";
    ++reports;
    return true;
  });
  const Outcome outcome = decompose.run(call);
  std::cerr << '\n';
  const auto& components = std::get<Components>(outcome.outputs.at("out").front().data);
  std::cout << outcome.summary;

  // A progress function that returns false cancels the operation.
  call.context = Context().with_progress([](double share) { return share < 0.5; });
  bool cancelled = false;
  try {
    decompose.run(call);
  } catch (const Cancelled&) {
    cancelled = true;
  }
  std::cout << reports << " reports of progress; cancelled half-way: " << std::boolalpha
            << cancelled << '\n';
  return components.count() == 10 && reports > 1 && cancelled ? 0 : 1;
}
