#include "toolkit/mesh/pose_decimation.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

/// Cosine between a triangle and the surface at its corners below which a collapse folds it. Checks
/// of the finished mesh count only triangles that are turned over.
constexpr double kLeastCosine = 0.2;
/// Least quality of a triangle, 4 sqrt(3) area / sum of squared edges; equilateral ones have 1.
constexpr double kLeastQuality = 0.1;
/// Weight of the planes that hold a border in place.
constexpr double kBorder = 10;
/// Weight of the edge length to the fourth, so that flat parts lose their shortest edges first.
constexpr double kShort = 1e-6;

/// Number of edges above which a vertex is locked. OpenMesh tests all of them again after every
/// collapse next to the vertex, so the time would grow with the cube of their number.
constexpr unsigned kMostEdges = 200;

double quality(const Vector& a, const Vector& b, const Vector& c) {
  const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return squares > 0 ? 2 * std::sqrt(3.0) * (b - a).cross(c - a).norm() / squares : 0;
}

/// Weighted sum of squared distances to planes.
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

std::vector<Quadric> quadrics_of(const Positions& pose, const Surface& surface) {
  std::vector<Quadric> quadrics(static_cast<std::size_t>(pose.rows()));
  const auto place = [&pose](OpenMesh::VertexHandle v) -> Vector { return pose.row(v.idx()); };
  const auto at = [&quadrics](OpenMesh::VertexHandle v) -> Quadric& {
    return quadrics[static_cast<std::size_t>(v.idx())];
  };
  for (const auto face : surface.half_edges().faces()) {
    const auto first = face.halfedge();
    const Vector a = place(first.from());
    const Vector normal = (place(first.to()) - a).cross(place(first.prev().from()) - a);
    const double area = normal.norm() / 2;
    if (area == 0) continue;
    for (const auto h : face.halfedges()) at(h.from()).add_plane(normal / (2 * area), a, area);
    for (const auto h : face.halfedges()) {
      if (!h.edge().is_boundary()) continue;
      const Vector edge = place(h.to()) - place(h.from());
      const Vector across = edge.cross(normal).normalized();
      for (const auto end : {h.from(), h.to()}) {
        at(end).add_plane(across, place(h.from()), kBorder * edge.squaredNorm());
      }
    }
  }
  return quadrics;
}

/// Module of OpenMesh's decimater that ranks collapses.
template <typename MeshT>
class PoseModule : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(PoseModule, MeshT, Poses);

  explicit PoseModule(MeshT& mesh) : Base(mesh, false) {}

  void start(const DecimationPoses& poses, const Surface& surface) {
    poses_ = poses.positions.size();
    planes_ = static_cast<std::size_t>(poses.planes);
    const std::size_t vertices = surface.half_edges().n_vertices();
    positions_.resize(vertices * poses_);
    normals_.resize(vertices * poses_);
    quadrics_.resize(vertices * planes_);
    for (std::size_t p = 0; p < poses_; ++p) {
      for (std::size_t v = 0; v < vertices; ++v) {
        positions_[v * poses_ + p] = poses.positions[p].row(Eigen::Index(v));
        normals_[v * poses_ + p] = poses.normals[p].row(Eigen::Index(v));
      }
    }
    for (std::size_t p = 0; p < planes_; ++p) {
      const std::vector<Quadric> quadrics = quadrics_of(poses.positions[p], surface);
      for (std::size_t v = 0; v < vertices; ++v) quadrics_[v * planes_ + p] = quadrics[v];
    }
  }

  float collapse_priority(const CollapseInfo& collapse) override {
    const auto from = std::size_t(collapse.v0.idx()), to = std::size_t(collapse.v1.idx());
    if (collapse.v0 != ranked_) {
      ranked_ = collapse.v0;
      best_ = std::numeric_limits<float>::max();
    }
    const float cost = cost_of(from, to);
    // The decimater takes a vertex's cheapest collapse, so costlier ones need no check.
    if (cost >= best_ || !is_allowed(collapse)) return float(Base::ILLEGAL_COLLAPSE);
    best_ = cost;
    return cost;
  }

  void postprocess_collapse(const CollapseInfo& collapse) override {
    const auto from = std::size_t(collapse.v0.idx()), to = std::size_t(collapse.v1.idx());
    for (std::size_t p = 0; p < planes_; ++p) {
      quadrics_[to * planes_ + p].add(quadrics_[from * planes_ + p]);
    }
    ranked_ = OpenMesh::VertexHandle();
    MeshT& mesh = Base::mesh();
    if (mesh.valence(collapse.v1) > kMostEdges) mesh.status(collapse.v1).set_locked(true);
  }

 private:
  float cost_of(std::size_t from, std::size_t to) const {
    double cost = 0;
    for (std::size_t p = 0; p < planes_; ++p) {
      const Vector& x = positions_[to * poses_ + p];
      const double shift2 = (positions_[from * poses_ + p] - x).squaredNorm();
      cost += quadrics_[from * planes_ + p].at(x) + quadrics_[to * planes_ + p].at(x) +
              kShort * shift2 * shift2;
    }
    return static_cast<float>(std::max(0.0, cost));
  }

  /// Whether every triangle that stays around `from` may move its corner to `to`.
  bool is_allowed(const CollapseInfo& collapse) {
    MeshT& mesh = Base::mesh();
    const auto from = std::size_t(collapse.v0.idx()), to = std::size_t(collapse.v1.idx());
    for (const auto spoke : mesh.voh_range(collapse.v0)) {
      if (!spoke.face().is_valid()) continue;
      const auto b = std::size_t(spoke.to().idx()), c = std::size_t(spoke.next().to().idx());
      if (b == to || c == to) continue;
      if (!keeps_its_side(from, to, b, c) || !keeps_its_shape(from, to, b, c)) return false;
    }
    return true;
  }

  bool keeps_its_side(std::size_t from, std::size_t to, std::size_t b, std::size_t c) const {
    for (std::size_t p = 0; p < poses_; ++p) {
      const auto agrees = [this, p, b, c](std::size_t a) {
        const auto of = [this, p](std::size_t v) { return v * poses_ + p; };
        return agreement(positions_[of(a)], positions_[of(b)], positions_[of(c)],
                         normals_[of(a)] + normals_[of(b)] + normals_[of(c)]);
      };
      const double now = agrees(to);
      if (now < kLeastCosine && now <= agrees(from)) return false;
    }
    return true;
  }

  bool keeps_its_shape(std::size_t from, std::size_t to, std::size_t b, std::size_t c) const {
    const auto at_rest = [this](std::size_t v) -> const Vector& { return positions_[v * poses_]; };
    const double now = quality(at_rest(to), at_rest(b), at_rest(c));
    return now >= kLeastQuality || now > quality(at_rest(from), at_rest(b), at_rest(c));
  }

  // The poses of a vertex are adjacent in memory.
  std::size_t poses_ = 0, planes_ = 0;
  std::vector<Vector> positions_, normals_;
  std::vector<Quadric> quadrics_;
  // Vertex whose collapses are being ranked, and the least cost so far.
  OpenMesh::VertexHandle ranked_;
  float best_ = 0;
};

class CollapseProgress : public OpenMesh::Decimater::Observer {
 public:
  CollapseProgress(const Context& context, std::size_t collapses)
      : Observer(kSteps), context_(context), collapses_(double(collapses)) {}

  void notify(std::size_t done) override { context_.report(double(done) / collapses_); }

 private:
  static constexpr std::size_t kSteps = 100;
  const Context& context_;
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

CollapsedSurface collapsed(const Surface& surface, const DecimationPoses& poses,
                           const std::vector<bool>& locked, std::size_t collapses,
                           const Context& context) {
  // OpenMesh 9 mixes up properties when it copies a status, and TriConnectivity's own function
  // would triangulate deleted faces. Points are not needed, because `poses` has them.
  Surface::HalfEdges half_edges = surface.half_edges();
  half_edges.release_face_status();
  Mesh mesh;
  mesh.OpenMesh::PolyConnectivity::assign_connectivity(half_edges);
  mesh.request_halfedge_status();
  OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
  for (const int face : surface.left_out()) {
    mesh.status(OpenMesh::FaceHandle(face)).set_deleted(true);
  }
  for (const auto v : mesh.vertices()) {
    mesh.status(v).set_locked(locked[std::size_t(v.idx())] || mesh.valence(v) > kMostEdges);
  }
  PoseModule<Mesh>::Handle module;
  decimater.add(module);
  decimater.initialize();
  decimater.module(module).start(poses, surface);
  CollapseProgress observer(context, collapses);
  decimater.set_observer(&observer);
  if (collapses > 0) decimater.decimate(collapses);

  CollapsedSurface result;
  for (const auto v : mesh.all_vertices()) result.kept.push_back(!mesh.status(v).deleted());
  for (const auto face : mesh.faces()) result.triangles.push_back(face.idx());
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
