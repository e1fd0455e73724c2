#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Vertices of the source and the target at the same point of a face, 0-based.
struct Marker {
  VertexIndex source;
  VertexIndex target;

  bool operator==(const Marker&) const = default;
};

/// Fewer markers do not fix a surface in space.
constexpr int kFewestMarkers = 4;

/// Throws MismatchError if a vertex does not exist or is in two markers. Also throws it for fewer
/// than four markers, and for markers in one plane of a mesh (positions N x 3).
void check_markers(const std::vector<Marker>& markers, const Positions& source,
                   const Positions& target);

/// Residual of the best affine map of the markers from source to target. It is the root mean square
/// distance, as a share of the target markers' root mean square distance from their centre.
double affine_residual(const std::vector<Marker>& markers, const Positions& source,
                       const Positions& target);

/// Looseness of the map of markers, as a share of the mean distance between the source's markers.
/// People place landmarks by hand, and touching lips share one place.
constexpr double kMarkerLooseness = 0.03;

/// A marker that contradicts the others.
struct DoubtfulMarker {
  std::size_t marker;  ///< index in the list
  /// Marker that has this one's place, if the two are exchanged.
  std::optional<std::size_t> exchanged_with = {};
  /// Distance from the prediction, as a share of the target markers' root mean square distance from
  /// their centre. If the two are exchanged, the distance between them.
  double off = 0;

  bool operator==(const DoubtfulMarker&) const = default;
};

/// Finds markers of the target that the other markers do not predict. The prediction is a smooth
/// map: an affine map and the least bending (a biharmonic spline, which may miss the markers by a
/// little).
///
/// Two markers are exchanged if swapping their places improves both. Any other marker is doubtful
/// if its error is many times the markers' median. Errors are relative to the error expected at its
/// distance from the others. Returns nothing for fewer than 8 or more than 1000 markers.
/// \pre check_markers()
///
/// [Rippa. An algorithm for selecting a good value for the parameter c in radial basis function
/// interpolation. Advances in Computational Mathematics 11, 1999]
std::vector<DoubtfulMarker> doubtful_markers(const std::vector<Marker>& markers,
                                             const Positions& source, const Positions& target);

/// Descriptions of doubtful markers, exchanged ones as a pair. `names` are the markers' names, such
/// as "line 3"; if empty, numbers are used.
std::vector<std::string> described(const std::vector<DoubtfulMarker>& doubtful,
                                   const std::vector<Marker>& markers,
                                   const std::vector<std::string>& names = {});

/// Root mean square error of the markers' predictions, if each is left out in turn. It is a share
/// of the target markers' root mean square distance from their centre. \pre check_markers()
double left_out_residual(const std::vector<Marker>& markers, const Positions& source,
                         const Positions& target);

/// Returns true if the vertices seem to be counted from another first number: markers minus `shift`
/// (1 or -1) exist and the given ones do not, or they fit much better. They fit much better if the
/// affine residual is less than half. With 8 to 1000 markers, left_out_residual() must also be less
/// than half. False for fewer than six markers.
bool fit_better_shifted(const std::vector<Marker>& markers, int shift, const Positions& source,
                        const Positions& target);

/// Returns true if the target's faces are oriented opposite to the source's, by the normals at the
/// markers after their best similarity. Throws MismatchError if the markers fit a mirror image of
/// the source far better. Left and right are then exchanged in the markers, or one mesh is
/// mirrored. A target that is a complete mirror image, faces included, passes.
/// \pre check_markers(), and the triangles' vertices exist
bool is_inside_out(const TriMesh& source, const TriMesh& target,
                   const std::vector<Marker>& markers);

}  // namespace mimetra
