#pragma once

#include <string>
#include <vector>

#include "toolkit/model/blendshape_model.h"
#include "toolkit/pipeline/note.h"
#include "toolkit/transfer/blendshape_transfer.h"

namespace mimetra {

/// The connected parts of a model that some vertices are in, ascending.
std::vector<int> parts_with(const std::vector<VertexIndex>& vertices, const BlendshapeModel& model);

/// What a solve notes of a target, under its name.
class TargetNotes {
 public:
  TargetNotes(const std::string& name, const Notes& notes) : start_(name + ": "), notes_(notes) {}

  void add(const std::string& text, Topic topic = Topic::other) const;
  /// Expressions that are not or hardly seen.
  void add(const BlendshapeConditions& conditions) const;
  /// Connected parts, by their numbers, that follow the surface around them, and their vertices.
  void add_following(const std::vector<int>& parts, std::size_t vertices) const;
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
  const Notes& notes_;
};

}  // namespace mimetra
