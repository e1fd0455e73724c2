#pragma once

#include <algorithm>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "samples/head/head.h"
#include "tests/fitting/synthetic_clip.h"

namespace mimetra::test {

/// Landmarks of two people of one model in two videos, and what they come from.
struct TwoVideos {
  MorphableModel model;
  std::vector<int> vertices;
  Eigen::VectorXd source_alpha, target_alpha;
  Eigen::MatrixXd source_beta;  ///< F x D
  Eigen::VectorXd times;
  Frames source, target;  ///< landmarks (F x 2n), in pixels
  double pixels_per_unit = 0;

  /// What the transfer is to find: the source's expressions on the target's face.
  MeshSequence truth() const { return model.person(target_alpha).animate(source_beta, times); }
};

/// How large a face is in the image, along the model's longest side.
constexpr double kFacePixels = 450;

/// Of a head that nods and turns by up to 20 degrees, 0.3 and 0.2 times a second, seen from afar.
inline AffineCamera turning_camera(double time, double phase, double scale) {
  constexpr double kTurn = 20 * std::numbers::pi / 180;
  const double angle = 2 * std::numbers::pi * time + phase;
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(kTurn * std::sin(0.3 * angle), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(kTurn * std::sin(0.2 * angle), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  AffineCamera camera;
  camera.leftCols<3>() = scale * (Eigen::Vector2d(1, -1).asDiagonal() * turn.topRows<2>());
  camera.col(3) = Eigen::Vector2d(640, 360);
  return camera;
}

/// Source and target perform `beta` (F x D), the target a third of the clip later; `noise` in
/// pixels.
inline TwoVideos two_videos(const MorphableModel& model, std::vector<int> vertices,
                            const Eigen::MatrixXd& beta, const Eigen::VectorXd& times,
                            unsigned seed, double noise = 1) {
  std::mt19937 random(seed);
  TwoVideos videos;
  videos.model = model;
  videos.vertices = std::move(vertices);
  videos.source_alpha = normal_matrix(model.identities().size(), 1, random);
  videos.target_alpha = normal_matrix(model.identities().size(), 1, random);
  videos.source_beta = beta;
  videos.times = times;
  videos.pixels_per_unit = kFacePixels / extent(model.mean());
  const auto frames = beta.rows(), n = static_cast<Eigen::Index>(videos.vertices.size());
  const auto landmarks = [&](const Eigen::VectorXd& alpha, Eigen::Index shift) {
    const BlendshapeModel person = model.person(alpha);
    Frames points(frames, 2 * n);
    for (Eigen::Index f = 0; f < frames; ++f) {
      const Positions pose = person.pose(beta.row((f + shift) % frames));
      const AffineCamera camera =
          turning_camera(times[f], static_cast<double>(shift), videos.pixels_per_unit);
      points.row(f) = as_row(project(camera, pose(videos.vertices, Eigen::all)) +
                             noise * normal_matrix(n, 2, random));
    }
    return points;
  };
  videos.source = landmarks(videos.source_alpha, 0);
  videos.target = landmarks(videos.target_alpha, frames / 3);
  return videos;
}

/// Made once for all tests.
inline const MorphableModel& built_in_head() {
  static const MorphableModel head = samples::parametric_head();
  return head;
}

/// Its vertices of iBUG's landmarks.
inline std::vector<int> vertices_of_landmarks() {
  std::vector<int> vertices;
  for (const auto& [landmark, vertex] : samples::head_landmarks()) vertices.push_back(vertex);
  return vertices;
}

/// Distances of vertices in all frames: of the faces, and of their displacements from rest.
struct SequenceDistance {
  double face = 0;        ///< mean
  double expression = 0;  ///< mean
};

inline SequenceDistance distance_between(const MeshSequence& a, const MeshSequence& b) {
  SequenceDistance distance;
  const Positions rest = a.rest() - b.rest();
  for (int f = 0; f < a.frames(); ++f) {
    const Positions difference = a.frame(f) - b.frame(f);
    distance.face += difference.rowwise().norm().mean() / a.frames();
    distance.expression += (difference - rest).rowwise().norm().mean() / a.frames();
  }
  return distance;
}

}  // namespace mimetra::test
