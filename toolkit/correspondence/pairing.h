#pragma once

#include <functional>
#include <span>
#include <vector>

#include "toolkit/correspondence/correspondence.h"

namespace mimetra {

/// True where at least half of the weight of a target triangle's partners is of triangles of the
/// source for which `is_selected` says so.
bool is_over(const Correspondence& pairs, int target_triangle,
             const std::function<bool(int)>& is_selected);

/// Target triangles of which at least half of their partners' weight is in `selected` (triangles of
/// the source), ascending.
std::vector<int> triangles_over(const Correspondence& pairs, const std::vector<int>& selected);

/// A source and a target of other faces, and what of the source shows what happens to each triangle
/// and each vertex of the target.
class Pairing {
 public:
  /// A vertex of the source and its share; those of one target vertex add up to 1.
  struct Carrier {
    VertexIndex vertex;
    double weight;
  };

  /// The carriers of a target vertex are the corners of its triangles' partners that lie as it does
  /// in its triangles, as the rest poses show them after the similarity of the paired triangles (in
  /// the other direction around where the target is inside out); it
  /// has none where no triangle around it has a partner. Throws MismatchError where the
  /// correspondence is of other numbers of triangles.
  Pairing(const TriMesh& source, const TriMesh& target, Correspondence pairs);

  const Correspondence& triangles() const { return pairs_; }
  const Triangles& source_triangles() const { return source_triangles_; }
  int source_vertices() const { return source_vertices_; }
  int target_vertices() const { return static_cast<int>(offsets_.size()) - 1; }

  std::span<const Carrier> carriers(VertexIndex target_vertex) const;
  /// No vertex has more than one carrier, and no triangle more than one partner: only numbers
  /// differ.
  bool is_one_to_one() const;
  /// `selected` triangles of the target with those of gaps between them: connected triangles
  /// without partner, of whose neighbours with one at least half are selected. `triangles` (M x 3)
  /// are the target's.
  std::vector<int> with_gaps(std::vector<int> selected, const Triangles& triangles) const;
  /// Target vertices with carriers, ascending.
  std::vector<VertexIndex> carried_vertices() const;
  /// Where the carriers of some target vertices are in a pose of the source (n x 3). \pre they have
  /// some
  Positions carried(const Eigen::Ref<const Positions>& pose,
                    const std::vector<VertexIndex>& vertices) const;
  /// Target vertices at least half of whose carriers are in a set (N each); without carriers they
  /// are not.
  std::vector<bool> over(const std::vector<bool>& source_vertices) const;

 private:
  Correspondence pairs_;
  Triangles source_triangles_;
  int source_vertices_;
  std::vector<int> offsets_ = {0};
  std::vector<Carrier> carriers_;
};

/// Those of some triangles of a target that have a partner; all without a pairing (null).
std::vector<int> with_partners(std::vector<int> triangles, const Pairing* pairing);

/// Throws MismatchError where rest poses have not the vertices of the pairing, or without one
/// (null) different numbers of them.
void check_sizes(const Positions& source_rest, const Positions& target_rest,
                 const Pairing* pairing);

}  // namespace mimetra
