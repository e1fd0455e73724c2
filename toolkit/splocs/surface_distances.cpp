#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "geodesic/cgal_geodesics.h"
#include "geodesic/exact_geodesics.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/splocs/surface_distances.h"

namespace mimetra {
namespace {

/// A method prepared for a mesh.
struct Geodesics {
  DistanceFunction distances;
  /// Distances from the nearest of several sources. If null, the distances from each are computed.
  std::function<Eigen::VectorXd(std::span<const VertexIndex>)> nearest = {};
  /// Number of sources that are fastest together.
  int group = 1;
  int degenerate_triangles = 0;
  std::vector<VertexIndex> vertices_without_face;
};

/// Method that takes one source at a time.
template <typename Method>
Geodesics one_at_a_time(const Positions& positions, const Triangles& triangles) {
  const auto method = std::make_shared<const Method>(positions, triangles);
  return {one_by_one([method](VertexIndex source) { return method->distances(source); }),
          {},
          1,
          method->degenerate_triangles(),
          method->vertices_without_face()};
}

Geodesics prepared(const Positions& positions, const Triangles& triangles, GeodesicMethod method) {
  // The exact method takes its sources one by one: CGAL's shortest paths from several vertices of
  // one triangle fail an assertion.
  if (method == GeodesicMethod::exact) {
    return one_at_a_time<geodesic::ExactGeodesics>(positions, triangles);
  }
  if (method == GeodesicMethod::cgal) {
    const auto cgal = std::make_shared<const geodesic::CgalGeodesics>(positions, triangles);
    return {one_by_one([cgal](VertexIndex source) { return cgal->distances(source); }),
            [cgal](std::span<const VertexIndex> sources) { return cgal->distances(sources); }, 1,
            cgal->degenerate_triangles(), cgal->vertices_without_face()};
  }
  const geodesic::HeatOptions options{.intrinsic_delaunay = method == GeodesicMethod::heat};
  const auto heat = std::make_shared<const geodesic::HeatGeodesics>(positions, triangles, options);
  return {
      [heat](std::span<const VertexIndex> sources) { return heat->distances_from_each(sources); },
      [heat](std::span<const VertexIndex> sources) { return heat->distances(sources); },
      geodesic::HeatGeodesics::kGroup, heat->degenerate_triangles(), heat->vertices_without_face()};
}

void check_size(const Positions& positions, const Weld& weld) {
  if (static_cast<Eigen::Index>(weld.representative.size()) == positions.rows()) return;
  throw std::invalid_argument("a weld of " + std::to_string(weld.representative.size()) +
                              " vertices, expected " + std::to_string(positions.rows()) +
                              " as in the mesh");
}

/// Distances from the most recently requested sources.
class LatestDistances {
 public:
  explicit LatestDistances(std::size_t bytes) : bytes_(bytes) {}

  /// Distances from `source`, or null if they are not kept.
  const Eigen::VectorXd* find(VertexIndex source) {
    const auto found = kept_.find(source);
    if (found == kept_.end()) return nullptr;
    found->second.asked = ++asked_;
    return &found->second.distances;
  }

  /// \pre the same number of distances for every source
  void keep(VertexIndex source, Eigen::VectorXd distances) {
    const std::size_t most = bytes_ / (sizeof(double) * static_cast<std::size_t>(distances.size()));
    while (!kept_.empty() && kept_.size() >= most) {
      kept_.erase(std::ranges::min_element(kept_, {},
                                           [](const auto& entry) { return entry.second.asked; }));
    }
    if (most > 0) kept_[source] = {std::move(distances), ++asked_};
  }

 private:
  struct Entry {
    Eigen::VectorXd distances;
    std::int64_t asked = 0;  ///< number of the latest request
  };

  std::size_t bytes_;
  std::int64_t asked_ = 0;
  std::map<VertexIndex, Entry> kept_;
};

}  // namespace

DistanceFunction one_by_one(std::function<Eigen::VectorXd(VertexIndex)> distances) {
  return [distances = std::move(distances)](std::span<const VertexIndex> sources) {
    Eigen::MatrixXd result;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const Eigen::VectorXd column = distances(sources[i]);
      if (i == 0) result.resize(column.size(), static_cast<Eigen::Index>(sources.size()));
      result.col(static_cast<Eigen::Index>(i)) = column;
    }
    return result;
  };
}

struct SurfaceDistances::State {
  VertexIndex representative(VertexIndex source) const;
  std::vector<VertexIndex> representatives(std::span<const VertexIndex> sources) const;
  Eigen::MatrixXd computed(std::span<const VertexIndex> sources) const;

  Weld weld;
  Geodesics geodesics;
  int threads;
  std::mutex mutex;
  LatestDistances latest;  // by representative
  int computed_sources = 0;

  explicit State(std::size_t kept_bytes) : latest(kept_bytes) {}
};

VertexIndex SurfaceDistances::State::representative(VertexIndex source) const {
  const auto vertices = static_cast<VertexIndex>(weld.representative.size());
  if (source < 0 || source >= vertices) {
    throw std::out_of_range("source vertex " + std::to_string(source) + ", expected 0 to " +
                            std::to_string(vertices - 1));
  }
  return weld.representative[source];
}

std::vector<VertexIndex> SurfaceDistances::State::representatives(
    std::span<const VertexIndex> sources) const {
  std::vector<VertexIndex> places;
  for (const VertexIndex source : sources) places.push_back(representative(source));
  return places;
}

/// Computes distances from representatives.
Eigen::MatrixXd SurfaceDistances::State::computed(std::span<const VertexIndex> sources) const {
  const int group = geodesics.group;
  const auto count = static_cast<int>(sources.size());
  Eigen::MatrixXd found(static_cast<Eigen::Index>(weld.representative.size()), count);
  const auto compute_group = [&](int i) {
    const int first = i * group, size = std::min(group, count - first);
    // Every vertex takes the distance of its representative.
    found.middleCols(first, size) =
        geodesics.distances(sources.subspan(first, size))(weld.representative, Eigen::all);
  };
  parallel_for((count + group - 1) / group, compute_group, Context().with_threads(threads));
  return found;
}

SurfaceDistances::SurfaceDistances(const Positions& positions, const Triangles& triangles,
                                   const Weld& weld, GeodesicMethod method, std::size_t kept_bytes,
                                   const Context& context)
    : state_(std::make_shared<State>(kept_bytes)) {
  check_size(positions, weld);
  state_->weld = weld;
  state_->threads = context.threads();
  state_->geodesics = prepared(positions, weld.welded(triangles), method);
  // In a welded group only the representative has triangles. The others count as having them too.
  auto& faceless = state_->geodesics.vertices_without_face;
  std::erase_if(faceless, [&weld, known = faceless](VertexIndex vertex) {
    return !std::binary_search(known.begin(), known.end(), weld.representative[vertex]);
  });
}

Eigen::MatrixXd SurfaceDistances::operator()(std::span<const VertexIndex> sources) const {
  const std::vector<VertexIndex> places = state_->representatives(sources);
  const std::lock_guard lock(state_->mutex);
  Eigen::MatrixXd result(static_cast<Eigen::Index>(state_->weld.representative.size()),
                         static_cast<Eigen::Index>(sources.size()));
  std::map<VertexIndex, std::vector<Eigen::Index>> columns_of_missing;
  for (Eigen::Index i = 0; i < result.cols(); ++i) {
    const Eigen::VectorXd* const kept = state_->latest.find(places[i]);
    if (kept) {
      result.col(i) = *kept;
    } else {
      columns_of_missing[places[i]].push_back(i);
    }
  }
  std::vector<VertexIndex> missing;
  missing.reserve(columns_of_missing.size());
  for (const auto& [place, columns] : columns_of_missing) missing.push_back(place);
  const Eigen::MatrixXd found = state_->computed(missing);
  state_->computed_sources += static_cast<int>(missing.size());
  for (std::size_t m = 0; m < missing.size(); ++m) {
    const auto distances = found.col(static_cast<Eigen::Index>(m));
    for (const Eigen::Index i : columns_of_missing[missing[m]]) result.col(i) = distances;
    state_->latest.keep(missing[m], distances);
  }
  return result;
}

Eigen::MatrixXd SurfaceDistances::once(std::span<const VertexIndex> sources) const {
  return state_->computed(state_->representatives(sources));
}

Eigen::VectorXd SurfaceDistances::operator()(VertexIndex source) const {
  return (*this)(std::span(&source, 1));
}

Eigen::VectorXd SurfaceDistances::from_nearest(std::span<const VertexIndex> sources) const {
  if (!state_->geodesics.nearest) {
    if (sources.empty()) throw std::invalid_argument("distances from the nearest of no vertices");
    return once(sources).rowwise().minCoeff();
  }
  const Eigen::VectorXd found = state_->geodesics.nearest(state_->representatives(sources));
  return found(state_->weld.representative);
}

const Weld& SurfaceDistances::weld() const {
  return state_->weld;
}

int SurfaceDistances::computed() const {
  const std::lock_guard lock(state_->mutex);
  return state_->computed_sources;
}

int SurfaceDistances::degenerate_triangles() const {
  return state_->geodesics.degenerate_triangles;
}

const std::vector<VertexIndex>& SurfaceDistances::vertices_without_face() const {
  return state_->geodesics.vertices_without_face;
}

}  // namespace mimetra
