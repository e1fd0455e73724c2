#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/following_parts.h"

namespace mimetra {

/// A connected part of a target without a partner in the source that followed the surface around
/// it.
struct FollowingPart {
  int component;  ///< rank among surface_parts()
  int vertices;
  double farthest;  ///< largest move of a vertex from rest in any frame, in the target's unit
};

/// The parts that follow, by component, with how far each moves at most.
std::vector<FollowingPart> described(const FollowingParts& parts,
                                     const std::vector<double>& farthest,
                                     const BlendshapeModel& model);

/// What a solve notes of a target, under its name.
class TargetNotes {
 public:
  TargetNotes(const std::string& name, const Context& context)
      : start_(name + ": "), context_(context) {}

  void add(const std::string& text, Topic topic = Topic::other) const;
  /// Expressions that are not or hardly seen.
  void add(const BlendshapeConditions& conditions) const;
  void add(const std::vector<FollowingPart>& parts) const;
  /// Seams that rounding opened, which nothing holds together.
  void add_almost_welded(const BlendshapeModel& model) const;
  /// Vertices that no triangle moves, where a mesh has triangles.
  void add_unmoved(const Connectivity& connectivity) const;

  /// Triangles that are slivers, or lie between vertices that a seam makes one.
  struct Degenerate {
    int source = 0, target = 0, collapsed = 0;
  };
  void add_degenerate(const Degenerate& triangles) const;

 private:
  std::string start_;
  const Context& context_;
};

}  // namespace mimetra
