#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The text form of USD, as far as a layer that stands for itself needs it. Internal to the format.
///
/// [Pixar. OpenUSD: Usda File Format]
namespace mimetra {

/// A value: numbers of lists and tuples one after the other, or words (strings, tokens, paths).
struct UsdValue {
  std::vector<double> numbers = {};
  std::vector<std::string> words = {};
};

/// An attribute or a relationship.
struct UsdProperty {
  int line = 0;
  UsdValue value = {};
  bool has_value = false;
  std::vector<std::pair<double, UsdValue>> samples = {};  ///< by time code, which rises
  int blocked_line = 0;                                   ///< of a sample that is None
  std::string type = {};                                  ///< "rel" for a relationship
  std::string interpolation = {};
};

struct UsdPrim {
  std::string specifier;  ///< def, over or class
  std::string type, name;
  int line = 0;
  std::map<std::string, UsdValue> metadata = {};
  std::map<std::string, UsdProperty> properties = {};
  std::vector<UsdPrim> children = {};
};

struct UsdLayer {
  std::map<std::string, UsdValue> metadata;
  std::vector<UsdPrim> prims;
};

/// Reads the text of a layer. Throws IoError that names the line, also for what would bring in
/// other layers or leave a choice: references, payloads, sublayers, variants and the like.
UsdLayer parse_usd(const std::string& path, std::string_view text);

}  // namespace mimetra
