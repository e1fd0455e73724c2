#include "toolkit/pipeline/target_notes.h"

#include <algorithm>

#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

std::vector<FollowingPart> described(const FollowingParts& following,
                                     const std::vector<double>& farthest,
                                     const BlendshapeModel& model) {
  const auto lists = following.parts();
  if (lists.empty()) return {};
  const SurfaceParts parts = surface_parts(model.neutral(), model.triangles());
  std::vector<FollowingPart> list;
  for (std::size_t p = 0; p < lists.size(); ++p) {
    list.push_back(
        {parts.of_vertex[lists[p].front()], static_cast<int>(lists[p].size()), farthest[p]});
  }
  std::ranges::sort(list, {}, &FollowingPart::component);
  return list;
}

void TargetNotes::add(const std::string& text, Topic topic) const {
  context_.note(start_ + text, topic);
}

void TargetNotes::add(const BlendshapeConditions& conditions) const {
  if (!conditions.unseen.empty()) {
    add(std::to_string(conditions.unseen.size()) +
        " expressions do not move in the regions and stay 0: " + listed(conditions.unseen));
  }
  if (!conditions.weakly_seen.empty()) {
    add(std::to_string(conditions.weakly_seen.size()) +
        " expressions are weakly seen in the regions: " + listed(conditions.weakly_seen));
  }
  if (conditions.condition > kPoorCondition) {
    add("the regions hardly tell the expressions apart (condition number " +
            readable(conditions.condition, 2) + ")",
        Topic::poor_condition);
  }
}

void TargetNotes::add(const std::vector<FollowingPart>& parts) const {
  if (parts.empty()) return;
  std::vector<std::string> names;
  names.reserve(parts.size());
  for (const FollowingPart& part : parts) {
    names.push_back("component:" + std::to_string(part.component) + " by up to " +
                    readable(part.farthest));
  }
  const bool one = parts.size() == 1;
  add(std::to_string(parts.size()) +
      (one ? " part without a partner in the source follows"
           : " parts without a partner in the source follow") +
      " the surface around " + (one ? "it: " : "them: ") + listed(names));
}

void TargetNotes::add_almost_welded(const BlendshapeModel& model) const {
  if (const int places = almost_welded_vertices(model.neutral(), model.triangles())) {
    add(described_almost_welded(places));
  }
}

void TargetNotes::add_unmoved(const Connectivity& connectivity) const {
  const std::vector<VertexIndex> used =
      used_vertices(connectivity.triangles, connectivity.vertices);
  const std::size_t unmoved = static_cast<std::size_t>(connectivity.vertices) - used.size();
  if (unmoved == 0) return;
  VertexIndex first = 0;
  while (static_cast<std::size_t>(first) < used.size() && used[first] == first) ++first;
  add(std::to_string(unmoved) + " vertices of no triangle, the first is vertex " +
      std::to_string(first) + ", stay where they are at rest");
}

void TargetNotes::add_degenerate(const Degenerate& triangles) const {
  if (triangles.collapsed > 0) {
    add(std::to_string(triangles.collapsed) +
        " triangles between vertices that a seam makes one take no part");
  }
  if (triangles.source > 0) {
    add(std::to_string(triangles.source) +
        " slivers of the source, triangles of hardly any area, take their neighbours' "
        "deformation");
  }
  if (triangles.target > 0) {
    add(std::to_string(triangles.target) + " slivers of the target, triangles of hardly any area");
  }
}

}  // namespace mimetra
