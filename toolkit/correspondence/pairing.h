#pragma once

#include <functional>
#include <span>
#include <vector>

#include "toolkit/correspondence/correspondence.h"

namespace mimetra {

/// Returns true if at least half of the weight of a target triangle's partners belongs to source
/// triangles with `is_selected`.
bool is_over(const Correspondence& pairs, int target_triangle,
             const std::function<bool(int)>& is_selected);

/// Target triangles with at least half of their partners' weight in `selected` (triangles of the
/// source), ascending.
std::vector<int> triangles_over(const Correspondence& pairs, const std::vector<int>& selected);

/// Correspondence between a source and a target of other faces, for triangles and for vertices.
class Pairing {
 public:
  /// A vertex of the source and its share. The shares of one target vertex add up to 1.
  struct Carrier {
    VertexIndex vertex;
    double weight;
  };

  /// Finds the carriers of each target vertex: the matching corners of the partners of its
  /// triangles. Corners match by their places after the similarity of the paired triangles. If the
  /// target is inside out, corners are matched in the opposite order. A vertex without a paired
  /// triangle has no carriers. Throws MismatchError if the correspondence has other numbers of
  /// triangles.
  Pairing(const TriMesh& source, const TriMesh& target, Correspondence pairs);

  const Correspondence& triangles() const { return pairs_; }
  const Triangles& source_triangles() const { return source_triangles_; }
  int source_vertices() const { return source_vertices_; }
  int target_vertices() const { return static_cast<int>(offsets_.size()) - 1; }

  std::span<const Carrier> carriers(VertexIndex target_vertex) const;
  /// Returns true if no vertex has more than one carrier and no triangle more than one partner. The
  /// meshes then differ only in their numbers.
  bool is_one_to_one() const;
  /// `selected` triangles of the target plus the gaps between them, ascending. A gap is a connected
  /// set of triangles without a partner. It is added if at least half of its neighbours with a
  /// partner are selected. `triangles` (M x 3) belong to the target.
  std::vector<int> with_gaps(std::vector<int> selected, const Triangles& triangles) const;
  /// Target vertices with carriers, ascending.
  std::vector<VertexIndex> carried_vertices() const;
  /// Weighted mean place of the carriers of each vertex in a pose of the source (n x 3). \pre each
  /// has carriers
  Positions carried(const Eigen::Ref<const Positions>& pose,
                    const std::vector<VertexIndex>& vertices) const;
  /// Mask of the target vertices with at least half of their carriers' weight in `source_vertices`.
  /// Vertices without carriers are not in it.
  std::vector<bool> over(const std::vector<bool>& source_vertices) const;

 private:
  Correspondence pairs_;
  Triangles source_triangles_;
  int source_vertices_;
  std::vector<int> offsets_ = {0};
  std::vector<Carrier> carriers_;
};

/// Triangles of the target that have a partner; all without a pairing (null).
std::vector<int> with_partners(std::vector<int> triangles, const Pairing* pairing);

/// Throws MismatchError if the rest poses do not have the pairing's numbers of vertices. Without a
/// pairing (null), throws if their numbers differ.
void check_sizes(const Positions& source_rest, const Positions& target_rest,
                 const Pairing* pairing);

}  // namespace mimetra
