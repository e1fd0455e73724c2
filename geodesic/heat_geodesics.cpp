#include "geodesic/heat_geodesics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "geodesic/heat_operators.h"
#include "geodesic/sparse_factor.h"

namespace mimetra::geodesic {
namespace {

constexpr double kUnreachable = std::numeric_limits<double>::infinity();

/// Heat below this share of its maximum has no usable direction. It decays by about e per edge and
/// underflows at 1e-308, whatever the scale of the mesh.
constexpr double kFaintest = 1e-250;

constexpr int kLanes = HeatGeodesics::kGroup;
using Lane = Eigen::Array<double, 1, kLanes>;
/// One row per unknown and one column per query.
using Lanes = Eigen::Matrix<double, Eigen::Dynamic, kLanes, Eigen::RowMajor>;
/// Rows of the component where each lane's query starts.
using LaneSources = std::array<std::span<const VertexIndex>, kLanes>;

/// Distance from the nearest source for a potential, which is the distance up to a constant. The
/// potentials of the sources, `zeros` (ascending), agree only roughly. Measuring from the nearest
/// of them gives 0 at every source and no negative values.
double distance_to_nearest(const std::vector<double>& zeros, double potential) {
  const auto above = std::lower_bound(zeros.begin(), zeros.end(), potential);
  if (above == zeros.begin()) return *above - potential;
  if (above == zeros.end()) return potential - zeros.back();
  return std::min(*above - potential, potential - *std::prev(above));
}

/// The heat method on one connected component. Vertices are rows of the component; internally, rows
/// are in elimination order.
class HeatComponent {
 public:
  explicit HeatComponent(const HeatOperators& operators);

  /// Distance from the nearest source of each lane (N x kLanes). \pre each lane has a source
  Lanes distances(const LaneSources& sources) const;

 private:
  /// A triangle that the heat of some lanes has not reached yet (1 for these lanes, else 0).
  struct Open {
    int triangle;
    Lane waiting;
  };

  Lanes potentials(Lanes reached) const;
  void add_divergence(const Lanes& heat, const Lane& faintest, Open& open, Lanes& result) const;

  std::vector<int> place_;  // position of each row in the elimination order
  Triangles triangles_;     // corners as such positions
  std::vector<FlatTriangle> flat_;
  SparseFactor heat_, poisson_;
};

HeatComponent::HeatComponent(const HeatOperators& operators)
    : triangles_(operators.triangles), flat_(operators.flat) {
  // Both matrices have one pattern, because the mass is diagonal.
  SparseFactor::Factorization factorization;
  factorization.analyzePattern(operators.heat);
  try {
    factorization.factorize(operators.heat);
    heat_ = SparseFactor(factorization);
    factorization.factorize(operators.laplacian);
    poisson_ = SparseFactor(factorization);
  } catch (const std::runtime_error&) {
    throw std::runtime_error("the Laplacian is not positive; look for degenerate triangles");
  }
  place_ = heat_.order();
  for (int& corner : triangles_.reshaped()) corner = place_[corner];
}

Lanes HeatComponent::distances(const LaneSources& sources) const {
  Lanes reached = Lanes::Zero(static_cast<Eigen::Index>(place_.size()), kLanes);
  for (int lane = 0; lane < kLanes; ++lane) {
    for (const VertexIndex source : sources[lane]) reached(place_[source], lane) = 1;
  }
  const Lanes potential = potentials(std::move(reached));
  Lanes result(potential.rows(), kLanes);
  for (int lane = 0; lane < kLanes; ++lane) {
    std::vector<double> zeros;
    for (const VertexIndex source : sources[lane]) {
      zeros.push_back(potential(place_[source], lane));
    }
    std::sort(zeros.begin(), zeros.end());
    for (std::size_t v = 0; v < place_.size(); ++v) {
      result(v, lane) = distance_to_nearest(zeros, potential(place_[v], lane));
    }
  }
  return result;
}

/// Potentials whose gradients are closest to unit vectors opposite to the heat's gradients.
///
/// When the heat has faded, the next round starts from all vertices that it has reached. Their
/// border is a level set of the heat, a circle around the sources, so the direction is the same.
Lanes HeatComponent::potentials(Lanes reached) const {
  Lanes divergence = Lanes::Zero(reached.rows(), kLanes);
  std::vector<Open> open(flat_.size());
  for (std::size_t t = 0; t < open.size(); ++t) open[t] = {static_cast<int>(t), Lane::Ones()};

  for (double waiting = 0; !open.empty();) {
    const Lanes heat = heat_.solve<kLanes>(reached).cwiseAbs();
    const Lane faintest = kFaintest * heat.colwise().maxCoeff().array();
    const double before = waiting;
    waiting = 0;
    for (Open& triangle : open) {
      add_divergence(heat, faintest, triangle, divergence);
      waiting += triangle.waiting.sum();
    }
    if (waiting == 0) break;
    if (waiting == before) throw std::runtime_error("heat does not spread over the mesh");
    std::erase_if(open, [](const Open& triangle) { return (triangle.waiting == 0).all(); });
    reached =
        ((heat.array() > faintest.replicate(heat.rows(), 1)) || reached.array() > 0).cast<double>();
  }
  return poisson_.solve<kLanes>(std::move(divergence));
}

/// Adds a triangle's part of the right-hand side of the Poisson system. For each corner it is the
/// integral of the hat gradient times the unit vector opposite to the heat's gradient.
///
/// Only lanes that still wait for the triangle and have heat there are added. The unit vector is
/// zero if the heat is constant.
void HeatComponent::add_divergence(const Lanes& heat, const Lane& faintest, Open& open,
                                   Lanes& result) const {
  // Smaller than any relevant length or heat; avoids 0 / 0.
  constexpr double kTiny = std::numeric_limits<double>::min();
  const FlatTriangle& flat = flat_[open.triangle];
  const int* corners = triangles_.row(open.triangle).data();
  const auto corner = [&](int c) { return heat.row(corners[c]).array(); };
  const Lane warmest = corner(0).max(corner(1)).max(corner(2));
  // Relative heat, because squares of very faint heat would underflow.
  const Lane rise1 = (corner(1) - corner(0)) / warmest.max(kTiny);
  const Lane rise2 = (corner(2) - corner(0)) / warmest.max(kTiny);
  const Lane x = rise1 * flat.gradient1.x() + rise2 * flat.gradient2.x();
  const Lane y = rise1 * flat.gradient1.y() + rise2 * flat.gradient2.y();
  const Lane length = (x.square() + y.square()).sqrt().max(kTiny);
  const Lane seen = open.waiting * (warmest > faintest).cast<double>();
  const Lane share1 = (x * flat.gradient1.x() + y * flat.gradient1.y()) / length;
  const Lane share2 = (x * flat.gradient2.x() + y * flat.gradient2.y()) / length;
  const Lane flow1 = -flat.area * seen * share1, flow2 = -flat.area * seen * share2;
  result.row(corners[0]).array() -= flow1 + flow2;
  result.row(corners[1]).array() += flow1;
  result.row(corners[2]).array() += flow2;
  open.waiting -= seen;
}

}  // namespace

class HeatGeodesics::Implementation {
 public:
  Implementation(const Positions& positions, const Triangles& triangles, const HeatOptions& options)
      : surface_(positions, triangles,
                 options.skip_degenerate ? Degenerate::left_out : Degenerate::refused) {
    for (SurfaceComponent& component : surface_.components) {
      try {
        methods_.push_back(
            std::make_unique<HeatComponent>(heat_operators(component, options.intrinsic_delaunay)));
      } catch (const std::exception& error) {
        throw std::runtime_error("the component of vertex " +
                                 std::to_string(component.vertices.front()) + ": " + error.what());
      }
      // Queries need only the numbering.
      component.positions.resize(0, 3);
      component.triangles.resize(0, 3);
    }
  }

  /// Distance from the nearest source of each lane, N x lanes.
  Eigen::MatrixXd distances(const std::vector<std::span<const VertexIndex>>& lanes) const {
    Eigen::MatrixXd result =
        Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(surface_.component_of.size()),
                                  static_cast<Eigen::Index>(lanes.size()), kUnreachable);
    for (std::size_t first = 0; first < lanes.size(); first += kLanes) {
      const std::size_t count = std::min<std::size_t>(kLanes, lanes.size() - first);
      solve(std::span(lanes).subspan(first, count), result.middleCols(first, count));
    }
    return result;
  }

  const SurfaceComponents& surface() const { return surface_; }

 private:
  /// Solves up to kLanes queries, on each component those with sources there.
  void solve(std::span<const std::span<const VertexIndex>> lanes,
             Eigen::Ref<Eigen::MatrixXd> result) const {
    std::vector<std::vector<std::vector<VertexIndex>>> rows;  // by lane and component
    for (const auto& sources : lanes) rows.push_back(surface_.rows_of(sources));
    for (std::size_t c = 0; c < methods_.size(); ++c) {
      std::vector<Eigen::Index> here;
      LaneSources sources;
      for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
        if (rows[lane][c].empty()) continue;
        sources[here.size()] = rows[lane][c];
        here.push_back(static_cast<Eigen::Index>(lane));
      }
      if (here.empty()) continue;
      // Unused lanes repeat the last used one.
      std::fill(sources.begin() + here.size(), sources.end(), sources[here.size() - 1]);
      result(surface_.components[c].vertices, here) =
          methods_[c]->distances(sources).leftCols(here.size());
    }
  }

  SurfaceComponents surface_;
  std::vector<std::unique_ptr<HeatComponent>> methods_;
};

HeatGeodesics::HeatGeodesics(const Positions& positions, const Triangles& triangles,
                             const HeatOptions& options)
    : implementation_(std::make_unique<Implementation>(positions, triangles, options)) {}

HeatGeodesics::~HeatGeodesics() = default;
HeatGeodesics::HeatGeodesics(HeatGeodesics&&) noexcept = default;
HeatGeodesics& HeatGeodesics::operator=(HeatGeodesics&&) noexcept = default;

Eigen::VectorXd HeatGeodesics::distances(VertexIndex source) const {
  return distances(std::span(&source, 1));
}

Eigen::VectorXd HeatGeodesics::distances(std::span<const VertexIndex> sources) const {
  return implementation_->distances({sources});
}

Eigen::MatrixXd HeatGeodesics::distances_from_each(std::span<const VertexIndex> sources) const {
  std::vector<std::span<const VertexIndex>> lanes;
  for (const VertexIndex& source : sources) lanes.emplace_back(&source, 1);
  return implementation_->distances(lanes);
}

int HeatGeodesics::degenerate_triangles() const {
  return implementation_->surface().degenerate_triangles;
}

const std::vector<VertexIndex>& HeatGeodesics::vertices_without_face() const {
  return implementation_->surface().vertices_without_face;
}

}  // namespace mimetra::geodesic
