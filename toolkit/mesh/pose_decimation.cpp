#include "toolkit/mesh/pose_decimation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModBaseT.hh>
#include <OpenMesh/Tools/Decimater/Observer.hh>

#include "toolkit/mesh/normals.h"

namespace mimetra {
namespace {

using Mesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;
using Vector = Eigen::Vector3d;

/// Cosine between a triangle and the surface at its corners, below which it folds; of a finished
/// mesh only those that are turned over count.
constexpr double kLeastCosine = 0.2;
/// Of 4 sqrt(3) area over the sum of squared edges, 1 where all are equal.
constexpr double kLeastQuality = 0.1;
/// Weight of the planes that hold a border in its place.
constexpr double kBorder = 10;
/// Of edges to the fourth, so that the shortest goes first where all is flat.
constexpr double kShort = 1e-6;

double quality(const Vector& a, const Vector& b, const Vector& c) {
  const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return squares > 0 ? 2 * std::sqrt(3.0) * (b - a).cross(c - a).norm() / squares : 0;
}

/// The sum of squared distances to planes, each weighed.
struct Quadric {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vector b = Vector::Zero();
  double c = 0;

  void add_plane(const Vector& normal, const Vector& point, double weight) {
    const double d = -normal.dot(point);
    a += weight * normal * normal.transpose();
    b += weight * d * normal;
    c += weight * d * d;
  }
  void add(const Quadric& other) {
    a += other.a;
    b += other.b;
    c += other.c;
  }
  double at(const Vector& x) const { return x.dot(a * x) + 2 * b.dot(x) + c; }
};

std::vector<Quadric> quadrics_of(const Positions& pose, const geodesic::GluedSurface& surface) {
  std::vector<Quadric> quadrics(static_cast<std::size_t>(pose.rows()));
  const auto at = [&quadrics](VertexIndex v) -> Quadric& {
    return quadrics[static_cast<std::size_t>(v)];
  };
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    const auto corners = surface.triangles.row(t);
    const std::array<Vector, 3> p = {pose.row(corners[0]), pose.row(corners[1]),
                                     pose.row(corners[2])};
    const Vector normal = (p[1] - p[0]).cross(p[2] - p[0]);
    const double area = normal.norm() / 2;
    if (area == 0) continue;
    for (int c = 0; c < 3; ++c) at(corners[c]).add_plane(normal / (2 * area), p[0], area);
    for (int c = 0; c < 3; ++c) {
      if (surface.twin[static_cast<std::size_t>(3 * t + c)] >= 0) continue;
      const int next = (c + 1) % 3;
      const Vector edge = p[static_cast<std::size_t>(next)] - p[static_cast<std::size_t>(c)];
      const Vector across = edge.cross(normal).normalized();
      for (const int end : {c, next}) {
        at(corners[end])
            .add_plane(across, p[static_cast<std::size_t>(c)], kBorder * edge.squaredNorm());
      }
    }
  }
  return quadrics;
}

/// The module of OpenMesh's decimater that ranks collapses.
template <typename MeshT>
class PoseModule : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(PoseModule, MeshT, Poses);

  explicit PoseModule(MeshT& mesh) : Base(mesh, false) {}

  void start(const DecimationPoses& poses, const geodesic::GluedSurface& surface) {
    poses_ = &poses;
    for (int p = 0; p < poses.planes; ++p) {
      quadrics_.push_back(quadrics_of(poses.positions[static_cast<std::size_t>(p)], surface));
    }
  }

  float collapse_priority(const CollapseInfo& collapse) override {
    const int from = collapse.v0.idx(), to = collapse.v1.idx();
    if (!is_allowed(collapse)) return float(Base::ILLEGAL_COLLAPSE);
    double cost = 0;
    for (std::size_t p = 0; p < quadrics_.size(); ++p) {
      const Positions& pose = poses_->positions[p];
      const Vector x = pose.row(to);
      const double shift2 = (pose.row(from) - pose.row(to)).squaredNorm();
      cost += quadrics_[p][std::size_t(from)].at(x) + quadrics_[p][std::size_t(to)].at(x) +
              kShort * shift2 * shift2;
    }
    return static_cast<float>(std::max(0.0, cost));
  }

  void postprocess_collapse(const CollapseInfo& collapse) override {
    for (std::vector<Quadric>& quadrics : quadrics_) {
      quadrics[std::size_t(collapse.v1.idx())].add(quadrics[std::size_t(collapse.v0.idx())]);
    }
  }

 private:
  /// Whether every triangle that stays around `from` may have its corner at `to`.
  bool is_allowed(const CollapseInfo& collapse) {
    MeshT& mesh = Base::mesh();
    const int from = collapse.v0.idx(), to = collapse.v1.idx();
    for (const auto spoke : mesh.voh_range(collapse.v0)) {
      const auto face = spoke.face();
      if (!face.is_valid()) continue;
      const int b = spoke.to().idx(), c = spoke.next().to().idx();
      if (b == to || c == to) continue;
      if (!keeps_its_side(from, to, b, c) || !keeps_its_shape(from, to, b, c)) return false;
    }
    return true;
  }

  bool keeps_its_side(int from, int to, int b, int c) const {
    for (std::size_t p = 0; p < poses_->positions.size(); ++p) {
      const Positions& pose = poses_->positions[p];
      const Positions& normals = poses_->normals[p];
      const auto agrees = [&](int a) {
        return agreement(pose.row(a), pose.row(b), pose.row(c),
                         normals.row(a) + normals.row(b) + normals.row(c));
      };
      const double now = agrees(to);
      if (now < kLeastCosine && now <= agrees(from)) return false;
    }
    return true;
  }

  bool keeps_its_shape(int from, int to, int b, int c) const {
    const Positions& rest = poses_->positions.front();
    const double now = quality(rest.row(to), rest.row(b), rest.row(c));
    return now >= kLeastQuality || now > quality(rest.row(from), rest.row(b), rest.row(c));
  }

  const DecimationPoses* poses_ = nullptr;
  std::vector<std::vector<Quadric>> quadrics_;
};

class CollapseProgress : public OpenMesh::Decimater::Observer {
 public:
  CollapseProgress(Progress progress, std::size_t collapses)
      : Observer(kSteps), progress_(std::move(progress)), collapses_(double(collapses)) {}

  void notify(std::size_t done) override { report_progress(progress_, double(done) / collapses_); }

 private:
  static constexpr std::size_t kSteps = 1000;
  Progress progress_;
  double collapses_;
};

}  // namespace

void DecimationPoses::add(Positions pose, const Triangles& triangles) {
  normals.push_back(vertex_normals(pose, triangles).rowwise().normalized());
  positions.push_back(std::move(pose));
}

double agreement(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                 const Eigen::Vector3d& normals) {
  const Vector normal = (b - a).cross(c - a);
  const double lengths = normal.norm() * normals.norm();
  return lengths > 0 ? normal.dot(normals) / lengths : -1;
}

CollapsedSurface collapsed(const geodesic::GluedSurface& surface, const DecimationPoses& poses,
                           const std::vector<bool>& locked, std::size_t collapses,
                           const Progress& progress) {
  Mesh mesh = geodesic::mesh_of<Mesh>(surface, poses.positions.front());
  mesh.request_halfedge_status();
  OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
  for (const auto v : mesh.vertices()) {
    mesh.status(v).set_locked(locked[std::size_t(v.idx())]);
  }
  PoseModule<Mesh>::Handle module;
  decimater.add(module);
  decimater.initialize();
  decimater.module(module).start(poses, surface);
  CollapseProgress observer(progress, collapses);
  decimater.set_observer(&observer);
  if (collapses > 0) decimater.decimate(collapses);

  CollapsedSurface result;
  result.kept.resize(surface.vertex.size());
  for (std::size_t v = 0; v < result.kept.size(); ++v) {
    result.kept[v] = !mesh.status(OpenMesh::VertexHandle(int(v))).deleted();
  }
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    if (!mesh.status(OpenMesh::FaceHandle(int(t))).deleted()) {
      result.triangles.push_back(static_cast<int>(t));
    }
  }
  result.corners.resize(static_cast<Eigen::Index>(result.triangles.size()), 3);
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    int corner = 0;
    for (const auto v : mesh.fv_range(OpenMesh::FaceHandle(result.triangles[i]))) {
      result.corners(static_cast<Eigen::Index>(i), corner++) = v.idx();
    }
  }
  return result;
}

}  // namespace mimetra
