#include "toolkit/model/expression_names.h"

#include <algorithm>

#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

enum class Half { none, left, right };

struct HalfName {
  Half half = Half::none;
  std::string given_stem;
  std::string stem;  // folded
};

HalfName half_of(const std::string& name) {
  struct Affix {
    std::string_view text;
    Half half;
  };
  constexpr Affix kEndings[] = {
      {"Left", Half::left}, {"_left", Half::left}, {"_L", Half::left},     {"_l", Half::left},
      {".L", Half::left},   {".l", Half::left},    {"Right", Half::right}, {"_right", Half::right},
      {"_R", Half::right},  {"_r", Half::right},   {".R", Half::right},    {".r", Half::right}};
  for (const Affix& ending : kEndings) {
    if (!name.ends_with(ending.text)) continue;
    const std::string stem = name.substr(0, name.size() - ending.text.size());
    return {ending.half, stem, folded_name(stem)};
  }
  constexpr Affix kBeginnings[] = {
      {"L_", Half::left},  {"l_", Half::left},  {"Left_", Half::left},   {"left_", Half::left},
      {"R_", Half::right}, {"r_", Half::right}, {"Right_", Half::right}, {"right_", Half::right}};
  for (const Affix& beginning : kBeginnings) {
    if (!name.starts_with(beginning.text)) continue;
    const std::string stem = name.substr(beginning.text.size());
    return {beginning.half, stem, folded_name(stem)};
  }
  return {};
}

/// `jawLeft` and `mouthLeft` move to a side.
bool is_side_movement(const std::string& stem) {
  return stem == "jaw" || stem == "mouth";
}

/// Stem of the right half for the stem of a left half; empty if the name is not a half.
std::string stem_of_right(const std::string& left) {
  if (is_side_movement(left)) return {};
  if (left == "eyelookin") return "eyelookout";
  if (left == "eyelookout") return "eyelookin";
  return left;
}

/// ARKit's names, spelled out and folded.
struct KnownGroup {
  Exclusive least;  // smallest choice that includes the group
  std::vector<std::string_view> names;
};

std::vector<KnownGroup> known_groups() {
  return {{Exclusive::eyes, {"eyelookupleft", "eyelookdownleft"}},
          {Exclusive::eyes, {"eyelookupright", "eyelookdownright"}},
          {Exclusive::eyes, {"eyelookinleft", "eyelookoutleft"}},
          {Exclusive::eyes, {"eyelookinright", "eyelookoutright"}},
          {Exclusive::all, {"jawopen", "mouthclose"}}};
}

}  // namespace

std::string spelled_out(const std::string& name) {
  const HalfName half = half_of(name);
  if (half.half == Half::none) return name;
  return half.given_stem + (half.half == Half::left ? "Left" : "Right");
}

std::string without_node(const std::string& name) {
  const auto point = name.find('.');
  if (point == std::string::npos) return name;
  std::string shape = name.substr(point + 1);
  const std::string plain = lower_case(shape);
  const bool is_side = plain.size() < 2 || plain == "left" || plain == "right";
  const bool is_number = plain.find_first_not_of("0123456789") == std::string::npos;
  return is_side || is_number ? name : shape;
}

std::string without_side(const std::string& name) {
  const HalfName half = half_of(name);
  return half.half == Half::none || is_side_movement(half.stem) ? name : half.given_stem;
}

std::string folded_name(const std::string& name) {
  std::string result = lower_case(name);
  std::erase(result, '_');
  return result;
}

int expression_named(const std::string& name, const std::vector<std::string>& names) {
  const auto exact = std::ranges::find(names, name);
  if (exact != names.end()) return static_cast<int>(exact - names.begin());
  const auto is_alike = [wanted = folded_name(spelled_out(name))](const std::string& other) {
    return folded_name(spelled_out(other)) == wanted;
  };
  const auto alike = std::ranges::find_if(names, is_alike);
  const bool is_only_one = std::ranges::count_if(names, is_alike) == 1;
  return is_only_one ? static_cast<int>(alike - names.begin()) : -1;
}

std::vector<std::array<int, 2>> known_pairs(const std::vector<std::string>& names) {
  std::vector<HalfName> halves;
  halves.reserve(names.size());
  for (const std::string& name : names) halves.push_back(half_of(name));
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t left = 0; left < halves.size(); ++left) {
    if (halves[left].half != Half::left) continue;
    const std::string wanted = stem_of_right(halves[left].stem);
    const auto right = std::ranges::find_if(halves, [&wanted](const HalfName& other) {
      return other.half == Half::right && !wanted.empty() && other.stem == wanted;
    });
    if (right == halves.end()) continue;
    pairs.push_back({static_cast<int>(left), static_cast<int>(right - halves.begin())});
  }
  return pairs;
}

std::vector<std::vector<int>> known_exclusives(const std::vector<std::string>& names,
                                               Exclusive which) {
  std::vector<std::string> folded;
  folded.reserve(names.size());
  for (const std::string& name : names) {
    folded.push_back(folded_name(spelled_out(without_node(name))));
  }
  std::vector<std::vector<int>> groups;
  for (const KnownGroup& known : known_groups()) {
    if (which < known.least) continue;
    std::vector<int> group;
    for (const std::string_view name : known.names) {
      const auto found = std::ranges::find(folded, name);
      if (found != folded.end()) group.push_back(static_cast<int>(found - folded.begin()));
    }
    if (group.size() < known.names.size()) continue;
    std::ranges::sort(group);
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace mimetra
