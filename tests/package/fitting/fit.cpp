// usage: fit [IMAGE]
// The operation `fit` of a module that was built against an installed mimetra: landmarks of a known
// face in a table of the installed operations.

#include <cmath>
#include <iostream>
#include <numbers>

#include <nlohmann/json.hpp>

#include "fitting/fit_operation.h"
#include "toolkit/io/whole_file.h"

using namespace mimetra;

namespace {

/// Two turns of a spiral with one expression that lifts its middle.
MorphableModel spiral() {
  constexpr int kVertices = 24;
  Positions mean(kVertices, 3);
  Eigen::MatrixXd lift = Eigen::MatrixXd::Zero(3 * kVertices, 1);
  for (int v = 0; v < kVertices; ++v) {
    const double angle = 4 * std::numbers::pi * v / kVertices;
    mean.row(v) << 50 * std::cos(angle), 50 * std::sin(angle), 4 * v;
    lift(3 * v + 1, 0) = 10 * std::exp(-std::pow((v - 12) / 4.0, 2));
  }
  const Triangles triangles = Eigen::RowVector3i(0, 1, 2);
  return {std::make_shared<Connectivity>(Connectivity::from_triangles(kVertices, triangles)),
          mean,
          {{}, Eigen::MatrixXd(3 * kVertices, 0)},
          {{"lift"}, lift}};
}

/// Seen from the front, with the expression at 0.75.
LandmarkTrack landmarks_of(const MorphableModel& model) {
  const Positions pose = model.person().pose(Eigen::VectorXd::Constant(1, 0.75));
  LandmarkTrack track;
  track.points.resize(1, 2 * model.vertices());
  for (int v = 0; v < model.vertices(); ++v) {
    track.names.push_back(std::to_string(v + 1));
    track.points.row(0).segment<2>(2 * v) << 300 + 2 * pose(v, 0) + pose(v, 2),
        200 - 2 * pose(v, 1);
  }
  track.times = Eigen::VectorXd::Zero(1);
  return track;
}

}  // namespace

int main(int argc, char** argv) {
  OperationTable table;
  add_toolkit(table);
  add_fitting(table);
  if (argc > 1) {
    try {
      table.reader(DataKind::landmarks, argv[1]).read(argv[1], {}, {});
    } catch (const IoError& error) {
      std::cerr << error.what() << '\n';
      return 3;
    }
  }
  const Operation& fit = *table.find("fit");

  const MorphableModel model = spiral();
  const std::filesystem::path mapping = std::string(argv[0]) + ".mapping.txt";
  std::string lines;
  for (int v = 0; v < model.vertices(); ++v) lines += std::to_string(v) + '\n';
  write_bytes(mapping, lines);

  Invocation call;
  call.inputs["landmarks"] = {{"spiral", landmarks_of(model)}};
  call.inputs["model"] = {{"spiral", ModelData{model}}};
  call.parameters = Parameters(table.parameters_of(fit));
  call.parameters.set("mapping", mapping.string());
  call.parameters.set("tolerance", 0.0);
  call.parameters.set("iterations", std::int64_t{50});
  const Outcome outcome = fit.run(call);
  std::cout << outcome.summary;
  const auto& fitted = std::get<FittedCoefficients>(outcome.outputs.at("fit-out").front().data);
  return std::abs(fitted.beta(0, 0) - 0.75) < 1e-6 ? 0 : 1;
}
