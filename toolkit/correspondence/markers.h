#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// A vertex of the source and the one of the target that is the same point of a face; 0-based.
struct Marker {
  VertexIndex source;
  VertexIndex target;

  bool operator==(const Marker&) const = default;
};

/// Fewer do not hold a surface in space.
constexpr int kFewestMarkers = 4;

/// Throws MismatchError for a vertex that is not there, one that is in two markers, fewer than four
/// markers, and markers that lie in one plane in a mesh (positions N x 3).
void check_markers(const std::vector<Marker>& markers, const Positions& source,
                   const Positions& target);

/// What an affine map of the markers from source to target leaves: root mean square distance, as a
/// share of the target markers' own root mean square distance from their centre.
double affine_residual(const std::vector<Marker>& markers, const Positions& source,
                       const Positions& target);

/// By how much the map of markers may pass them by, in mean distances of the source's: landmarks of
/// two people are placed by hands, and lips that touch lie at one place.
constexpr double kMarkerLooseness = 0.03;

/// A marker that does not lie where the others say.
struct DoubtfulMarker {
  std::size_t marker;  ///< its place in the list
  /// The one whose place it has, where that one has its place.
  std::optional<std::size_t> exchanged_with = {};
  /// How far it is from there, as a share of the target markers' root mean square distance from
  /// their centre.
  double off = 0;

  bool operator==(const DoubtfulMarker&) const = default;
};

/// Markers of the target that the others do not predict: the smooth map of the other markers, an
/// affine one and what bends it least (a biharmonic spline that may pass them by a little), leads
/// from the source's vertex to another place. Two are exchanged where exchanging their places
/// mends both; any other one is doubtful where it is, for its distance from the others, many times
/// as far off as the markers' median is. None of fewer than eight markers, and none of more than a
/// thousand. \pre check_markers()
///
/// [Rippa. An algorithm for selecting a good value for the parameter c in radial basis function
/// interpolation. Advances in Computational Mathematics 11, 1999]
std::vector<DoubtfulMarker> doubtful_markers(const std::vector<Marker>& markers,
                                             const Positions& source, const Positions& target);

/// In words, exchanged ones as a pair; `names` of the markers, such as "line 3", or none for their
/// numbers.
std::vector<std::string> described(const std::vector<DoubtfulMarker>& doubtful,
                                   const std::vector<Marker>& markers,
                                   const std::vector<std::string>& names = {});

/// How far markers are from where the others predict them, leaving out one at a time: root mean
/// square, as a share of the target markers' own from their centre. \pre check_markers()
double left_out_residual(const std::vector<Marker>& markers, const Positions& source,
                         const Positions& target);

/// Whether vertices were counted from another number than was said: markers taken `shift` (1 or -1)
/// lower are all there, and less than half as much is left of them by an affine map and, of eight
/// and more, where each is left out. False for fewer than six.
bool fit_better_shifted(const std::vector<Marker>& markers, int shift, const Positions& source,
                        const Positions& target);

/// Whether the faces of a target lead the other way round than the source's, as the normals at the
/// markers tell after the similarity that fits these best. Throws MismatchError where the markers
/// fit a mirror image of the source far better than the source: left and right are exchanged in
/// them, or one mesh is mirrored. A target that is the mirror image itself, faces and all, passes.
/// \pre check_markers(), and triangles of vertices that are there
bool is_inside_out(const TriMesh& source, const TriMesh& target,
                   const std::vector<Marker>& markers);

}  // namespace mimetra
