#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/SparseCholesky>

#include <mimetra/geodesic/heat_geodesics.h>
#include <mimetra/geodesic/heat_operators.h>

namespace mimetra::geodesic {
namespace {

constexpr double kUnreachable = std::numeric_limits<double>::infinity();

/// Heat below this share of its maximum has no direction: it decays by about e per edge and
/// underflows at 1e-308, whatever the scale of the mesh.
constexpr double kFaintest = 1e-250;

using Factorization = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

/// The heat method on one connected component. Vertices are rows of the component.
class HeatComponent {
 public:
  explicit HeatComponent(const HeatOperators& operators);

  /// Distance from the nearest of `sources` (N). \pre At least one source.
  Eigen::VectorXd distances(std::span<const VertexIndex> sources) const;

 private:
  using Directions = std::vector<Eigen::Vector2d>;

  Directions directions_of_heat(std::span<const VertexIndex> sources) const;
  Eigen::VectorXd divergence(const Directions& directions) const;
  std::array<double, 3> heat_of_corners(const Eigen::VectorXd& heat, Eigen::Index t) const;

  Triangles triangles_;
  std::vector<FlatTriangle> flat_;
  Factorization heat_, poisson_;
};

HeatComponent::HeatComponent(const HeatOperators& operators)
    : triangles_(operators.triangles),
      flat_(operators.flat),
      heat_(operators.heat),
      poisson_(operators.laplacian) {
  if (heat_.info() != Eigen::Success || poisson_.info() != Eigen::Success) {
    throw std::runtime_error("the Laplacian is not positive; look for degenerate triangles");
  }
}

Eigen::VectorXd HeatComponent::distances(std::span<const VertexIndex> sources) const {
  const Eigen::VectorXd potential = poisson_.solve(divergence(directions_of_heat(sources)));
  std::vector<double> zeros;
  for (const VertexIndex source : sources) zeros.push_back(potential[source]);
  std::sort(zeros.begin(), zeros.end());
  // The potential is the distance up to a constant, which the sources agree on only roughly; the
  // nearest one keeps every source at 0 and everything else above.
  return potential.unaryExpr([&zeros](double value) {
    const auto above = std::lower_bound(zeros.begin(), zeros.end(), value);
    if (above == zeros.begin()) return *above - value;
    if (above == zeros.end()) return value - zeros.back();
    return std::min(*above - value, value - *std::prev(above));
  });
}

/// Unit vector against the heat's gradient in each triangle; zero where the heat is constant.
///
/// Where the heat has faded the next round starts from all vertices it has reached: their border
/// is a level set of the heat, that is a circle around the sources, so the direction is the same.
HeatComponent::Directions HeatComponent::directions_of_heat(
    std::span<const VertexIndex> sources) const {
  Directions directions(flat_.size(), Eigen::Vector2d::Zero());
  Eigen::VectorXd reached = Eigen::VectorXd::Zero(heat_.rows());
  for (const VertexIndex source : sources) reached[source] = 1;
  std::vector<Eigen::Index> open(flat_.size());
  for (std::size_t t = 0; t < open.size(); ++t) open[t] = static_cast<Eigen::Index>(t);

  while (!open.empty()) {
    const Eigen::VectorXd heat = heat_.solve(reached).cwiseAbs();
    const double faintest = kFaintest * heat.maxCoeff();
    const std::size_t before = open.size();
    std::erase_if(open, [&](Eigen::Index t) {
      std::array<double, 3> corners = heat_of_corners(heat, t);
      const double warmest = *std::max_element(corners.begin(), corners.end());
      if (!(warmest > faintest)) return false;
      // Relative heat, because squares of very faint heat vanish.
      for (double& corner : corners) corner /= warmest;
      const FlatTriangle& flat = flat_[t];
      const Eigen::Vector2d gradient =
          (corners[1] - corners[0]) * flat.gradient1 + (corners[2] - corners[0]) * flat.gradient2;
      const double length = gradient.norm();
      if (length > 0) directions[t] = -gradient / length;
      return true;
    });
    if (open.size() == before) throw std::runtime_error("heat does not spread over the mesh");
    reached = (heat.array() > faintest || reached.array() > 0).cast<double>();
  }
  return directions;
}

std::array<double, 3> HeatComponent::heat_of_corners(const Eigen::VectorXd& heat,
                                                     Eigen::Index t) const {
  return {heat[triangles_(t, 0)], heat[triangles_(t, 1)], heat[triangles_(t, 2)]};
}

/// Integral of each vertex's hat gradient times the directions: the right-hand side L phi = b for
/// the potential whose gradient is closest to them.
Eigen::VectorXd HeatComponent::divergence(const Directions& directions) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(heat_.rows());
  for (std::size_t t = 0; t < flat_.size(); ++t) {
    const double flow1 = flat_[t].area * flat_[t].gradient1.dot(directions[t]);
    const double flow2 = flat_[t].area * flat_[t].gradient2.dot(directions[t]);
    const auto triangle = triangles_.row(static_cast<Eigen::Index>(t));
    result[triangle[0]] -= flow1 + flow2;
    result[triangle[1]] += flow1;
    result[triangle[2]] += flow2;
  }
  return result;
}

}  // namespace

class HeatGeodesics::Implementation {
 public:
  Implementation(const Positions& positions, const Triangles& triangles, const HeatOptions& options)
      : surface_(surface_components(
            positions, triangles,
            options.skip_degenerate ? Degenerate::left_out : Degenerate::refused)) {
    for (SurfaceComponent& component : surface_.components) {
      try {
        methods_.push_back(
            std::make_unique<HeatComponent>(heat_operators(component, options.intrinsic_delaunay)));
      } catch (const std::exception& error) {
        throw std::runtime_error("the component of vertex " +
                                 std::to_string(component.vertices.front()) + ": " + error.what());
      }
      // Only the numbering is needed from here on.
      component.positions.resize(0, 3);
      component.triangles.resize(0, 3);
    }
  }

  Eigen::VectorXd distances(std::span<const VertexIndex> sources) const {
    const auto rows = sources_by_component(surface_, sources);
    Eigen::VectorXd result = Eigen::VectorXd::Constant(
        static_cast<Eigen::Index>(surface_.component_of.size()), kUnreachable);
    for (std::size_t c = 0; c < rows.size(); ++c) {
      if (rows[c].empty()) continue;
      result(surface_.components[c].vertices) = methods_[c]->distances(rows[c]);
    }
    return result;
  }

  const SurfaceComponents& surface() const { return surface_; }

 private:
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
  return implementation_->distances(sources);
}

int HeatGeodesics::degenerate_triangles() const {
  return implementation_->surface().degenerate_triangles;
}

const std::vector<VertexIndex>& HeatGeodesics::vertices_without_face() const {
  return implementation_->surface().vertices_without_face;
}

}  // namespace mimetra::geodesic
