#include <algorithm>
#include <future>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include <mimetra/geodesic/exact_geodesics.h>
#include <mimetra/splocs/surface_distances.h>

namespace mimetra {
namespace {

/// A method with its mesh.
struct Geodesics {
  DistanceFunction distances;
  int degenerate_triangles = 0;
  std::vector<VertexIndex> vertices_without_face;
};

template <typename Method>
Geodesics geodesics_of(std::shared_ptr<const Method> method) {
  return {[method](VertexIndex source) { return method->distances(source); },
          method->degenerate_triangles(), method->vertices_without_face()};
}

Geodesics prepared(const Positions& positions, const Triangles& triangles, GeodesicMethod method) {
  if (method == GeodesicMethod::exact) {
    return geodesics_of(std::make_shared<const geodesic::ExactGeodesics>(positions, triangles));
  }
  const geodesic::HeatOptions options{.intrinsic_delaunay = method == GeodesicMethod::heat};
  return geodesics_of(
      std::make_shared<const geodesic::HeatGeodesics>(positions, triangles, options));
}

void check_size(const Positions& positions, const Weld& weld) {
  if (static_cast<Eigen::Index>(weld.representative.size()) == positions.rows()) return;
  throw std::invalid_argument("a weld of " + std::to_string(weld.representative.size()) +
                              " vertices, expected " + std::to_string(positions.rows()) +
                              " as in the mesh");
}

/// Weld::welded, but an index out of range stays: the geodesics name its triangle.
Triangles welded(const Triangles& triangles, const Weld& weld) {
  const auto vertices = static_cast<VertexIndex>(weld.representative.size());
  return triangles.unaryExpr([&](VertexIndex vertex) {
    return vertex >= 0 && vertex < vertices ? weld.representative[vertex] : vertex;
  });
}

/// Every vertex takes the distance of the one that stands for it.
Eigen::VectorXd spread(const Eigen::VectorXd& distances, const Weld& weld) {
  return distances(weld.representative);
}

}  // namespace

struct SurfaceDistances::State {
  Weld weld;
  Geodesics geodesics;
  std::mutex mutex;
  /// By representative. A future, so that who asks for what another thread computes waits for it.
  std::map<VertexIndex, std::shared_future<Eigen::VectorXd>> known;
};

SurfaceDistances::SurfaceDistances(const Positions& positions, const Triangles& triangles,
                                   const Weld& weld, GeodesicMethod method)
    : state_(std::make_shared<State>()) {
  check_size(positions, weld);
  state_->weld = weld;
  state_->geodesics = prepared(positions, welded(triangles, weld), method);
  // The others of a welded group lose their triangles to the one that stands for them.
  auto& faceless = state_->geodesics.vertices_without_face;
  std::erase_if(faceless, [&weld, known = faceless](VertexIndex vertex) {
    return !std::binary_search(known.begin(), known.end(), weld.representative[vertex]);
  });
}

Eigen::VectorXd SurfaceDistances::operator()(VertexIndex source) const {
  const auto& representative = state_->weld.representative;
  if (source < 0 || source >= static_cast<VertexIndex>(representative.size())) {
    throw std::out_of_range("source vertex " + std::to_string(source) + ", expected 0 to " +
                            std::to_string(static_cast<int>(representative.size()) - 1));
  }
  std::packaged_task<Eigen::VectorXd()> computation;
  std::shared_future<Eigen::VectorXd> result;
  {
    const std::lock_guard lock(state_->mutex);
    auto& known = state_->known[representative[source]];
    if (!known.valid()) {
      computation = std::packaged_task<Eigen::VectorXd()>([this, &representative, source] {
        return spread(state_->geodesics.distances(representative[source]), state_->weld);
      });
      known = computation.get_future().share();
    }
    result = known;
  }
  if (computation.valid()) computation();
  return result.get();
}

int SurfaceDistances::computed() const {
  const std::lock_guard lock(state_->mutex);
  return static_cast<int>(state_->known.size());
}

int SurfaceDistances::degenerate_triangles() const {
  return state_->geodesics.degenerate_triangles;
}

const std::vector<VertexIndex>& SurfaceDistances::vertices_without_face() const {
  return state_->geodesics.vertices_without_face;
}

}  // namespace mimetra
