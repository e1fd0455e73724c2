#pragma once

#include <cmath>
#include <memory>
#include <numbers>

#include <nlohmann/json.hpp>

#include "tests/shapes.h"
#include "toolkit/operations/operation.h"
#include "toolkit/pictures/picture_formats.h"
#include "toolkit/report/report_operation.h"
#include "toolkit/vtk/vtk_formats.h"

namespace mimetra::test {

/// A patch with three bumps: an actor, and a performance of it.
inline BlendshapeModel bumpy_patch(double stretch, double size = 1) {
  constexpr int kSide = 15;
  Shape shape = grid(kSide, kSide);
  shape.positions.col(0) *= stretch;
  const int n = static_cast<int>(shape.positions.rows());
  Eigen::MatrixXd bumps = Eigen::MatrixXd::Zero(3 * n, 3);
  const double centers[3][2] = {{3, 3}, {11, 4}, {6, 11}};
  for (int j = 0; j < 3; ++j) {
    for (int v = 0; v < n; ++v) {
      const int row = v / kSide;
      const double x = v % kSide - centers[j][0], y = row - centers[j][1];
      const double inside = 1 - (x * x + y * y) / 9;
      if (inside > 0) bumps(3 * v + 2, j) = 2 * inside * inside;
    }
  }
  return BlendshapeModel(
      std::make_shared<Connectivity>(Connectivity::from_triangles(n, shape.triangles)),
      size * shape.positions, {{"left", "right", "top"}, size * bumps});
}

inline MeshSequence bumpy_take() {
  Eigen::MatrixXd weights(24, 3);
  Eigen::VectorXd times(24);
  for (int f = 0; f < 24; ++f) {
    times[f] = f / 24.0;
    for (int j = 0; j < 3; ++j) {
      weights(f, j) = std::pow(std::sin(std::numbers::pi * f * (j + 1) / 23), 2);
    }
  }
  return bumpy_patch(1).animate(weights, times);
}

/// The operations of the toolkit, with pictures and reports.
inline OperationTable full_table() {
  OperationTable table;
  add_toolkit(table);
  add_vtk(table);
  add_pictures(table);
  add_report(table);
  return table;
}

/// A run of `operation`, as it is read from its manifest, with its source or sequence, and its
/// target called `target`, of `size` times the source's size.
inline RunRead run_of(const std::string& operation, const std::string& target,
                      const std::map<std::string, ParameterValue>& parameters, double size = 1) {
  const OperationTable table = full_table();
  Invocation call;
  call.parameters = Parameters(table.parameters_of(*table.find(operation)));
  for (const auto& [name, value] : parameters) call.parameters.set(name, value);
  for (const Input& input : table.find(operation)->inputs) {
    if (input.optional) continue;
    if (input.kind == DataKind::sequence) {
      call.inputs[input.name] = {
          {"takes/bumps", FieldSequence(bumpy_take()), {.model_driven = true}}};
    } else {
      call.inputs[input.name] = {{target, ModelData{MorphableModel(bumpy_patch(1.2, size))}}};
    }
  }
  RunRead run;
  run.record.manifest = "run/mimetra-run.json";
  run.record.operation = operation;
  run.record.arguments = {operation, "takes/bumps", target};
  run.invocation = std::move(call);
  return run;
}

/// A run as an input.
inline NamedData named(const RunRead& run) {
  return {"run", Document{}, {.run = std::make_shared<const RunRead>(run)}};
}

/// What `report` makes of a run, with the numbers of components `counts` in its table.
inline Outcome reported(const RunRead& run, const std::vector<std::int64_t>& counts,
                        const Log& log = {}, const std::vector<std::string>& pictures = {}) {
  const OperationTable table = full_table();
  const Operation& report = *table.find("report");
  Invocation call;
  call.parameters = Parameters(table.parameters_of(report));
  call.parameters.set("k", counts);
  call.inputs["run"] = {named(run)};
  for (const std::string& picture : pictures) call.wanted[picture] = {};
  call.log = log;
  return report.run(call);
}

inline std::string page_of(const Outcome& outcome) {
  return std::get<Document>(outcome.outputs.at("out").front().data).text;
}

}  // namespace mimetra::test
