#pragma once

#include <random>
#include <vector>

#include <Eigen/QR>

#include "fitting/landmark_fitter.h"

namespace mimetra::test {

struct ClipShape {
  int landmarks = 20;
  int identities = 5;
  int expressions = 4;
  int frames = 1;
  double identity_size = 1;  ///< of the true alpha, in standard deviations
  double noise = 1;          ///< of the landmarks, in pixels
};

/// A random model of a face's proportions, and landmarks of it with a known origin. A fifth of the
/// betas or so are at their bounds.
struct SyntheticClip {
  MorphableModel model;
  std::vector<int> vertices;
  Frames points;
  Eigen::VectorXd times;
  Eigen::VectorXd alpha;
  Eigen::MatrixXd beta;  ///< F x D
  std::vector<AffineCamera> cameras;
};

inline Eigen::MatrixXd normal_matrix(Eigen::Index rows, Eigen::Index columns,
                                     std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

/// About 3 px a unit, turned anywhere, with a little shear.
inline AffineCamera random_camera(std::mt19937& random) {
  const Eigen::Matrix3d turn =
      Eigen::HouseholderQR<Eigen::Matrix3d>(normal_matrix(3, 3, random)).householderQ();
  AffineCamera camera;
  camera.leftCols<3>() = 3 * turn.topRows<2>() + 0.1 * normal_matrix(2, 3, random);
  camera.col(3) = Eigen::Vector2d(400, 300) + 50 * normal_matrix(2, 1, random);
  return camera;
}

/// x0 y0 x1 y1 ... of image points.
inline Eigen::RowVectorXd as_row(const ImagePoints& image) {
  return image.reshaped<Eigen::RowMajor>().transpose();
}

inline MorphableModel random_model(int vertices, int identities, int expressions,
                                   std::mt19937& random) {
  const auto basis = [&](int size, double length) {
    ShapeBasis result{{}, length * normal_matrix(3 * Eigen::Index(vertices), size, random)};
    for (int j = 0; j < size; ++j) result.names.push_back(std::to_string(j));
    return result;
  };
  const Triangles triangles = Eigen::RowVector3i(0, 1, 2);
  const Positions mean = 40 * normal_matrix(vertices, 3, random);
  ShapeBasis shapes = basis(identities, 2), motions = basis(expressions, 5);
  return {std::make_shared<Connectivity>(Connectivity::from_triangles(vertices, triangles)), mean,
          std::move(shapes), std::move(motions)};
}

/// F x D in [0, 1], a fifth of them at the bounds.
inline Eigen::MatrixXd random_weights(int frames, Eigen::Index expressions, std::mt19937& random) {
  std::uniform_real_distribution<double> weight(-0.125, 1.125);
  return Eigen::MatrixXd::NullaryExpr(frames, expressions, [&] { return weight(random); })
      .cwiseMax(0)
      .cwiseMin(1);
}

/// Sets the landmarks that the cameras see, with noise.
inline void see(SyntheticClip& clip, double noise, std::mt19937& random) {
  const auto n = static_cast<Eigen::Index>(clip.vertices.size());
  clip.points.resize(clip.beta.rows(), 2 * n);
  const BlendshapeModel person = clip.model.person(clip.alpha);
  for (Eigen::Index f = 0; f < clip.beta.rows(); ++f) {
    const ModelPoints points = person.pose(clip.beta.row(f))(clip.vertices, Eigen::all);
    clip.points.row(f) = as_row(project(clip.cameras[static_cast<std::size_t>(f)], points) +
                                noise * normal_matrix(n, 2, random));
  }
}

inline SyntheticClip synthetic_clip(unsigned seed, const ClipShape& shape = {}) {
  std::mt19937 random(seed);
  SyntheticClip clip;
  const int n = shape.landmarks;
  clip.model = random_model(n + 3, shape.identities, shape.expressions, random);
  for (int i = 0; i < n; ++i) clip.vertices.push_back(n + 2 - i);
  clip.alpha = shape.identity_size * normal_matrix(shape.identities, 1, random);
  clip.beta = random_weights(shape.frames, shape.expressions, random);
  clip.times = Eigen::VectorXd::LinSpaced(shape.frames, 0, (shape.frames - 1) / 25.0);
  for (int f = 0; f < shape.frames; ++f) clip.cameras.push_back(random_camera(random));
  see(clip, shape.noise, random);
  return clip;
}

inline std::vector<FrameFit> fit(const SyntheticClip& clip, const FitOptions& options) {
  return LandmarkFitter(clip.model, clip.vertices).fit(clip.points, options, clip.times);
}

}  // namespace mimetra::test
