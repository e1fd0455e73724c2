#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/mesh/option.h"

/// Meanings of expression names: ARKit's names, and other names with the same endings.
namespace mimetra {

/// Known expressions that exclude each other.
enum class Exclusive {
  none,
  eyes,  ///< each eye looks up or down, and in or out
  all    ///< eyes, and jawOpen excludes mouthClose, although captures of ARKit use both together
};

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

/// Returns `mouthSmileLeft` for `mouthSmile_L`, `mouthSmile.l`, `mouthSmile_left` and
/// `L_mouthSmile`, which captures write.
std::string spelled_out(const std::string& name);

/// Returns `jawOpen` for `blendShape1.jawOpen`, as a node's shapes are called. Other names stay the
/// same, also `smile.L`, `smile.left` and `smile.001`.
std::string without_node(const std::string& name);

/// Returns `browInnerUp` for `browInnerUp_L`, `browInnerUpLeft` and the like. `jawLeft` and
/// `mouthLeft` are not halves and stay.
std::string without_side(const std::string& name);

/// Returns the name in lower case and without underscores.
std::string folded_name(const std::string& name);

/// Index of the expression with that name. If there is none, index of the only name with the same
/// spelled_out() and folded_name(); otherwise -1.
int expression_named(const std::string& name, const std::vector<std::string>& names);

/// Left and right halves of one expression, by index among `names`. Left halves end in Left, _left,
/// _L or .L, or begin with left_, Left_ or L_, and right halves likewise. Single letters may be
/// lower case. The other half of an eye that looks in is the other eye that looks out, because both
/// look to one side. `jawLeft`, `mouthLeft` and their opposites move to a side and are not halves.
std::vector<std::array<int, 2>> known_pairs(const std::vector<std::string>& names);

/// Groups of expressions that exclude each other, by index among `names`.
std::vector<std::vector<int>> known_exclusives(const std::vector<std::string>& names,
                                               Exclusive which);

}  // namespace mimetra
