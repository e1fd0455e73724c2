#include "toolkit/mesh/face_groups.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>
#include <string_view>

namespace mimetra {
namespace {

using Words = std::vector<std::string>;

/// The keywords of a kind. Each has a state of its own: `o` does not end what `g` began.
std::vector<std::string_view> keywords(FaceGroupKind kind) {
  if (kind == FaceGroupKind::material) return {"usemtl"};
  return {"g", "o"};
}

/// What stands after the keyword: groups are words; a material is one name, spaces and all.
Words names_in(const std::string& statement, const std::string& keyword, FaceGroupKind kind) {
  std::istringstream rest(statement.substr(keyword.size()));
  Words words{std::istream_iterator<std::string>(rest), {}};
  if (kind == FaceGroupKind::group || words.empty()) return words;
  return {statement.substr(keyword.size() + 1)};
}

void add_face(std::vector<NamedFaces>& named, const std::string& name, int face) {
  auto found = std::ranges::find(named, name, &NamedFaces::name);
  if (found == named.end()) found = named.insert(found, {name, {}});
  if (found->faces.empty() || found->faces.back() != face) found->faces.push_back(face);
}

}  // namespace

std::vector<NamedFaces> named_faces(const Connectivity& connectivity, FaceGroupKind kind) {
  const std::vector<std::string_view> known = keywords(kind);
  std::vector<Words> current(known.size());
  std::vector<NamedFaces> named;
  auto group = connectivity.groups.begin();
  for (int face = 0; face < connectivity.polygons.size(); ++face) {
    for (; group != connectivity.groups.end() && group->first_face <= face; ++group) {
      const std::string keyword = group->statement.substr(0, group->statement.find(' '));
      const auto place = std::ranges::find(known, keyword);
      if (place == known.end()) continue;
      current[place - known.begin()] = names_in(group->statement, keyword, kind);
    }
    for (const Words& names : current) {
      for (const std::string& name : names) add_face(named, name, face);
    }
  }
  return named;
}

}  // namespace mimetra
