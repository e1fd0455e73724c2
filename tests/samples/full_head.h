#pragma once

#include <string>
#include <vector>

#include "tests/shapes.h"
#include "toolkit/mesh/alignment.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra::test {

/// Where a face's mouth and eyes are, and which expression opens its jaw.
struct FacePlaces {
  std::string jaw_open = "jawOpen";
  /// Between the lips, in the unit of the face.
  Eigen::Vector3d mouth;
  /// Middles of the eyes.
  std::vector<Eigen::Vector3d> eyes;
  /// Length of a millimetre.
  double millimetre = 1;
};

/// A sphere of unit radius, stretched and put somewhere.
inline Shape ball(int levels, const Eigen::Vector3d& middle, const Eigen::Vector3d& radii) {
  Shape shape = sphere(levels);
  shape.positions = (shape.positions * radii.asDiagonal()).rowwise() + middle.transpose();
  return shape;
}

/// A point of the dental arch, `t` from -1 to 1, from the mouth in millimetres.
inline Eigen::Vector3d arch(double t) {
  return {24 * t, 0, -6 - 38 * t * t};
}

/// A tube around the arch, `height` above the mouth.
inline Shape gum(double height) {
  constexpr int kAlong = 60, kAround = 16;
  Shape shape = grid(kAround, kAlong);
  for (int i = 0; i < kAlong; ++i) {
    const Eigen::Vector3d middle =
        arch(-1 + 2.0 * i / (kAlong - 1)) + Eigen::Vector3d(0, height, 0);
    for (int j = 0; j < kAround; ++j) {
      const double angle = 2 * std::numbers::pi * j / (kAround - 1);
      shape.positions.row(i * kAround + j) =
          middle + Eigen::Vector3d(0, 5 * std::cos(angle), 5 * std::sin(angle));
    }
  }
  return shape;
}

/// A strip along a lid, `side` 1 above the eye and -1 below.
inline Shape lash(const Eigen::Vector3d& eye, int side, double millimetre) {
  constexpr int kAlong = 60, kAcross = 4;
  Shape shape = grid(kAcross, kAlong);
  for (int i = 0; i < kAlong; ++i) {
    const double t = -1 + 2.0 * i / (kAlong - 1);
    for (int j = 0; j < kAcross; ++j) {
      shape.positions.row(i * kAcross + j) =
          eye + millimetre * Eigen::Vector3d(14 * t, side * (5 * (1 - t * t) + j), 14 + 2 * j);
    }
  }
  return shape;
}

/// A face with all that a full head has besides: every tooth by itself and dense, gums, tongue,
/// lashes. Its own vertices come first.
inline MeshSequence full_head(const BlendshapeModel& face, const Eigen::MatrixXd& weights,
                              const FacePlaces& places) {
  const MeshSequence performance = face.animate(weights);
  // The jaw turns as the chin does: the vertices that it moves most.
  const auto& basis = face.expressions();
  const Eigen::VectorXd opened =
      Eigen::Map<const Positions>(basis.displacements.col(basis.find(places.jaw_open)).data(),
                                  face.vertices(), 3)
          .rowwise()
          .norm();
  const Eigen::VectorXd chin = (opened.array() > 0.8 * opened.maxCoeff()).cast<double>();
  std::vector<RigidTransform> jaw, skull(performance.frames());
  for (int f = 0; f < performance.frames(); ++f) {
    jaw.push_back(rigid_fit(face.neutral(), performance.frame(f), chin));
  }

  Shape whole{face.neutral(), face.triangles()};
  std::vector<Eigen::MatrixXd> moved(performance.frames());
  for (int f = 0; f < performance.frames(); ++f) moved[f] = performance.frame(f);
  const auto add = [&](const Shape& part, const auto& motion) {
    whole = both(whole, part);
    for (int f = 0; f < performance.frames(); ++f) {
      const Positions pose = motion(f, part.positions);
      moved[f].conservativeResize(whole.positions.rows(), 3);
      moved[f].bottomRows(pose.rows()) = pose;
    }
  };
  const auto placed = [&](Shape part) {
    part.positions = (places.millimetre * part.positions).rowwise() + places.mouth.transpose();
    return part;
  };
  for (const bool lower : {false, true}) {
    const auto rigid = [&](int f, const Positions& rest) {
      return (lower ? jaw : skull)[f].apply(rest);
    };
    const double side = lower ? -1 : 1;
    for (int i = 0; i < 14; ++i) {
      const Eigen::Vector3d middle = arch((i - 6.5) / 7) + Eigen::Vector3d(0, 5 * side, 0);
      add(placed(ball(3, middle, {3.2, 4.5, 3})), rigid);
    }
    add(placed(gum(12 * side)), rigid);
  }
  add(placed(ball(4, {0, -6, -30}, {18, 6, 22})),
      [&](int f, const Positions& rest) { return jaw[f].apply(rest); });
  for (const Eigen::Vector3d& eye : places.eyes) {
    for (const int side : {1, -1}) {
      // A lash goes where the skin next to each of its vertices goes.
      add(lash(eye, side, places.millimetre), [&](int f, const Positions& rest) {
        Positions pose = rest;
        for (Eigen::Index v = 0; v < rest.rows(); ++v) {
          Eigen::Index nearest = 0;
          (face.neutral().rowwise() - rest.row(v)).rowwise().squaredNorm().minCoeff(&nearest);
          pose.row(v) += performance.frame(f).row(nearest) - face.neutral().row(nearest);
        }
        return pose;
      });
    }
  }
  Frames frames(performance.frames(), whole.positions.size());
  for (int f = 0; f < performance.frames(); ++f) {
    frames.row(f) = Positions(moved[f]).reshaped<Eigen::RowMajor>().transpose();
  }
  return MeshSequence(
      Connectivity::from_triangles(static_cast<int>(whole.positions.rows()), whole.triangles),
      std::move(frames), performance.times(), whole.positions);
}

}  // namespace mimetra::test
