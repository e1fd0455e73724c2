#pragma once

#include <algorithm>

#include "tests/mesh/captured_performance.h"
#include "tests/shared_data.h"
#include "toolkit/model/blendshape_model.h"

/// Real identities with real expressions, driven by a real capture.
namespace mimetra::test {

/// The ICT face moved by `amount` along one of its identities, with the expressions `names`.
inline BlendshapeModel ict_face(const std::string& identity, double amount,
                                const std::vector<std::string>& names) {
  const auto folder = shared_path("data/ict-face");
  const TriMesh mean = read_plain_obj(folder / "neutral.obj");
  const auto displacement = [&](const std::filesystem::path& file) {
    return Positions(read_plain_obj(file).positions - mean.positions);
  };
  ShapeBasis basis{names, Eigen::MatrixXd(mean.positions.size(), names.size())};
  for (std::size_t j = 0; j < names.size(); ++j) {
    basis.displacements.col(static_cast<Eigen::Index>(j)) =
        displacement(folder / "expressions" / (names[j] + ".obj")).reshaped<Eigen::RowMajor>();
  }
  const Positions neutral =
      mean.positions + amount * displacement(folder / "identities" / (identity + ".obj"));
  return {std::make_shared<Connectivity>(mean.connectivity), neutral, basis};
}

/// Names of all its expressions, in order.
inline std::vector<std::string> ict_expressions() {
  std::vector<std::string> names;
  for (const auto& file :
       std::filesystem::directory_iterator(shared_path("data/ict-face/expressions"))) {
    names.push_back(file.path().stem().string());
  }
  std::ranges::sort(names);
  return names;
}

/// Every `step`-th of the first `frames` frames of a capture as weights of `names`.
inline Eigen::MatrixXd captured_weights(const std::vector<std::string>& names, int frames,
                                        int step) {
  const Track track = read_track(shared_path("data/captures/talking-60fps-1200.csv"), frames);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero((frames + step - 1) / step, names.size());
  for (std::size_t column = 0; column < track.names.size(); ++column) {
    for (const std::string& shape : driven_shapes(track.names[column])) {
      const auto found = std::ranges::find(names, shape);
      if (found == names.end()) continue;
      for (Eigen::Index f = 0; f < weights.rows(); ++f) {
        weights(f, found - names.begin()) = track.rows[f * step][column];
      }
    }
  }
  return weights;
}

}  // namespace mimetra::test
