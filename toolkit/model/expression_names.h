#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/mesh/option.h"

/// What the names of expressions tell: ARKit's, and others that end like them.
namespace mimetra {

/// Which expressions exclude each other, of those that are known by name.
enum class Exclusive {
  none,
  eyes,  ///< each eye looks up or down, and in or out
  all    ///< and jawOpen excludes mouthClose, which performances of ARKit use together
};

/// As people choose it.
constexpr std::string_view choice_name(Exclusive value) {
  switch (value) {
    case Exclusive::none:
      return "none";
    case Exclusive::eyes:
      return "eyes";
    case Exclusive::all:
      return "all";
  }
  return {};
}

/// `mouthSmile_L`, `mouthSmile.l`, `mouthSmile_left` or `L_mouthSmile` as captures write it:
/// `mouthSmileLeft`.
std::string spelled_out(const std::string& name);

/// `jawOpen` of `blendShape1.jawOpen`, as the shapes of a node are called; the same where no node
/// is named, also of `smile.L`, `smile.left` and `smile.001`.
std::string without_node(const std::string& name);

/// `browInnerUp` of `browInnerUp_L`, `browInnerUpLeft` and the like. `jawLeft` and `mouthLeft`,
/// which are no halves, stay.
std::string without_side(const std::string& name);

/// Without regard to case and underscores.
std::string folded_name(const std::string& name);

/// Index of the expression of that name; where there is none, of the only one that is written
/// otherwise, by its spelled_out() and folded_name(); else -1.
int expression_named(const std::string& name, const std::vector<std::string>& names);

/// Left and right of one expression, by the index of each among `names`: those that end in Left and
/// Right, _left and _right, _L and _R or .L and .R, in any case after a mark, or begin with left_
/// and right_ or L_ and R_. Of an eye that looks
/// in, the other half is the other eye that looks out: both look to one side. `jawLeft`,
/// `mouthLeft` and their opposites move to a side and are no halves.
std::vector<std::array<int, 2>> known_pairs(const std::vector<std::string>& names);

/// Groups of expressions of which at most one is there at a time, by index among `names`.
std::vector<std::vector<int>> known_exclusives(const std::vector<std::string>& names,
                                               Exclusive which);

}  // namespace mimetra
