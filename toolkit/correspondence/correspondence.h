#pragma once

#include <string>
#include <vector>

#include "toolkit/correspondence/surface_fit.h"
#include "toolkit/mesh/context.h"

namespace mimetra {

/// Partners in a source for each triangle of a target: several with weights, or none if the source
/// has no surface there.
struct Correspondence {
  /// A triangle of the source and its share. The shares of one target triangle add up to 1.
  struct Part {
    int triangle;
    double weight;

    bool operator==(const Part&) const = default;
  };

  int source_triangles = 0;
  /// Partners of target triangle t are parts[offsets[t]] .. parts[offsets[t + 1] - 1], ascending.
  std::vector<int> offsets = {0};
  std::vector<Part> parts;
  /// Distance of the deformed source from each target triangle's centroid (M), in the unit of the
  /// target. Infinite if no part of the source faces the same way.
  Eigen::VectorXd residuals;

  int target_triangles() const { return static_cast<int>(offsets.size()) - 1; }
  bool has_partner(int target_triangle) const {
    return offsets[target_triangle + 1] > offsets[target_triangle];
  }

  /// Pairs each triangle with the triangle of the same number, with residual 0.
  static Correspondence identity(int triangles);
};

/// Quality of a correspondence in numbers. Shares are 0 to 1.
struct CorrespondenceQuality {
  double without_partner = 0;   ///< share of the target's triangles
  double mean_residual = 0;     ///< of triangles with a partner, as a share of the target's size
  double largest_residual = 0;  ///< same unit
  /// Number of partners that face away from their neighbours on the deformed source.
  int folded = 0;
  int partners = 0;  ///< number of source triangles that are partners

  /// "good", "usable", or "poor: " and the reasons.
  std::string verdict() const;
};

/// Computes the quality from the residuals; `folded` and `partners` stay 0. `size` is the diagonal
/// of the target's subject_box().
CorrespondenceQuality quality_of(const Correspondence& pairs, double size);

/// Pairs triangles by the nearest centroids in both directions. A target triangle's partners are
/// its nearest triangle of `fitted`, and the triangles of `fitted` to which it is the nearest.
/// `fitted` (N x 3) is the source deformed onto the target.
///
/// Partners face less than 90 degrees apart. The distance of their centroids is at most the sum of
/// their longest edges, or 2 % of SurfaceFit::target_box if that is more. Each centroid must
/// project into the other surface and not onto its border. Weights are shares of the partners'
/// areas. Triangles of parts that no marker reaches are not paired.
Correspondence pair_triangles(const SurfaceFit& fitted, const Triangles& source,
                              const TriMesh& target, const Context& context = {});

/// A source deformed onto a target, and the pairs of their triangles.
struct FoundCorrespondence {
  Correspondence correspondence;
  SurfaceFit fit;
  CorrespondenceQuality quality;
  /// True if the target's faces are oriented opposite to the source's. They were then paired as if
  /// flipped.
  bool inside_out = false;
};

/// Deforms the source by fit_to_surface() and pairs the triangles by pair_triangles().
///
/// Parts that no marker reaches, such as teeth and eyes, follow the similarity of the 200 nearest
/// vertices of the fitted surface. They are then paired by their places. Such a part of the target
/// gets partners if three quarters of its triangles find one. The mean distance must be at most a
/// tenth of the part's size. Throws what these functions and is_inside_out() throw.
FoundCorrespondence find_correspondence(const TriMesh& source, const TriMesh& target,
                                        const std::vector<Marker>& markers,
                                        const SurfaceFitOptions& options = {},
                                        const Context& context = {});

}  // namespace mimetra
