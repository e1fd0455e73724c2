#pragma once

#include <string>
#include <vector>

#include "toolkit/correspondence/surface_fit.h"
#include "toolkit/mesh/context.h"

namespace mimetra {

/// Which triangles of a source show what happens to each triangle of a target: several with
/// weights, or none, where nothing of the source is there.
struct Correspondence {
  /// A triangle of the source and its share; those of one target triangle add up to 1.
  struct Part {
    int triangle;
    double weight;

    bool operator==(const Part&) const = default;
  };

  int source_triangles = 0;
  /// Those of target triangle t are parts[offsets[t]] .. parts[offsets[t + 1] - 1], ascending.
  std::vector<int> offsets = {0};
  std::vector<Part> parts;
  /// How far the deformed source is from each target triangle's centroid (M), in the unit of the
  /// target; infinite where nothing of it faces the same way.
  Eigen::VectorXd residuals;

  int target_triangles() const { return static_cast<int>(offsets.size()) - 1; }
  bool has_partner(int target_triangle) const {
    return offsets[target_triangle + 1] > offsets[target_triangle];
  }

  /// Each triangle's partner is that of its own number, without residual.
  static Correspondence identity(int triangles);
};

/// How well a correspondence holds, in numbers; shares are 0 to 1.
struct CorrespondenceQuality {
  double without_partner = 0;   ///< share of the target's triangles
  double mean_residual = 0;     ///< of those with a partner, as a share of the target's size
  double largest_residual = 0;  ///< likewise
  /// Partners whose triangle faces against its neighbours on the deformed source.
  int folded = 0;
  int partners = 0;  ///< triangles of the source that are one's partner

  /// "good", "usable" or "poor: " and why, in words.
  std::string verdict() const;
};

/// What the residuals tell; nothing is known of folds. `size` is the diagonal of the target's
/// subject_box().
CorrespondenceQuality quality_of(const Correspondence& pairs, double size);

/// Pairs triangles whose centroids are nearest to each other's surface, both ways: a target
/// triangle's partners are the triangle of `fitted` (N x 3, on the target's surface) whose centroid
/// is nearest to its own, and those to which it is the nearest; both must face less than 90 degrees
/// apart, be no farther apart than their longest edges (or 2 % of SurfaceFit::target_box where they
/// are shorter), and have its place inside the other's surface, not on its border. Weights are the
/// partners' areas. Triangles that no marker reaches have no partner, and are none.
Correspondence pair_triangles(const SurfaceFit& fitted, const Triangles& source,
                              const TriMesh& target, const Context& context = {});

/// A source deformed onto a target, and their triangles in pairs.
struct FoundCorrespondence {
  Correspondence correspondence;
  SurfaceFit fit;
  CorrespondenceQuality quality;
  /// The target's faces lead the other way round than the source's: they were paired as if turned.
  bool inside_out = false;
};

/// Deforms the source by fit_to_surface() and pairs its triangles by pair_triangles(). Parts that
/// no marker reaches, such as teeth and eyes, follow the similarity of the fitted surface around
/// them (200 vertices) and are paired where they lie over each other then: a part of the target has
/// partners if three quarters of its triangles find one, on average at most a tenth of the part's
/// size away. Throws what these functions and is_inside_out() throw.
FoundCorrespondence find_correspondence(const TriMesh& source, const TriMesh& target,
                                        const std::vector<Marker>& markers,
                                        const SurfaceFitOptions& options = {},
                                        const Context& context = {});

}  // namespace mimetra
